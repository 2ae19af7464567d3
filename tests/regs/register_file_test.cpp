// Walks the register table of the card map over the golden register file: reset values, kinds of access, every bit, no
// aliases, refusals that change nothing. Expectations come from the table and from architecture.md.
#include <gtest/gtest.h>

#include <vector>

#include "register_bench.hpp"

namespace {

using trammel::model::RegisterFile;
using trammel::tests::Answer;
using trammel::tests::RegisterBench;
namespace card_map = trammel::card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Access;
using card_map::Reason;

struct Place {
  const card_map::Register& entry;
  std::uint32_t address;
  bool present;
};

std::vector<Place> places(std::uint32_t axes) {
  std::vector<Place> all;
  for (const card_map::Register& entry : card_map::kRegisters) {
    for (std::uint32_t i = 0; i < entry.count; ++i) {
      const bool built = card_map::has_engine(RegisterFile::kDefaultEngines, entry.engine);
      all.push_back({entry, card_map::slot_address(entry, i), built && (!entry.only_present_axes || i < axes)});
    }
  }
  return all;
}

bool readable(const card_map::Register& entry) { return entry.access != Access::Command; }

// A value that the register accepts; it differs from the reset value and from 0 if possible.
std::uint32_t other_value(const card_map::Register& entry) {
  if (entry.limited == entry.mask) return entry.maximum == entry.reset ? entry.maximum - 1 : entry.maximum;
  return entry.mask & ~entry.limited;
}

// All readable registers, by address; the live registers do not change in this test.
std::vector<std::uint32_t> image(RegisterBench& bench) {
  std::vector<std::uint32_t> values;
  for (const Place& place : places(bench.axes())) {
    if (readable(place.entry) && place.present) values.push_back(bench.read(place.address).data);
  }
  return values;
}

class EveryAxisCount : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  RegisterBench bench_{GetParam()};
};

TEST_P(EveryAxisCount, ResetValues) {
  for (const Place& place : places(GetParam())) {
    if (!readable(place.entry) || !place.present || place.entry.from_card) continue;
    const Answer answer = bench_.read(place.address);
    EXPECT_FALSE(answer.error) << place.entry.name;
    EXPECT_EQ(answer.data, place.entry.reset) << place.entry.name;
  }
}

TEST_P(EveryAxisCount, DescribesItself) {
  EXPECT_EQ(bench_.read(reg::kMagic).data, 0x54524D4Cu);
  EXPECT_EQ(bench_.read(reg::kAxes).data, GetParam());
  EXPECT_EQ(bench_.read(reg::kClockHz).data, 25'000'000u);
  EXPECT_EQ(bench_.read(reg::kGeometryDepth).data, 1024u);
  EXPECT_EQ(bench_.read(reg::kFeedDepth).data, 512u);
  EXPECT_EQ(bench_.read(reg::kMapVersion).data, 0x30006u);
  EXPECT_EQ(bench_.read(reg::kCommandsVersion).data, 3u);
  EXPECT_EQ(bench_.read(reg::kPorts).data, 0x04'04'01u);
}

TEST(Identity, ComesFromTheParameters) {
  RegisterFile::Config config = RegisterBench::config_of(3);
  config.engines = RegisterFile::kMinEngines;
  config.build_id = 0xC0FFEE01;
  config.build_dirty = true;
  config.board_id = 0xB0A2D;
  config.ports = 3;
  config.idle_level = 0b101'010;
  RegisterBench bench(config);
  EXPECT_EQ(bench.read(reg::kBuildId).data, 0xC0FFEE01u);
  EXPECT_EQ(bench.read(reg::kBuildFlags).data, 1u);
  EXPECT_EQ(bench.read(reg::kBoardId).data, 0xB0A2Du);
  EXPECT_EQ(bench.read(reg::kPorts).data, 3u);
  // The strap: 010 for the first pins, 101 for the second pins.
  EXPECT_EQ(bench.read(reg::mode(0)).data, field::kModeInvertSecond);
  EXPECT_EQ(bench.read(reg::mode(1)).data, field::kModeInvertFirst);
  EXPECT_EQ(bench.read(reg::mode(2)).data, field::kModeInvertSecond);
}

