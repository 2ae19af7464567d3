#include "trammel/driver/commands.hpp"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <tuple>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

std::vector<std::uint32_t> words_of(const Command& command, std::uint8_t number = 0) {
  std::vector<std::uint32_t> words;
  encode(command, number, words);
  return words;
}

// The message of the ArgumentError; empty if there is none. A refused command must not append anything.
std::string refusal_of(const Command& command) {
  std::vector<std::uint32_t> words{42};
  try {
    encode(command, 0, words);
  } catch (const ArgumentError& error) {
    EXPECT_THAT(words, ElementsAre(42U));
    return error.what();
  }
  return "";
}

ArcCommand some_arc() {
  ArcCommand arc;
  arc.ticks = 1000;
  arc.path_ticks = 800;
  arc.prescale = 0xCCCCCCCCCD;
  arc.quadrants = 1;
  arc.end_x = -3;
  arc.deviation = -1;
  arc.half_x = 1;
  arc.half_y = 1;
  return arc;
}

ArcChordCommand some_arc_chord() {
  ArcChordCommand arc;
  arc.ticks = 0x900;
  arc.path_ticks = 0x800;
  arc.prescale = 0xE38E38E38E;
  arc.mask = 0b1111;
  arc.clockwise = true;
  arc.axis_x = 2;
  arc.axis_y = 0;
  arc.k = 4;
  arc.m = 9;
  arc.x = 0x0123456789ABCDEF;
  arc.y = -2;
  arc.first_x = 0x111122223;
  arc.first_y = -1;
  arc.closing_x = 5;
  arc.closing_y = -6;
  arc.increment[1] = 7;
  arc.increment[3] = -8;
  return arc;
}

TEST(Commands, ALineIsLaidOutAsTheLayoutPageSays) {
  LineCommand line;
  line.ticks = 0x0123456789;
  line.mask = 0b0101;
  line.increment[0] = 0x10000000000;  // 2^40, one pulse per tick
  line.increment[2] = -2;
  // Halfwords: 0501 0706 | 6789 2345 | 0001 0000 | 0000 0100 | FFFE FFFF | FFFF and padding.
  EXPECT_THAT(words_of(line, 7),
              ElementsAre(0x07060501U, 0x23456789U, 0x00000001U, 0x01000000U, 0xFFFFFFFEU, 0x0000FFFFU));
}

TEST(Commands, APieceIsLaidOutAsTheLayoutPageSays) {
  FeedCommand feed;
  feed.ticks = 5;
  feed.rate = 0x0123456789ABCDEF;
  feed.floor = 0x11112222;
  feed.stop_distance = 0x33334444;
  feed.acceleration = -2;
  feed.jerk = 3;
  // Halfwords: 0010 000B | 0005 0000 | 0000 CDEF | 89AB 4567 | 0123 2222 | 1111 4444 | 3333 FFFE | ... | 0003 ...
  EXPECT_THAT(words_of(feed, 0), ElementsAre(0x000B0010U, 0x00000005U, 0xCDEF0000U, 0x456789ABU, 0x22220123U,
                                             0x44441111U, 0xFFFE3333U, 0xFFFFFFFFU, 0x0003FFFFU, 0U, 0U));
}

TEST(Commands, AnArcInChordsIsLaidOutAsTheLayoutPageSays) {
  // Header, count, path_ticks, prescale, plane, shifts, x, y, first and closing increments, then those of axes 1 and 3.
  EXPECT_THAT(words_of(some_arc_chord(), 3),
              ElementsAreArray<std::uint32_t>({0x03140F03U, 0x00000900U, 0x08000000U, 0x00000000U, 0x8E38E38EU,
                                               0x002100E3U, 0xCDEF0904U, 0x456789ABU, 0xFFFE0123U, 0xFFFFFFFFU,
                                               0x2223FFFFU, 0x00011112U, 0xFFFFFFFFU, 0x0005FFFFU, 0x00000000U,
                                               0xFFFFFFFAU, 0x0007FFFFU, 0x00000000U, 0xFFFFFFF8U, 0x0000FFFFU}));
}

