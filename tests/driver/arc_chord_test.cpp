// Fields of the commands that the driver makes for the arc generator. tests/model/arc_generator_test.cpp checks on the
// golden model that these arcs end at their end point and stay on the circle.
#include "trammel/driver/arc_chord.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "trammel/driver/trigonometry.hpp"

namespace trammel::driver {
namespace {

using ::testing::HasSubstr;

// A circle from an angle of 0, so its centre is to the left of the start.
HelixGeometry circle_of(std::int64_t radius) {
  HelixGeometry helix;
  helix.arc.centre_x = -radius * kCentreUnitsPerPulse;
  helix.arc.sweep = 2 * kPi;
  return helix;
}

std::string refusal_of(const HelixGeometry& helix, std::uint64_t ticks = 1 << 20) {
  try {
    make_helix(helix, ticks);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ArcChord, FieldsOfACircle) {
  const ArcChordCommand arc = make_helix(circle_of(1024), 1'000'000);
  EXPECT_EQ(arc.k, 6) << "1024 / 2^6 is 16";
  // 402.1 chords of 16 pulses. 2^11 path ticks per chord is the largest number that fits into the ticks.
  EXPECT_EQ(arc.m, 11);
  EXPECT_EQ(arc.path_ticks, static_cast<std::uint64_t>(std::llround(kPi / std::asin(0x1p-7) * 2048)));
  EXPECT_EQ(arc.ticks, 1'000'000U);
  EXPECT_EQ(arc.prescale, static_cast<std::uint64_t>(std::llround(static_cast<double>(arc.path_ticks) / 1e6 * 0x1p40)));
  EXPECT_EQ(arc.mask, 3);
  EXPECT_EQ(arc.x, std::int64_t{1024} << 29);
  EXPECT_EQ(arc.y, -(std::int64_t{1024} << 22)) << "half a chord before the start: its sine is 2^-7";
  EXPECT_NEAR(static_cast<double>(arc.first_y), 0x1p40 * 16 / 2048, 0x1p40 * 1e-5) << "16 pulses in 2048 ticks";
}

TEST(ArcChord, ClockwiseIsTheMirrorImage) {
  HelixGeometry helix = circle_of(100);
  const ArcChordCommand left = make_helix(helix, 100'000);
  helix.arc.clockwise = true;
  const ArcChordCommand right = make_helix(helix, 100'000);
  EXPECT_TRUE(right.clockwise);
  EXPECT_EQ(right.x, left.x);
  EXPECT_EQ(right.y, -left.y);
  EXPECT_NEAR(static_cast<double>(right.first_x), static_cast<double>(left.first_x), 1);
  EXPECT_NEAR(static_cast<double>(right.first_y), static_cast<double>(-left.first_y), 1);
}

// The sagitta of a chord is R (1 - cos(turn / 2)), about R / 2^(2k + 3). A chord has at most 16 pulses.
TEST(ArcChord, TheSmallestShiftThatKeepsTheSagitta) {
  for (double radius = 1; radius < 2e9; radius *= 1.3) {
    const auto whole = static_cast<std::int64_t>(radius);
    HelixGeometry helix = circle_of(whole);
    helix.arc.sweep = 1000 / (1000 + radius);
    const double r = static_cast<double>(whole);
    helix.arc.end_x = static_cast<std::int32_t>(std::lround(r * (std::cos(helix.arc.sweep) - 1)));
    helix.arc.end_y = static_cast<std::int32_t>(std::lround(r * std::sin(helix.arc.sweep)));
    const int k = make_helix(helix, 1 << 20).k;
    const auto fits = [&](int shift) { return std::ldexp(r, -shift) <= 1.01 * std::min(std::sqrt(r) / 2, 16.0); };
    EXPECT_TRUE(fits(k)) << whole;
    EXPECT_TRUE(k == 1 || !fits(k - 2)) << whole;
    EXPECT_LE(r * (1 - std::cos(std::asin(std::ldexp(1, -k - 1)))), 1.0 / 31) << whole;
  }
}

TEST(ArcChord, AsManyPathTicksAsFit) {
  const HelixGeometry helix = circle_of(300);
  const std::uint64_t least = least_chord_ticks(helix);
  EXPECT_EQ(make_helix(helix, least).path_ticks, least);
  EXPECT_EQ(make_helix(helix, 2 * least - 2).path_ticks, least);
  for (const std::uint64_t ticks : {2 * least + 2, 5 * least, 1000 * least, std::uint64_t{1} << 39U}) {
    const ArcChordCommand arc = make_helix(helix, ticks);
    EXPECT_LE(arc.path_ticks, ticks);
    EXPECT_TRUE(2 * arc.path_ticks + 1 >= ticks || arc.m == 31 || 2 * arc.path_ticks >= std::uint64_t{1} << 37U);
    EXPECT_EQ(std::llround(std::ldexp(static_cast<double>(arc.path_ticks), 5 - arc.m)),
              static_cast<std::int64_t>(least));
  }
  EXPECT_THAT(refusal_of(helix, least - 1), HasSubstr("too few"));
  EXPECT_THAT(refusal_of(helix, std::uint64_t{1} << 40U), HasSubstr("fewer than 2^40"));
}

TEST(ArcChord, FurtherAxesGoAlongLines) {
  HelixGeometry helix = circle_of(50);
  helix.arc.axis_x = 2;
  helix.arc.axis_y = 0;
  helix.further[1] = -77;
  helix.further[5] = 3;
  const ArcChordCommand arc = make_helix(helix, 50'000);
  EXPECT_EQ(arc.mask, 0b100111);
  const auto length = static_cast<double>(arc.path_ticks);
  EXPECT_EQ(arc.increment[1], std::llround(-77 * 0x1p40 / length));
  EXPECT_EQ(arc.increment[5], std::llround(3 * 0x1p40 / length));
  EXPECT_EQ(arc.increment[3], 0);
  // At most one pulse per path tick: more pulses of a further axis need more ticks.
  const std::uint64_t least = least_chord_ticks(helix);
  helix.further[1] = static_cast<std::int64_t>(8 * least - 100);
  EXPECT_GE(least_chord_ticks(helix), 8 * least - 100);
  EXPECT_THAT(refusal_of(helix, 7 * least), HasSubstr("too few"));
}

// The sweep distinguishes a short way from a full turn. A larger contradiction to the end point than rounding explains
// is refused.
TEST(ArcChord, SweepAndPoints) {
  HelixGeometry helix = circle_of(1000);
  const std::uint64_t one = make_helix(helix, 1 << 20).path_ticks;
  helix.arc.turns = 1;
  EXPECT_NEAR(static_cast<double>(make_helix(helix, 2 << 20).path_ticks), 2 * static_cast<double>(one), 1);
  helix.arc.turns = 0;
  helix.arc.sweep = 0.0001;
  EXPECT_THAT(refusal_of(helix), HasSubstr("not ahead"));
  helix.arc.end_y = -1;
  EXPECT_THAT(refusal_of(helix), HasSubstr("not ahead")) << "rounding has put it behind the start";
  helix.arc.sweep = 2 * kPi;
  EXPECT_EQ(refusal_of(helix), "");
  helix.arc.sweep = 1;
  EXPECT_THAT(refusal_of(helix), HasSubstr("a sweep of 1.000000 radians, but -0.001000 between the points"));
}

TEST(ArcChord, RefusesWhatContradictsItself) {
  const auto with = [](const std::function<void(HelixGeometry&)>& change) {
    HelixGeometry helix = circle_of(1000);
    change(helix);
    return refusal_of(helix);
  };
  EXPECT_EQ(with([](HelixGeometry&) {}), "");
  EXPECT_EQ(with([](HelixGeometry& h) { h.arc.end_x = 400; }), "") << "a third more";
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.end_x = 1000; }), HasSubstr("2000.0000 at the end"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.centre_x = 0; }), HasSubstr("radius of 0 pulses"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.end_x = -1000; }), HasSubstr("radius of 0 pulses"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.centre_y = std::numeric_limits<std::int64_t>::min(); }),
              HasSubstr("farther than 2^31"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.axis_y = 0; }), HasSubstr("span no plane"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.axis_x = 8; }), HasSubstr("span no plane"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.axis_y = 8; }), HasSubstr("span no plane"));
  for (const unsigned axis : {0U, 1U})
    EXPECT_THAT(with([axis](HelixGeometry& h) { h.further[axis] = 1; }), HasSubstr("beside it"));
  constexpr std::int64_t kFar = 2'147'483'647LL * kCentreUnitsPerPulse;
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.centre_x = kFar + 1; }), HasSubstr("farther than 2^31"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.centre_y = kFar + 1; }), HasSubstr("farther than 2^31"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.centre_x = h.arc.centre_y = kFar; }), HasSubstr("radius of 3.037e+09"));
  EXPECT_THAT(with([](HelixGeometry& h) { h.arc.turns = kMaxChordTurns; }), HasSubstr("turns"));
  for (const double sweep : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(with([&](HelixGeometry& h) { h.arc.sweep = sweep; }), HasSubstr("sweep"));
  }
  EXPECT_THAT(with([](HelixGeometry& h) { h.further[3] = std::int64_t{1} << 38; }), HasSubstr("further axis"));
}