// The words computed by hand from the layout on the reference page: {features, instances, version, tag} and {load unit,
// stride, words, base}.
TEST(Descriptors, OfACardWithEverythingThatAnExampleNeeds) {
  RegisterFile::Config config = RegisterBench::config_of(3);
  config.engines = RegisterFile::kMinEngines | card_map::engines::kDirectMode | card_map::engines::kClasses;
  config.ports = 2;
  RegisterBench bench(config);
  const auto word = [](unsigned load, unsigned stride, unsigned words, unsigned base) {
    return load << 25 | stride << 18 | words << 10 | base / 4;
  };
  const std::vector<std::uint32_t> expected{
      0x01'01'11'01,
      word(31, 0, 4, 0x640),  // time base with classes
      0x00'01'14'02,
      word(31, 0, 2, 0x680),  // stop control
      0x00'02'10'03,
      word(31, 1, 1, 0x6C0),  // queues without watermarks
      0x01'01'12'04,
      word(31, 0, 0, 0),  // feed generator with jerk
      0x00'03'12'05,
      word(0, 32, 7, 0x800),  // three axes
      0x00'02'10'06,
      word(31, 32, 11, 0x200),  // SNAP and STOP, 8 words and three positions
      0x00'02'10'07,
      word(31, 0, 0, 0),  // two host ports
      0x00'01'10'0A,
      word(31, 0, 15, 0xCD0),  // direct mode: 4 words per axis, two for the length, START
      0x00'01'11'10,
      word(31, 0, 1, 0x780),  // watchdog
      0x00'01'10'15,
      word(31, 0, 3, 0x7C0),  // place
      0,
      0};
  for (std::uint32_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(bench.read(reg::descriptor(i)).data, expected[i]) << "word " << i;
}

// A card with all engines: every unit once, in the order of the description, and no overlapping ranges.
TEST(Descriptors, EveryUnitOnceAndNoOverlap) {
  RegisterFile::Config config = RegisterBench::config_of(8);
  config.engines = RegisterFile::kMaxEngines;
  RegisterBench bench(config);
  std::array<bool, card_map::kWindowBytes / 4> used{};
  for (std::uint32_t i = 0; i < card_map::kUnits.size(); ++i) {
    const card_map::Descriptor d =
        card_map::descriptor_of(bench.read(reg::descriptor(2 * i)).data, bench.read(reg::descriptor(2 * i + 1)).data);
    EXPECT_EQ(d.tag, card_map::kUnits[i].tag);
    for (std::uint32_t n = 0; n < (d.stride == 0 ? 1u : d.instances); ++n) {
      for (std::uint32_t w = 0; w < d.words; ++w) {
        bool& word = used.at(d.base + n * d.stride + w);
        EXPECT_FALSE(word) << card_map::kUnits[i].name << " word " << w;
        word = true;
      }
    }
  }
  EXPECT_EQ(bench.read(reg::descriptor(2 * card_map::kUnits.size())).data, 0u);
}

// The registers of an engine, listed by hand.
TEST(Identity, WithoutDirectModeItsRegistersAreUnknown) {
  RegisterFile::Config config = RegisterBench::config_of(2);
  config.engines = RegisterFile::kDefaultEngines & ~card_map::engines::kDirectMode;
  RegisterBench bench(config);
  for (std::uint32_t address = 0xC00; address < 0xE00; address += 4) {
    EXPECT_EQ(bench.refusal_of_write(address, 1), Reason::UnknownAddress) << address;
  }
  RegisterBench with(2);
  EXPECT_EQ(with.refusal_of_write(0xCF0, 1), Reason::None) << "axis 0";
  EXPECT_EQ(with.refusal_of_write(0xCE0, 1), Reason::None) << "axis 1";
  EXPECT_EQ(with.refusal_of_write(0xCD0, 1), Reason::UnknownAddress) << "axis 2, which a card with 2 axes lacks";
  EXPECT_EQ(with.refusal_of_write(0xD08, 1), Reason::None);
}

TEST(Identity, ProbeClearNeedsItsEngine) {
  RegisterFile::Config config = RegisterBench::config_of(1);
  config.engines &= ~card_map::engines::kPathCommands;
  RegisterBench without(config);
  EXPECT_EQ(without.refusal_of_write(reg::kControl, field::kControlProbeClear), Reason::BadValue);
  RegisterBench with(1);
  EXPECT_EQ(with.refusal_of_write(reg::kControl, field::kControlProbeClear), Reason::None);
}

TEST_P(EveryAxisCount, AbsentAxesAndEnginesAreUnknown) {
  for (const Place& place : places(GetParam())) {
    if (place.present) continue;
    EXPECT_EQ(bench_.refusal_of_read(place.address), Reason::UnknownAddress) << place.entry.name;
    EXPECT_EQ(bench_.refusal_of_write(place.address, 0), Reason::UnknownAddress) << place.entry.name;
  }
}

TEST_P(EveryAxisCount, EveryBitOfASettingHoldsBothValues) {
  for (const Place& place : places(GetParam())) {
    if (place.entry.access != Access::Setting || !place.present) continue;
    for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
      if ((place.entry.mask & bit) == 0 || ((place.entry.limited & bit) != 0 && place.entry.maximum < bit)) continue;
      EXPECT_FALSE(bench_.write(place.address, bit).error) << place.entry.name << " " << bit;
      EXPECT_EQ(bench_.read(place.address).data, bit) << place.entry.name;
    }
  }
}