TEST(Commands, WhatStandsBesideThePathIsDecodedAgain) {
  const auto again = [](const Command& command) {
    const auto words = words_of(command, 9);
    return decode(words.data(), words.size()).command;
  };
  const auto output = std::get<OutputCommand>(again(OutputCommand{0x1234, 0x5678}));
  EXPECT_EQ(output.set, 0x1234);
  EXPECT_EQ(output.clear, 0x5678);
  EXPECT_TRUE(std::holds_alternative<MarkCommand>(again(MarkCommand{})));
  const auto wait = std::get<WaitInputCommand>(again(WaitInputCommand{7, false, 12345}));
  EXPECT_EQ(wait.input, 7);
  EXPECT_FALSE(wait.level);
  EXPECT_EQ(wait.timeout, 12345U);
  const auto probe = std::get<ProbeCommand>(again(ProbeCommand{9, true}));
  EXPECT_EQ(probe.input, 9);
  EXPECT_TRUE(probe.level);
  EXPECT_TRUE(std::holds_alternative<ProbeEndCommand>(again(ProbeEndCommand{})));
  const auto pwm = std::get<PwmCommand>(again(PwmCommand{1, 0x1234, true, 31, 0x5678}));
  EXPECT_EQ(pwm.channel, 1);
  EXPECT_EQ(pwm.duty, 0x1234);
  EXPECT_TRUE(pwm.follows);
  EXPECT_EQ(pwm.shift, 31);
  EXPECT_EQ(pwm.gain, 0x5678);
  const auto fixed = std::get<PwmCommand>(again(PwmCommand{0, 0xFFFF, false, 0, 0}));
  EXPECT_EQ(fixed.channel, 0);
  EXPECT_FALSE(fixed.follows);
  EXPECT_EQ(std::get<DwellCommand>(again(DwellCommand{0x123456789})).clocks, 0x123456789U);
  EXPECT_TRUE(std::holds_alternative<EndCommand>(again(EndCommand{})));
}

TEST(Commands, CommandsOfThatThisDriverHasNoneAreNotDecoded) {
  const std::vector<std::uint32_t> fourth{0x000B0310U, 5, 0, 0, 0x00010000U, 0, 0, 0, 0, 0, 0};
  EXPECT_THROW(decode(fourth.data(), fourth.size()), ArgumentError) << "a fourth class";
}

TEST(Commands, TheClassOfAPieceIsInItsFlags) {
  FeedCommand feed;
  feed.ticks = 5;
  feed.floor = 1;
  for (const PieceClass piece_class : {PieceClass::kFeed, PieceClass::kRapid, PieceClass::kFixed}) {
    feed.piece_class = piece_class;
    const std::vector<std::uint32_t> words = words_of(feed, 0);
    EXPECT_EQ(words[0], 0x000B0010U | static_cast<std::uint32_t>(piece_class) << 8);
    EXPECT_EQ(std::get<FeedCommand>(decode(words.data(), words.size()).command).piece_class, piece_class);
  }
  feed.piece_class = static_cast<PieceClass>(3);
  EXPECT_THROW(words_of(feed, 0), ArgumentError);
}

TEST(Commands, SoIsItsSlewShift) {
  FeedCommand feed;
  feed.ticks = 5;
  feed.floor = 1;
  feed.piece_class = PieceClass::kFixed;
  for (std::uint8_t shift = 0; shift <= kMaxSlewShift; ++shift) {
    feed.slew_shift = shift;
    const std::vector<std::uint32_t> words = words_of(feed, 0);
    EXPECT_EQ(words[0], 0x000B0210U | std::uint32_t{shift} << 11);
    const auto read = std::get<FeedCommand>(decode(words.data(), words.size()).command);
    EXPECT_EQ(read.slew_shift, shift);
    EXPECT_EQ(read.piece_class, PieceClass::kFixed);
    EXPECT_FALSE(read.silent);
  }
  feed.slew_shift = kMaxSlewShift + 1;
  EXPECT_THROW(words_of(feed, 0), ArgumentError);
}