// These arcs need more than 2^37 path ticks at any density.
TEST(ArcChord, FurtherAxesMayAskForTooMuch) {
  HelixGeometry helix = circle_of(1000);
  helix.further[2] = std::int64_t{1} << 32;
  EXPECT_GE(least_chord_ticks(helix), std::uint64_t{1} << 32);
  helix.arc.turns = 90'000;
  helix.arc.centre_x = -2'000'000'000LL * kCentreUnitsPerPulse;
  try {
    least_chord_ticks(helix);
    FAIL() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("too long, or too short for what its ends or further axes ask for"));
  }
}

// A hash of the fields of many arcs, computed on x86-64. Other hosts must get the same value.
TEST(ArcChord, GivesTheSameFieldsOnEveryHost) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  const auto add = [&](std::int64_t value) {
    hash = (hash ^ static_cast<std::uint64_t>(value)) * 0x100000001B3U;
    hash ^= hash >> 29U;
  };
  int refused = 0;
  for (int i = 1; i <= 3000; ++i) {
    HelixGeometry helix;
    const std::int64_t radius = 1 + std::int64_t{i} * i * i % 1'000'000;
    const SineCosine start = sine_cosine(i * 0.7);
    helix.arc.sweep = 0.1 + i % 62 * 0.1;
    helix.arc.clockwise = i % 2 == 0;
    const SineCosine end = sine_cosine(i * 0.7 + (helix.arc.clockwise ? -helix.arc.sweep : helix.arc.sweep));
    const auto r = static_cast<double>(radius);
    helix.arc.centre_x = -std::llround(r * start.cosine) * 256 + i % 256;
    helix.arc.centre_y = -std::llround(r * start.sine) * 256;
    helix.arc.end_x = static_cast<std::int32_t>(std::llround(r * end.cosine) - std::llround(r * start.cosine));
    helix.arc.end_y = static_cast<std::int32_t>(std::llround(r * end.sine) - std::llround(r * start.sine));
    helix.arc.turns = static_cast<std::uint32_t>(i % 5);
    helix.further[2] = i % 7;
    try {
      const ArcChordCommand arc = make_helix(helix, std::uint64_t{1} << (28 + i % 9));
      for (const std::int64_t value : {arc.x, arc.y, arc.first_x, arc.first_y, arc.closing_x, arc.closing_y,
                                       static_cast<std::int64_t>(arc.path_ticks), arc.increment[2]}) {
        add(value);
      }
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_EQ(hash, 1822012330705026350U);
  EXPECT_LT(refused, 100);
}

}  // namespace
}  // namespace trammel::driver