TEST_P(EveryAxisCount, NoSettingHasAnAlias) {
  for (const Place& place : places(GetParam())) {
    if (place.entry.access != Access::Setting || !place.present) continue;
    const std::uint32_t before = bench_.read(place.address).data;
    const std::vector<std::uint32_t> old_image = image(bench_);
    ASSERT_FALSE(bench_.write(place.address, other_value(place.entry)).error) << place.entry.name;
    ASSERT_NE(bench_.read(place.address).data, before) << place.entry.name;
    const std::vector<std::uint32_t> new_image = image(bench_);
    int changes = 0;
    for (std::size_t i = 0; i < old_image.size(); ++i) changes += old_image[i] != new_image[i];
    EXPECT_EQ(changes, 1) << place.entry.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, EveryAxisCount, ::testing::Values(1u, 3u, 4u, 8u));

TEST(Refusals, EveryAddressOutsideTheMapIsUnknown) {
  RegisterBench bench(8);
  for (std::uint32_t address = 0; address < card_map::kWindowBytes; ++address) {
    if (card_map::find_register(address).entry != nullptr) continue;
    ASSERT_EQ(bench.refusal_of_read(address), Reason::UnknownAddress) << address;
    ASSERT_EQ(bench.refusal_of_write(address, 0), Reason::UnknownAddress) << address;
  }
}

TEST(Refusals, KindsOfAccess) {
  RegisterBench bench(8);
  for (const Place& place : places(8)) {
    if (!place.present) continue;
    const Access access = place.entry.access;
    const bool fixed = access == Access::Constant || access == Access::Live || access == Access::Snapshot;
    if (fixed) {
      EXPECT_EQ(bench.refusal_of_write(place.address, 0), Reason::ReadOnly) << place.entry.name;
    } else {
      EXPECT_EQ(bench.refusal_of_partial_write(place.address, 1), Reason::PartialWrite) << place.entry.name;
    }
    EXPECT_EQ(bench.refusal_of_read(place.address), readable(place.entry) ? Reason::None : Reason::WriteOnly)
        << place.entry.name;
  }
}

TEST(Refusals, BitsWithoutMeaningAndLimits) {
  RegisterBench bench(8);
  for (const Place& place : places(8)) {
    const card_map::Register& entry = place.entry;
    if (!place.present) continue;
    if (entry.access != Access::Setting && entry.access != Access::ClearOnes && entry.access != Access::Command)
      continue;
    for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
      if ((card_map::bits_with_meaning(entry, RegisterFile::kDefaultEngines) & bit) != 0) continue;
      EXPECT_EQ(bench.refusal_of_write(place.address, entry.reset | bit), Reason::BadValue) << entry.name << " " << bit;
    }
    if (entry.limited == 0) continue;
    if (entry.maximum < entry.limited) {
      EXPECT_EQ(bench.refusal_of_write(place.address, entry.maximum + 1), Reason::BadValue) << entry.name;
    }
    if (entry.minimum > 0) {
      EXPECT_EQ(bench.refusal_of_write(place.address, entry.minimum - 1), Reason::BadValue) << entry.name;
    }
    EXPECT_EQ(bench.refusal_of_write(place.address, entry.minimum), Reason::None) << entry.name;
    EXPECT_EQ(bench.refusal_of_write(place.address, entry.maximum), Reason::None) << entry.name;
  }
}