TEST(Commands, SoIsItsSilence) {
  FeedCommand feed;
  feed.ticks = 5;
  feed.floor = 1;
  feed.piece_class = PieceClass::kRapid;
  feed.silent = true;
  const std::vector<std::uint32_t> words = words_of(feed, 0);
  EXPECT_EQ(words[0], 0x000B0510U);
  const auto read = std::get<FeedCommand>(decode(words.data(), words.size()).command);
  EXPECT_TRUE(read.silent);
  EXPECT_EQ(read.piece_class, PieceClass::kRapid);
}

// The constant is the limit of the card's layouts, not the length of this driver's longest command. Later commands
// still fit.
TEST(Commands, NoCommandIsLongerThanTheConstant) {
  EXPECT_EQ(kMaxCommandWords, 26U);
  ArcCommand arc = some_arc();
  std::array<std::uint32_t, kMaxCommandWords> words{};
  EXPECT_EQ(encode(arc, 3, words.data()), 19U);
  EXPECT_THAT(words_of(arc, 3), ::testing::ElementsAreArray(words.data(), 19));
}

TEST(Commands, BarriersAreThreeWords) {
  EXPECT_THAT(words_of(DwellCommand{0x0123456789}, 255), ElementsAre(0xFF030020U, 0x23456789U, 0x00000001U));
  EXPECT_THAT(words_of(EndCommand{}, 1), ElementsAre(0x01030021U, 0U, 0U));
  EXPECT_THAT(words_of(OutputCommand{0x8001, 0x4002}, 2), ElementsAre(0x02040022U, 0U, 0x80010000U, 0x00004002U));
  EXPECT_THAT(words_of(MarkCommand{}, 3), ElementsAre(0x03030023U, 0U, 0U));
  EXPECT_THAT(words_of(WaitInputCommand{5, true, 0x0123456789}, 4), ElementsAre(0x04030024U, 0x23456789U, 0x00250001U));
  EXPECT_THAT(words_of(ProbeCommand{31, false}, 5), ElementsAre(0x05030025U, 0U, 0x001F0000U));
  EXPECT_THAT(words_of(ProbeEndCommand{}, 6), ElementsAre(0x06030026U, 0U, 0U));
  EXPECT_THAT(words_of(PwmCommand{1, 0x1234, true, 5, 0x5678}, 7),
              ElementsAre(0x07040027U, 0U, 0x05110000U, 0x56781234U));
}

TEST(Commands, LimitsOfALineAreKept) {
  LineCommand line;
  line.mask = 1;
  line.increment[0] = std::int64_t{1} << 40;
  EXPECT_THAT(refusal_of(line), HasSubstr("count 0"));
  line.ticks = std::uint64_t{1} << 40;
  EXPECT_THAT(refusal_of(line), HasSubstr("count 1099511627776"));
  line.ticks -= 1;
  EXPECT_EQ(refusal_of(line), "");
  line.increment[0] += 1;
  EXPECT_THAT(refusal_of(line), HasSubstr("increment = 1099511627777"));
  line.increment[0] = -(std::int64_t{1} << 40) - 1;
  EXPECT_THAT(refusal_of(line), HasSubstr("increment = -1099511627777"));
  line.increment[0] = 0;
  line.increment[1] = 1;
  EXPECT_THAT(refusal_of(line), HasSubstr("axis 1"));
  line = LineCommand{};
  line.ticks = 1;
  EXPECT_THAT(refusal_of(line), HasSubstr("mask 0x00"));
}

