// The golden model of the arc generator is compared with the circle itself (ends, distances, speed, symmetry); the
// clocked block is compared with the rule for the increments.
#include "trammel/model/arc_generator.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "chord_arc.hpp"
#include "trammel/model/pulse_generator.hpp"

namespace trammel::model {
namespace {

// How far the path leaves the ring between the radii of its start and its end, in pulses; -1 when it misses its end.
long double outside(const ArcPoints& arc, const ChordFields& fields) {
  const Radii radii = arc.radii();
  const long double low = std::min(radii.start, radii.end);
  const long double high = std::max(radii.start, radii.end);
  // Squares in (1/256 pulse)^2; 64 bits hold them up to radii of 2^22.
  const auto low_square = static_cast<std::int64_t>(low * low * 65536);
  const auto high_square = static_cast<std::int64_t>(high * high * 65536);
  long double worst = 0;
  ChordPath path(fields);
  const auto look = [&] {
    const std::int64_t x = (arc.start[0] + path.position()[0]) * 256 - arc.centre[0];
    const std::int64_t y = (arc.start[1] + path.position()[1]) * 256 - arc.centre[1];
    const std::int64_t square = x * x + y * y;
    if (square >= low_square && square <= high_square) return;
    const long double r = std::sqrt(static_cast<long double>(square)) / 256;
    worst = std::max(worst, std::max(r - high, low - r));
  };
  look();
  path.finish(look);
  const bool misses =
      arc.start[0] + path.position()[0] != arc.end[0] || arc.start[1] + path.position()[1] != arc.end[1];
  return misses ? -1 : worst;
}

long double outside(const ArcPoints& arc) { return outside(arc, prepare_chords(arc)); }

bool long_run() { return std::getenv("TRAMMEL_LONG") != nullptr; }

class RandomArcs {
 public:
  explicit RandomArcs(std::uint64_t seed) : random_(seed) {}

  // Radius from 1 to 10^6, sweep up to one turn, sometimes several turns; most arcs are at most `longest` pulses long.
  ArcPoints next(long double longest) {
    ArcPoints arc;
    do {
      const long double radius = std::exp(between(0, std::log(1e6L)));
      const long double start = between(0, kTurn);
      long double sweep = between(0.01L, kTurn);
      if (chance(500))
        arc.turns = static_cast<unsigned>(random_() % 3);
      else
        sweep = std::min(sweep, between(0.2L, 1) * longest / radius);
      arc.clockwise = chance(2);
      arc.ticks_a_pulse = static_cast<unsigned>(8 << random_() % 6);
      const long double end_radius = radius + (chance(2) ? between(-1, 1) : 0);
      const long double end = arc.clockwise ? start - sweep : start + sweep;
      for (unsigned i = 0; i < 2; ++i) {
        const auto part = [&](long double angle) { return i == 0 ? std::cos(angle) : std::sin(angle); };
        arc.centre[i] = static_cast<std::int64_t>(random_() % 512) - 256;
        const long double centre = static_cast<long double>(arc.centre[i]) / 256;
        arc.start[i] = std::llround(centre + radius * part(start));
        arc.end[i] = std::llround(centre + end_radius * part(end));
      }
      // On the smallest circles a rounded end may lie almost at the centre, where no arc can end; draw again.
    } while (arc.radii().start < 0.5L || arc.radii().end < 0.5L);
    return arc;
  }

 private:
  long double between(long double a, long double b) {
    return a + (b - a) * std::ldexp(static_cast<long double>(random_()), -64);
  }
  bool chance(unsigned one_in) { return random_() % one_in == 0; }