// SET_PLACE can only be written; its value goes out on the setting bus.
TEST(SetPlace, IsAnActionThatNothingIsReadBackOf) {
  RegisterBench bench(4);
  bench.settings = 0;
  EXPECT_FALSE(bench.write(reg::kSetPlace, 0x000F0003).error);
  EXPECT_EQ(bench.settings, 1u);
  EXPECT_TRUE(bench.read(reg::kSetPlace).error);
  EXPECT_EQ(bench.read(reg::kRefusal).data & field::kRefusalReason, static_cast<std::uint32_t>(Reason::WriteOnly));
  EXPECT_EQ(bench.read(reg::kScales).data, 0u);
  EXPECT_TRUE(bench.write(reg::kSetPlace, 4).error) << "a bit without meaning";
  EXPECT_TRUE(bench.write(reg::kPlace, 0).error) << "the card alone changes it";
}

TEST(Refusals, ChangeNothing) {
  RegisterBench bench(4);
  for (const Place& place : places(4)) {
    if (place.entry.access == Access::Setting && place.present) bench.write(place.address, other_value(place.entry));
  }
  const std::vector<std::uint32_t> before = image(bench);
  for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4) {
    bench.settings = 0;
    EXPECT_NE(bench.refusal_of_partial_write(address, 0x1), Reason::None) << address;
    EXPECT_EQ(bench.settings, 0u) << address;
  }
  EXPECT_EQ(image(bench), before);
}

TEST(Refusals, TheFirstOneStaysUntilItIsCleared) {
  RegisterBench bench(4);
  EXPECT_TRUE(bench.write(reg::kMagic, 0).error);
  EXPECT_TRUE(bench.read(reg::kStream).error);
  const std::uint32_t refusal = bench.read(reg::kRefusal).data;
  EXPECT_EQ(refusal & field::kRefusalReason, static_cast<std::uint32_t>(Reason::ReadOnly));
  EXPECT_EQ((refusal & field::kRefusalAddress) >> field::kRefusalAddressShift, reg::kMagic);
  EXPECT_NE(bench.read(reg::kStatus).data & field::kStatusRefused, 0u);
  EXPECT_FALSE(bench.write(reg::kRefusal, 0).error);
  EXPECT_EQ(bench.read(reg::kRefusal).data, refusal) << "a write of zeros clears nothing";
  EXPECT_FALSE(bench.write(reg::kRefusal, 1).error);
  EXPECT_EQ(bench.read(reg::kRefusal).data, 0u);
  EXPECT_EQ(bench.read(reg::kStatus).data & field::kStatusRefused, 0u);
}

}  // namespace