TEST(Commands, LimitsOfAnArcAreKept) {
  EXPECT_EQ(refusal_of(some_arc()), "");
  const auto with = [](auto change) {
    ArcCommand arc = some_arc();
    change(arc);
    return refusal_of(arc);
  };
  EXPECT_THAT(with([](ArcCommand& arc) { arc.path_ticks = arc.ticks + 1; }), HasSubstr("path_ticks = 1001"));
  EXPECT_THAT(with([](ArcCommand& arc) { arc.path_ticks = 0; }), HasSubstr("path_ticks = 0"));
  EXPECT_THAT(with([](ArcCommand& arc) { arc.prescale = (std::uint64_t{1} << 40) + 1; }), HasSubstr("prescale"));
  EXPECT_THAT(with([](ArcCommand& arc) { arc.axis_y = arc.axis_x; }), HasSubstr("plane"));
  EXPECT_THAT(with([](ArcCommand& arc) { arc.axis_y = 8; }), HasSubstr("plane"));
  EXPECT_THAT(with([](ArcCommand& arc) { arc.half_x = std::uint64_t{1} << 48; }), HasSubstr("half_x"));
  EXPECT_THAT(with([](ArcCommand& arc) { arc.deviation = Int128(1) << 79; }), HasSubstr("deviation"));
  EXPECT_EQ(with([](ArcCommand& arc) { arc.deviation = -(Int128(1) << 79); }), "");
  EXPECT_THAT(with([](ArcCommand& arc) { arc.gradient_y = -(Int128(1) << 79) - 1; }), HasSubstr("gradient_y"));
}

TEST(Commands, LimitsOfAnArcInChordsAreKept) {
  EXPECT_EQ(refusal_of(some_arc_chord()), "");
  const auto with = [](auto change) {
    ArcChordCommand arc = some_arc_chord();
    change(arc);
    return refusal_of(arc);
  };
  constexpr std::int64_t kMax = std::int64_t{1} << 40;
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.path_ticks = arc.ticks + 1; }), HasSubstr("path_ticks = 2305"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.ticks = arc.path_ticks = std::uint64_t{1} << 37; }),
              HasSubstr("path_ticks = 137438953472"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.k = 32; }), HasSubstr("shifts 32 and 9"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.m = 32; }), HasSubstr("shifts 4 and 32"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.axis_x = 0; }), HasSubstr("plane"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.axis_x = 8; }), HasSubstr("plane"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.mask = 0b1110; }), HasSubstr("without the axes 2 and 0"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.increment[2] = 1; }), HasSubstr("axis 2"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.increment[4] = 1; }), HasSubstr("axis 4"));
  EXPECT_EQ(with([](ArcChordCommand& arc) { arc.first_x = -kMax; }), "");
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.first_x = -kMax - 1; }), HasSubstr("first_x"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.closing_y = kMax + 1; }), HasSubstr("closing_y"));
  EXPECT_THAT(with([](ArcChordCommand& arc) { arc.increment[3] = kMax + 1; }), HasSubstr("increment"));
}

// If mask and plane contradict each other, the words hold fewer increments than the mask says.
TEST(Commands, AnArcInChordsWithoutItsPlaneIsNotDecoded) {
  ArcChordCommand arc = some_arc_chord();
  arc.mask = 0b0101;
  arc.increment.fill(0);
  const auto good = words_of(arc);
  EXPECT_NO_THROW(decode(good.data(), good.size()));
  for (const std::uint32_t plane : {0x0031U, 0x0220U, 0x0711U}) {
    auto bad = good;
    bad[5] = (bad[5] & 0xFFFFU) | plane << 16U;
    EXPECT_THROW(decode(bad.data(), bad.size()), ArgumentError) << plane;
  }
}