  std::mt19937_64 random_;
};

TEST(ArcGenerator, RandomArcsEndWhereTheyShould) {
  RandomArcs random(20261122);
  long double worst = 0;
  for (int i = 0; i < (long_run() ? 100'000 : 50'000); ++i) {
    const ArcPoints arc = random.next(long_run() ? 1e9L : 2000);
    const long double distance = outside(arc);
    ASSERT_GE(distance, 0) << "arc " << i << " misses its end: radius " << arc.radii().mean();
    ASSERT_LE(distance, 0.8L) << "arc " << i << ": radius " << arc.radii().mean();
    worst = std::max(worst, distance);
  }
  RecordProperty("outside", std::to_string(worst));
  EXPECT_GT(worst, 0.5L);  // the test can see a deviation
}

// Any plane and up to six further axes. Each further axis must make the pulses of the line's closed form.
TEST(ArcGenerator, RandomHelicesEndWhereTheyShould) {
  RandomArcs random(20261123);
  std::mt19937_64 any(5);
  std::uint64_t moved = 0;
  for (int i = 0; i < 10'000; ++i) {
    ArcPoints arc = random.next(long_run() ? 1e9L : 2000);
    arc.axis_x = static_cast<std::uint8_t>(any() % 8);
    arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + 1 + any() % 7) % 8);
    std::array<std::int64_t, 8> further{};
    const auto most = static_cast<std::uint64_t>(arc.sweep() * arc.radii().mean()) + 10;
    for (unsigned axis = 0; axis < 8; ++axis) {
      if (axis == arc.axis_x || axis == arc.axis_y || any() % 3 == 0) continue;
      further[axis] = static_cast<std::int64_t>(any() % (2 * most)) - static_cast<std::int64_t>(most);
    }
    const driver::ArcChordCommand command = prepare_command(arc, further);
    const long double distance = outside(arc, fields_of(command));
    ASSERT_GE(distance, 0) << "helix " << i << " misses its end: radius " << arc.radii().mean();
    ASSERT_LE(distance, 0.8L) << "helix " << i << ": radius " << arc.radii().mean();
    for (unsigned axis = 0; axis < 8; ++axis) {
      // floor(1/2 + L increment / 2^40), in two parts.
      const std::int64_t increment = command.increment[axis];
      const auto length = static_cast<std::int64_t>(command.path_ticks);
      const std::int64_t high = (increment >> 20) * length;
      const std::int64_t low =
          (increment & 0xFFFFF) * (length & 0xFFFFF) + ((increment & 0xFFFFF) * (length >> 20) << 20);
      const std::int64_t made = (high + (low >> 20) + (std::int64_t{1} << 19)) >> 20;
      ASSERT_EQ(made, further[axis]) << "helix " << i << " axis " << axis;
      moved += further[axis] != 0 ? 1U : 0U;
    }
  }
  EXPECT_GT(moved, 30'000U);
}

// Without the closing increment some arcs must miss their end; otherwise the comparison could not fail.
TEST(ArcGenerator, WithoutClosingAnEndIsMissed) {
  RandomArcs random(7);
  int missed = 0;
  for (int i = 0; i < 1000; ++i) {
    const ArcPoints arc = random.next(500);
    ChordFields fields = prepare_chords(arc);
    fields.first[0] -= fields.state.closing_x;
    fields.first[1] -= fields.state.closing_y;
    fields.state.closing_x = fields.state.closing_y = 0;
    ChordPath path(fields);
    path.finish([] {});
    missed +=
        arc.start[0] + path.position()[0] != arc.end[0] || arc.start[1] + path.position()[1] != arc.end[1] ? 1 : 0;
  }
  EXPECT_GT(missed, 10);
}

// Circles and quarters with both ends exactly on the axes, from radius 1 on.
TEST(ArcGenerator, StartsOnTheAxes) {
  const std::int64_t dirs[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (std::int64_t radius = 1; radius <= 300; ++radius) {
    for (unsigned from = 0; from < 4; ++from) {
      for (unsigned quarters = 1; quarters <= 4; ++quarters) {
        for (const bool clockwise : {false, true}) {
          ArcPoints arc;
          arc.clockwise = clockwise;
          const unsigned to = (from + (clockwise ? 4 - quarters : quarters)) % 4;
          for (unsigned i = 0; i < 2; ++i) {
            arc.start[i] = radius * dirs[from][i];
            arc.end[i] = radius * dirs[to][i];
          }
          const long double distance = outside(arc);
          ASSERT_GE(distance, 0) << radius << " from " << from << " by " << quarters << (clockwise ? " cw" : " ccw");
          ASSERT_LE(distance, 0.8L) << radius;
        }
      }
    }
  }
}

// The mean speed over each whole chord against the planned one, which is the length of the arc per tick.
TEST(ArcGenerator, SpeedOfEachChord) {
  long double worst = 0;
  for (const std::int64_t radius : {17, 18, 31, 50, 63, 64, 65, 100, 500, 1000, 1023, 4000, 100'000, 1'000'000}) {
    ArcPoints arc;
    arc.start = arc.end = {radius, 0};
    arc.ticks_a_pulse = 16;
    const ChordFields fields = prepare_chords(arc);
    const long double planned = kTurn * static_cast<long double>(radius) / static_cast<long double>(fields.path_ticks);
    ChordPath path(fields);
    // Each pass takes both halves of a chord. X has one increment in both halves, Y has one for each half.
    while (path.left() >= std::uint64_t{2} << fields.state.m) {
      std::array<long double, 2> sum{};
      for (int half = 0; half < 2; ++half) {
        for (unsigned i = 0; i < 2; ++i) sum[i] += std::ldexp(static_cast<long double>(path.increment()[i]), -41);
        path.half([] {});
      }
      worst = std::max(worst, std::fabs(std::hypot(sum[0], sum[1]) / planned - 1));
    }
  }
  EXPECT_LE(worst, 0.001L);
  RecordProperty("worst", std::to_string(worst));
}

// A radius of nearly 2^31 pulses: a short arc ends at its commanded end, and no coordinate wraps.
TEST(ArcGenerator, LargestRadius) {
  for (const std::int64_t radius : {std::int64_t{1} << 28, (std::int64_t{1} << 31) - 100}) {
    for (const bool clockwise : {false, true}) {
      ArcPoints arc;
      arc.clockwise = clockwise;
      arc.start = {radius, 0};
      const long double angle = 3000 / static_cast<long double>(radius);
      arc.end = {std::llround(static_cast<long double>(radius) * std::cos(angle)), clockwise ? -3000 : 3000};
      const ChordFields fields = prepare_chords(arc);
      ChordPath path(fields);
      path.finish([] {});
      EXPECT_EQ(path.position()[0], arc.end[0] - radius);
      EXPECT_EQ(path.position()[1], arc.end[1]);
      EXPECT_LE(fields.state.k, 27);
    }
  }
}

// The block and two pulse generators, clock by clock. At the end of an arc the positions must be those of ChordPath.
class Rig {
 public:
  void load(const ChordFields& fields) {
    send(load_target::kChordPlane, fields.state.clockwise ? 0x101 : 0x100, 1);
    send(load_target::kChordShifts, static_cast<std::uint64_t>(fields.state.k | fields.state.m << 8), 1);
    send(load_target::kChordState, static_cast<std::uint64_t>(fields.state.x), 4);
    send(load_target::kChordState, static_cast<std::uint64_t>(fields.state.y), 4);
    for (unsigned n = 0; n < 2; ++n) send(load_target::increment(n), static_cast<std::uint64_t>(fields.first[n]), 3);
    send(load_target::kChordClosing, static_cast<std::uint64_t>(fields.state.closing_x), 3);
    send(load_target::kChordClosing, static_cast<std::uint64_t>(fields.state.closing_y), 3);
  }

  // Starts the arc; returns the clocks until the generator is ready.
  unsigned start() {
    in_.start = true;
    clock(false);
    in_.start = false;
    unsigned clocks = 1;
    for (; !generator_.outputs().ready && clocks < 100; ++clocks) clock(clocks == 3);
    for (int i = 0; i < 4; ++i) clock(false);
    return clocks;
  }

  void tick() {
    in_.tick = true;
    clock(false);
    in_.tick = false;
  }

  void rest() {
    for (int i = 0; i < 6; ++i) clock(false);
  }

  void over() {
    in_.clear = true;
    clock(false);
    in_.clear = false;
  }

  std::array<std::int64_t, 2> position{};

 private:
  void send(unsigned target, std::uint64_t value, unsigned halfwords) {
    for (unsigned i = 0; i < halfwords; ++i) {
      in_.load = {true, static_cast<std::uint16_t>(target), static_cast<std::uint16_t>(value >> (16 * i))};
      clock(false);
    }
    in_.load = {};
  }

  void clock(bool swap) {
    const auto& out = generator_.outputs();
    for (unsigned n = 0; n < 2; ++n) {
      PulseGenerator::Inputs in;
      in.clear = in_.clear;
      in.tick = tick_late_;
      in.swap = swap;
      in.active = true;
      in.chord = (out.swap >> n & 1) != 0;
      in.load_increment = (out.load >> n & 1) != 0 || in_.load.to(load_target::increment(n));
      in.word = (out.load >> n & 1) != 0 ? out.word : in_.load.word;
      axes_[n].clock(in);
      if (axes_[n].outputs().step) position[n] += axes_[n].outputs().dir ? -1 : 1;
    }
    tick_late_ = in_.tick;
    generator_.clock(in_);
  }

  ArcGenerator generator_;
  std::array<PulseGenerator, 2> axes_;
  ArcGenerator::Inputs in_;
  bool tick_late_ = false;
};

TEST(ArcGenerator, ClockedArcsEndWhereTheRuleDoes) {
  RandomArcs random(99);
  Rig rig;
  for (int i = 0; i < 300; ++i) {
    const ArcPoints arc = random.next(300);
    const ChordFields fields = prepare_chords(arc);
    if (fields.path_ticks > 100'000) continue;
    rig.position = arc.start;
    rig.load(fields);
    EXPECT_EQ(rig.start(), fields.state.k < 16 ? 14U : 16U);
    for (std::uint64_t t = 0; t < fields.path_ticks; ++t) rig.tick();
    rig.rest();
    EXPECT_EQ(rig.position, arc.end) << i;
    rig.over();
  }
}

}  // namespace
}  // namespace trammel::model
