// The driver's checks of a card's identification, and its refusals.
#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <random>
#include <set>

#include "register_stub.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/frames/endpoint.hpp"

namespace trammel::driver {
namespace {

using test::RegisterStub;
using test::was_read;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace reg = card_map::reg;
namespace field = card_map::field;

TEST(CardOpen, ReadsWhoTheCardIsInFourTransfersAndWritesNothing) {
  RegisterStub bus(2, 100'000'000);
  bus.values[reg::kMapVersion] = (card_map::kMapVersionValue & ~0xFFFFU) | 5U;
  bus.values[reg::step_length(1)] = 200;
  bus.values[reg::step_space(1)] = 300;
  const Card card = Card::open(bus);
  std::vector<test::Made> expected{
      was_read(reg::kMagic),   was_read(reg::kMapVersion),    was_read(reg::kCommandsVersion), was_read(reg::kAxes),
      was_read(reg::kClockHz), was_read(reg::kGeometryDepth), was_read(reg::kFeedDepth)};
  for (std::uint32_t i = 0; i < 64; ++i) expected.push_back(was_read(reg::descriptor(i)));
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    expected.push_back(was_read(reg::step_length(axis)));
    expected.push_back(was_read(reg::step_space(axis)));
  }
  EXPECT_EQ(bus.log, expected);
  EXPECT_THAT(bus.transfers, ElementsAre(1U, 6U, 64U, 4U));
  EXPECT_EQ(card.identification().map_major, card_map::kMapVersionValue >> 16);
  EXPECT_EQ(card.identification().map_minor, 5);
  EXPECT_EQ(card.identification().axes, 2U);
  EXPECT_EQ(card.identification().clock_hz, 100'000'000U);
  EXPECT_EQ(card.identification().engines, 0x33U);
  EXPECT_EQ(card.identification().geometry_depth, 4096U);
  EXPECT_EQ(card.identification().feed_depth, 2560U);
  EXPECT_EQ(card.timing().pulse_period[0], 7U);
  EXPECT_EQ(card.timing().pulse_period[1], 506U);
}

TEST(CardBuild, IsReadWhenAskedFor) {
  RegisterStub bus;
  bus.values[reg::kBuildId] = 0x1234ABCD;
  bus.values[reg::kBuildFlags] = field::kBuildFlagsDirty;
  bus.values[reg::kBoardId] = 7;
  Card card = Card::open(bus);
  const Build build = card.read_build();
  EXPECT_EQ(build.id, 0x1234ABCDU);
  EXPECT_TRUE(build.dirty);
  EXPECT_EQ(build.board, 7U);
  bus.values[reg::kBuildFlags] = 0;
  EXPECT_FALSE(card.read_build().dirty);
}

TEST(CardOpen, AsksNothingMoreOfWhatIsNotACard) {
  RegisterStub bus;
  bus.values[reg::kMagic] = 0xFFFFFFFF;
  EXPECT_THROW(Card::open(bus), IdentificationError);
  EXPECT_THAT(bus.log, ElementsAre(was_read(reg::kMagic)));
  bus.on_access = [](const Access&) { return false; };
  EXPECT_THROW(Card::open(bus), IdentificationError);
}

struct Malformed {
  const char* name;
  std::uint32_t address;
  std::optional<std::uint32_t> value;  // none: the read is refused
  const char* message;
};

// The second word of a descriptor: stride and words used, base as a byte address; the unit is not on the load bus.
constexpr std::uint32_t range_of(std::uint32_t stride, std::uint32_t words, std::uint32_t base) {
  return 31U << 25 | stride << 18 | words << 10 | base / 4;
}

class MalformedCard : public ::testing::TestWithParam<Malformed> {};

std::string message_of(Bus& bus) {
  try {
    Card::open(bus);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

RegisterStub malformed(const Malformed& card) {
  RegisterStub bus;
  if (card.value) {
    bus.values[card.address] = *card.value;
  } else {
    bus.on_access = [address = card.address](const Access& access) { return access.address != address; };
  }
  return bus;
}

// A link that carries frames to a stub.
class StubLink final : public ByteLink {
 public:
  explicit StubLink(RegisterStub& stub)
      : endpoint_([&stub](bool write, std::uint32_t address, std::uint32_t data) {
          Access access{address, data, write};
          const bool made = stub.transfer(&access, 1) == 1;
          return frames::Endpoint::Answer{!made, access.data};
        }) {}
  void send(const std::uint8_t* bytes, std::size_t count) override {
    for (std::size_t i = 0; i < count; ++i) endpoint_.take(bytes[i], reply_);
  }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    const std::size_t count = std::min(room, reply_.size());
    if (count == 0) now_ += longest;
    std::copy_n(reply_.begin(), count, bytes);
    reply_.erase(reply_.begin(), reply_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  void restart() override { endpoint_.connect(); }
  std::chrono::nanoseconds time_of(std::size_t) const override { return {}; }
  std::chrono::nanoseconds now() const override { return now_; }
  void sleep(std::chrono::nanoseconds time) override { now_ += time; }

 private:
  frames::Endpoint endpoint_;
  frames::Bytes reply_;
  std::chrono::nanoseconds now_{0};
};

TEST_P(MalformedCard, IsRefusedWithTheReason) {
  RegisterStub bus = malformed(GetParam());
  EXPECT_THAT(message_of(bus), HasSubstr(GetParam().message));
  for (const test::Made& made : bus.log) EXPECT_FALSE(std::get<0>(made)) << "nothing is written";
  RegisterStub far = malformed(GetParam());
  StubLink link(far);
  FrameBus frames(link);
  EXPECT_EQ(message_of(frames), message_of(bus)) << "the same over frames";
}

const Malformed kMalformed[] = {
    {"Magic", reg::kMagic, 0x4D4C5254, "0x4D4C5254"},
    {"NothingThere", reg::kMagic, 0xFFFFFFFF, "MAGIC reads 0xFFFFFFFF"},
    {"Zeros", reg::kMagic, 0, "MAGIC reads 0x00000000"},
    {"OlderMap", reg::kMapVersion, 0x00020000,
     "MAP_VERSION: 2.0, this driver takes version 3: update the card's bitstream"},
    {"NewerMap", reg::kMapVersion, 0x00040003, "MAP_VERSION: 4.3, this driver takes version 3: update the driver"},
    {"OlderCommands", reg::kCommandsVersion, 2,
     "COMMANDS_VERSION: 2, this driver takes version 3: update the card's bitstream"},
    {"NewerCommands", reg::kCommandsVersion, 4, "COMMANDS_VERSION: 4, this driver takes version 3: update the driver"},
    {"NoAxes", reg::kAxes, 0, "AXES: 0 axes, this driver takes 1 to 8"},
    {"NineAxes", reg::kAxes, 9, "AXES: 9 axes, this driver takes 1 to 8"},
    {"NoClock", reg::kClockHz, 0, "CLOCK_HZ: 0 Hz"},
    {"ShortGeometry", reg::kGeometryDepth, 36, "GEOMETRY_DEPTH: 36 halfwords, this driver takes 37 to 32768"},
    {"ShortFeed", reg::kFeedDepth, 19, "FEED_DEPTH: 19 halfwords, this driver takes 20 to 32768"},
    {"DeepGeometry", reg::kGeometryDepth, 32769, "GEOMETRY_DEPTH: 32769 halfwords"},
    {"EndlessFeed", reg::kFeedDepth, 0xFFFFFFFF, "FEED_DEPTH: 4294967295 halfwords"},
    {"StepTimes", reg::step_length(3), 0x10000, "STEP_LENGTH reads 0x00010000"},
    {"StepSpaces", reg::step_space(0), 0x20000, "STEP_SPACE reads 0x00020000"},
    // Units: words 0 and 1 describe time_base, words 8 and 9 axes, words 12 and 13 host_ports, which has no registers.
    {"NewerUnit", reg::descriptor(8), 0x00'04'20'05, "unit axes: version 2.0, this driver takes version 1"},
    {"OlderUnit", reg::descriptor(8), 0x00'04'0F'05, "unit axes: version 0.15, this driver takes version 1"},
    {"OtherAxes", reg::descriptor(8), 0x00'03'10'05, "unit axes: 3 instances, but AXES reads 4"},
    {"SmallStride", reg::descriptor(9), range_of(4, 5, 0x800),
     "unit axes: a stride of 4 words, but an instance uses 5"},
    {"OtherStride", reg::descriptor(9), range_of(8, 5, 0x800), "unit axes: registers at 0x800, 8 words apart"},
    {"EndBeyondWindow", reg::descriptor(13), range_of(0, 2, 0xFFC), "unit host_ports: its registers end at word 1025"},
    {"StrideBeyondWindow", reg::descriptor(9), range_of(127, 5, 0xC00), "unit axes: its registers end at word 1154"},
    {"Overlap", reg::descriptor(13), range_of(0, 3, 0x800),
     "unit host_ports: register 0x800 is another unit's as well"},
    {"OverlapBetween", reg::descriptor(13), range_of(0, 1, 0x910), "register 0x910 is another unit's as well"},
    {"Moved", reg::descriptor(1), range_of(0, 4, 0x400), "unit time_base: registers at 0x400"},
    {"FewerWords", reg::descriptor(1), range_of(0, 3, 0x640), "unit time_base: 3 words of registers"},
    {"Twice", reg::descriptor(12), 0x00'01'10'04, "unit feed_generator: it is described twice"},
    {"NoInstance", reg::descriptor(12), 0x00'00'10'07, "unit host_ports: 0 instances"},
    {"NoTimeBase", reg::descriptor(0), 0x00'01'10'C8, "no unit time_base, which every card has"},
    {"EndsBeforeAxes", reg::descriptor(8), 0, "no unit axes, which every card has"},
    // The card refuses reads of its identification from some register on.
    {"EndsAtMagic", reg::kMagic, std::nullopt, "the read of 0x000 was refused"},
    {"EndsAtMapVersion", reg::kMapVersion, std::nullopt, "the read of 0x004 was refused"},
    {"EndsAtClock", reg::kClockHz, std::nullopt, "the read of 0x00C was refused"},
    {"EndsAtDepths", reg::kFeedDepth, std::nullopt, "the read of 0x018 was refused"},
    {"EndsAtUnits", reg::descriptor(5), std::nullopt, "the read of 0x114 was refused"},
    {"FewerAxesThanItSays", reg::step_length(2), std::nullopt, "the read of 0x900 was refused"},
};

INSTANTIATE_TEST_SUITE_P(CardOpen, MalformedCard, ::testing::ValuesIn(kMalformed),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(MalformedCards, HaveMessagesOfTheirOwn) {
  std::set<std::string> messages;
  for (const Malformed& card : kMalformed) {
    RegisterStub bus = malformed(card);
    messages.insert(message_of(bus));
  }
  EXPECT_EQ(messages.size(), std::size(kMalformed));
  EXPECT_EQ(messages.count(""), 0U);
}

// A later card of the same major version may have a unit that this driver does not know, a unit with a higher minor
// version and a further feature, and a unit with more words.
TEST(CardOpen, TakesUnitsAndFeaturesThatItDoesNotKnow) {
  RegisterStub bus;
  const Identification now = Card::open(bus).identification();
  bus.values[reg::kMapVersion] = card_map::kMapVersionValue + 1;
  bus.values[reg::descriptor(0)] = 0x80'01'13'01;
  bus.values[reg::descriptor(1)] = range_of(0, 5, 0x640);
  const std::uint32_t end = 2 * static_cast<std::uint32_t>(now.units.size());
  bus.values[reg::descriptor(end)] = 0xFF'02'71'C8;
  bus.values[reg::descriptor(end + 1)] = range_of(16, 16, 0xF80);
  const Identification later = Card::open(bus).identification();
  EXPECT_EQ(later.map_minor, now.map_minor + 1);
  EXPECT_EQ(later.engines, now.engines);
  ASSERT_NE(later.units.find(200), nullptr);
  EXPECT_EQ(later.units.find(200)->major, 7);
  EXPECT_EQ(later.units.find(card_map::unit::kTimeBase)->words, 5);
}

TEST(CardOpen, RefusesATableWithoutEnd) {
  RegisterStub bus;
  for (std::uint32_t i = 0; i < card_map::kDescriptorSlots; ++i) bus.values[reg::descriptor(2 * i)] = 0x00'01'10'32 + i;
  EXPECT_THAT(message_of(bus), HasSubstr("its table of units does not end within 32 descriptors"));
}

// A word for a register of the identification: in half of the cases the usual word, else one near it or a random one.
std::uint32_t word_for(std::uint32_t usual, std::mt19937_64& random) {
  switch (random() % 8) {
    case 0:
      return static_cast<std::uint32_t>(random());
    case 1:
      return usual ^ 1U << random() % 32;
    case 2:
      return static_cast<std::uint32_t>(random()) >> random() % 32;
    case 3:
      return usual + static_cast<std::uint32_t>(random() % 3) - 1;
    default:
      return usual;
  }
}

// The first calls of a program on an opened card.
void use(Card& card) {
  const Identification& is = card.identification();
  EXPECT_TRUE(is.axes >= 1 && is.axes <= card_map::kMaxAxes && is.clock_hz != 0);
  EXPECT_TRUE(is.geometry_depth <= 32768 && is.feed_depth <= 32768);
  card.read_build();
  plan_line(card.timing(), {100}, std::chrono::hours(1));
  if (card_map::has_engine(is.engines, card_map::engine::kPathCommands)) {
    EXPECT_LE(card.inputs_present(), 32U);
    EXPECT_LE(card.outputs_present(), 16U);
  }
  Stream stream(card);
}

bool names_a_register(const std::string& text) {
  return text.find("unit") != std::string::npos ||
         std::any_of(std::begin(card_map::kRegisters), std::end(card_map::kRegisters),
                     [&](const auto& entry) { return text.find(std::string(entry.name)) != std::string::npos; });
}

// For any answers of the bus, open() returns a card within its bounds, or throws an error that names the register or
// the unit.
TEST(CardOpen, NonsenseIsATypedErrorOrACard) {
  constexpr std::uint64_t kSeed = 20;
  std::mt19937_64 random(kSeed);
  unsigned opened = 0;
  unsigned refused = 0;
  for (int i = 0; i < 5000; ++i) {
    RegisterStub bus;
    bus.values[reg::kPorts] = 0x04'04'01;
    bus.add_engines(card_map::engines::kPathCommands | card_map::engines::kStreaming);
    for (const std::uint32_t address :
         {reg::kMapVersion, reg::kCommandsVersion, reg::kAxes, reg::kClockHz, reg::descriptor(8), reg::descriptor(9),
          reg::kGeometryDepth, reg::kFeedDepth, reg::kBuildId, reg::kBuildFlags, reg::kBoardId, reg::kPorts,
          reg::step_length(0), reg::step_space(3)}) {
      // Only a few registers change, because open() reports the first bad one and would not reach the others.
      if (random() % 6 == 0) bus.values[address] = word_for(bus.values[address], random);
    }
    try {
      Card card = Card::open(bus);
      use(card);
      ++opened;
    } catch (const Error& error) {
      EXPECT_TRUE(names_a_register(error.what())) << error.what();
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "card " << i << ", seed " << kSeed << ": untyped: " << error.what();
    }
  }
  EXPECT_GT(opened, 1000U);
  EXPECT_GT(refused, 1000U);
}

}  // namespace
}  // namespace trammel::driver