TEST(Commands, LimitsOfAFeedPieceAndADwellAreKept) {
  FeedCommand feed;
  feed.ticks = 1;
  EXPECT_EQ(refusal_of(feed), "");
  feed.floor = 0;
  EXPECT_THAT(refusal_of(feed), HasSubstr("floor = 0"));
  feed.floor = 1;
  feed.stop_distance = 0xFFFFFFFF;
  EXPECT_EQ(refusal_of(feed), "");
  EXPECT_THAT(refusal_of(DwellCommand{std::uint64_t{1} << 40}), HasSubstr("DWELL: count"));
  EXPECT_THAT(refusal_of(WaitInputCommand{1, true, std::uint64_t{1} << 40}), HasSubstr("WAIT_INPUT: count"));
  EXPECT_THAT(refusal_of(WaitInputCommand{32}), HasSubstr("WAIT_INPUT: input 32"));
  EXPECT_THAT(refusal_of(ProbeCommand{32}), HasSubstr("PROBE: input 32"));
}

TEST(Commands, LimitsOfPulsesOnOutputsAreKept) {
  EXPECT_EQ(refusal_of(PwmCommand{1, 0xFFFF, true, 31, 0xFFFF}), "");
  EXPECT_EQ(refusal_of(PwmCommand{2, 1, true, 0, 1}), "PWM: channel 2");
  EXPECT_EQ(refusal_of(PwmCommand{0, 1, true, 32, 1}), "PWM: shift 32");
}

// The card counts paths, pieces and barriers, but not commands that take no time.
TEST(Commands, WhatTakesNoTimeNeverCountsAsBegun) {
  for (const Command& command : std::vector<Command>{LineCommand{}, ArcCommand{}, FeedCommand{}, DwellCommand{},
                                                     EndCommand{}, WaitInputCommand{}, ProbeEndCommand{}}) {
    EXPECT_TRUE(counts_as_begun(command)) << layout_of(command).name;
  }
  for (const Command& command : std::vector<Command>{OutputCommand{}, MarkCommand{}, ProbeCommand{}, PwmCommand{}}) {
    EXPECT_FALSE(counts_as_begun(command)) << layout_of(command).name;
  }
}

TEST(Commands, DecodeRefusesWhatEncodeCannotMake) {
  LineCommand line;
  line.ticks = 5;
  line.mask = 1;
  const auto good = words_of(line);
  EXPECT_NO_THROW(decode(good.data(), good.size()));
  EXPECT_THROW(decode(good.data(), 0), ArgumentError);
  EXPECT_THROW(decode(good.data(), good.size() - 1), ArgumentError);
  const auto refuses = [&good](std::size_t word, std::uint32_t flip) {
    auto bad = good;
    bad[word] ^= flip;
    EXPECT_THROW(decode(bad.data(), bad.size()), ArgumentError) << word << " " << flip;
  };
  refuses(0, 0x80);        // opcode
  refuses(0, 0x200);       // a second axis without its field
  refuses(0, 0x10000);     // length
  refuses(2, 0x100);       // count bit 40
  refuses(3, 0x80000000);  // increment not sign-extended: 2^47
  const auto arc_words = words_of(some_arc());
  auto arc = arc_words;
  arc[0] ^= 0x600;  // mask names other axes than the plane
  EXPECT_THROW(decode(arc.data(), arc.size()), ArgumentError);
}

TEST(Commands, PaddingMustBeZero) {
  const auto good = words_of(EndCommand{});
  auto bad = good;
  bad.back() |= 0x10000;
  EXPECT_NO_THROW(decode(good.data(), good.size()));
  EXPECT_THROW(decode(bad.data(), bad.size()), ArgumentError);
}

std::int64_t signed_bits(unsigned bits) {
  const auto limit = std::int64_t{1} << bits;
  return *rc::gen::inRange<std::int64_t>(-limit, limit + 1);
}

Int128 any_80_bits() {
  const auto high = *rc::gen::inRange<std::int64_t>(-(1 << 15), 1 << 15);
  return Int128(Uint128(static_cast<std::uint64_t>(high), *rc::gen::arbitrary<std::uint64_t>()));
}

void expect_round_trip(const Command& command, std::uint8_t number) {
  const auto words = words_of(command, number);
  const auto& layout = *card_map::find_command(static_cast<std::uint8_t>(words[0]));
  RC_ASSERT(words.size() == card_map::words(layout, static_cast<std::uint8_t>(words[0] >> 8)));
  const DecodedCommand back = decode(words.data(), words.size());
  RC_ASSERT(back.number == number);
  RC_ASSERT(back.command.index() == command.index());
  RC_ASSERT(words_of(back.command, number) == words);
}

RC_GTEST_PROP(CommandsProperty, ALineComesBack, ()) {
  const auto number = *rc::gen::arbitrary<std::uint8_t>();
  LineCommand line;
  line.ticks = *rc::gen::inRange<std::uint64_t>(1, std::uint64_t{1} << 40);
  line.mask = static_cast<std::uint8_t>(*rc::gen::inRange(1, 256));
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    line.increment[axis] = (std::uint32_t{line.mask} >> axis & 1U) != 0 ? signed_bits(40) : 0;
  }
  expect_round_trip(line, number);
  const auto words = words_of(line, number);
  const LineCommand back = std::get<LineCommand>(decode(words.data(), words.size()).command);
  RC_ASSERT(back.ticks == line.ticks);
  RC_ASSERT(back.mask == line.mask);
  RC_ASSERT(back.increment == line.increment);
}

RC_GTEST_PROP(CommandsProperty, AnArcComesBack, ()) {
  const auto number = *rc::gen::arbitrary<std::uint8_t>();
  const auto clockwise = *rc::gen::arbitrary<bool>();
  const auto quadrants = *rc::gen::arbitrary<std::uint16_t>();
  const auto end_x = *rc::gen::arbitrary<std::int32_t>();
  const auto end_y = *rc::gen::arbitrary<std::int32_t>();
  ArcCommand arc;
  arc.ticks = *rc::gen::inRange<std::uint64_t>(1, std::uint64_t{1} << 40);
  arc.path_ticks = *rc::gen::inRange<std::uint64_t>(1, arc.ticks + 1);
  arc.prescale = *rc::gen::inRange<std::uint64_t>(0, (std::uint64_t{1} << 40) + 1);
  arc.clockwise = clockwise;
  arc.eight_directions = *rc::gen::arbitrary<bool>();
  arc.axis_x = static_cast<std::uint8_t>(*rc::gen::inRange(0, 8));
  arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + *rc::gen::inRange(1, 8)) % 8);
  arc.quadrants = quadrants;
  arc.end_x = end_x;
  arc.end_y = end_y;
  arc.deviation = any_80_bits();
  arc.gradient_x = any_80_bits();
  arc.gradient_y = any_80_bits();
  arc.half_x = *rc::gen::inRange<std::uint64_t>(0, std::uint64_t{1} << 48);
  arc.half_y = *rc::gen::inRange<std::uint64_t>(0, std::uint64_t{1} << 48);
  expect_round_trip(arc, number);
  const auto words = words_of(arc, number);
  const ArcCommand back = std::get<ArcCommand>(decode(words.data(), words.size()).command);
  RC_ASSERT(back.path_ticks == arc.path_ticks);
  RC_ASSERT(back.prescale == arc.prescale);
  RC_ASSERT(back.clockwise == arc.clockwise);
  RC_ASSERT(back.eight_directions == arc.eight_directions);
  RC_ASSERT(back.axis_x == arc.axis_x);
  RC_ASSERT(back.axis_y == arc.axis_y);
  RC_ASSERT(back.quadrants == arc.quadrants);
  RC_ASSERT(back.end_x == arc.end_x);
  RC_ASSERT(back.end_y == arc.end_y);
  RC_ASSERT(back.deviation == arc.deviation);
  RC_ASSERT(back.gradient_x == arc.gradient_x);
  RC_ASSERT(back.gradient_y == arc.gradient_y);
  RC_ASSERT(back.half_x == arc.half_x);
  RC_ASSERT(back.half_y == arc.half_y);
}

RC_GTEST_PROP(CommandsProperty, AnArcInChordsComesBack, ()) {
  const auto number = *rc::gen::arbitrary<std::uint8_t>();
  const auto clockwise = *rc::gen::arbitrary<bool>();
  ArcChordCommand arc;
  arc.ticks = *rc::gen::inRange<std::uint64_t>(1, std::uint64_t{1} << 40);
  arc.path_ticks = *rc::gen::inRange<std::uint64_t>(1, std::min(arc.ticks + 1, std::uint64_t{1} << 37));
  arc.prescale = *rc::gen::inRange<std::uint64_t>(0, (std::uint64_t{1} << 40) + 1);
  arc.clockwise = clockwise;
  arc.axis_x = static_cast<std::uint8_t>(*rc::gen::inRange(0, 8));
  arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + *rc::gen::inRange(1, 8)) % 8);
  const unsigned plane = 1U << arc.axis_x | 1U << arc.axis_y;
  arc.mask = static_cast<std::uint8_t>(plane | static_cast<unsigned>(*rc::gen::inRange(0, 256)));
  arc.k = static_cast<std::uint8_t>(*rc::gen::inRange(0, 32));
  arc.m = static_cast<std::uint8_t>(*rc::gen::inRange(0, 32));
  arc.x = *rc::gen::arbitrary<std::int64_t>();
  arc.y = *rc::gen::arbitrary<std::int64_t>();
  arc.first_x = signed_bits(40);
  arc.first_y = signed_bits(40);
  arc.closing_x = signed_bits(40);
  arc.closing_y = signed_bits(40);
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    arc.increment[axis] = ((arc.mask & ~plane) >> axis & 1U) != 0 ? signed_bits(40) : 0;
  }
  expect_round_trip(arc, number);
  const auto words = words_of(arc, number);
  const auto back = std::get<ArcChordCommand>(decode(words.data(), words.size()).command);
  const auto all = [](const ArcChordCommand& a) {
    return std::tuple(a.ticks, a.path_ticks, a.prescale, a.mask, a.clockwise, a.axis_x, a.axis_y, a.k, a.m, a.x, a.y,
                      a.first_x, a.first_y, a.closing_x, a.closing_y, a.increment);
  };
  RC_ASSERT(all(back) == all(arc));
}

RC_GTEST_PROP(CommandsProperty, AFeedPieceComesBack, ()) {
  const auto number = *rc::gen::arbitrary<std::uint8_t>();
  const auto rate = *rc::gen::arbitrary<std::uint64_t>();
  const auto acceleration = *rc::gen::arbitrary<std::int64_t>();
  const auto jerk = *rc::gen::arbitrary<std::int64_t>();
  FeedCommand feed;
  feed.ticks = *rc::gen::inRange<std::uint64_t>(1, std::uint64_t{1} << 40);
  feed.rate = rate;
  feed.acceleration = acceleration;
  feed.jerk = jerk;
  feed.floor = *rc::gen::inRange<std::uint32_t>(1, std::numeric_limits<std::uint32_t>::max());
  feed.stop_distance = *rc::gen::arbitrary<std::uint32_t>();
  expect_round_trip(feed, number);
  const auto words = words_of(feed, number);
  const FeedCommand back = std::get<FeedCommand>(decode(words.data(), words.size()).command);
  RC_ASSERT(back.ticks == feed.ticks);
  RC_ASSERT(back.rate == feed.rate);
  RC_ASSERT(back.acceleration == feed.acceleration);
  RC_ASSERT(back.jerk == feed.jerk);
  RC_ASSERT(back.floor == feed.floor);
  RC_ASSERT(back.stop_distance == feed.stop_distance);
}

}  // namespace
}  // namespace trammel::driver
