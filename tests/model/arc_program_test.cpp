// Whole programs with arcs in chords on the model of the card: each arc and helix ends at its commanded end, with any
// paths before and after it, at any tick rate and in any plane.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "chord_arc.hpp"
#include "core_bench.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
using model::ArcPoints;

class ArcProgram {
 public:
  static constexpr unsigned kAxes = 4;

  explicit ArcProgram(std::uint64_t seed) : random_(seed), bench_(config()) {
    for (unsigned n = 0; n < kAxes; ++n) {
      EXPECT_TRUE(bench_.write(reg::step_length(n), 1));
      for (const auto address : {reg::step_space(n), reg::dir_setup(n), reg::dir_hold(n)})
        EXPECT_TRUE(bench_.write(address, 0));
    }
  }

  // Sends a few paths, the feed pieces that cover them, and the end; then compares the positions with the commanded
  // ones.
  void run() {
    std::uint64_t ticks = 0;
    for (auto paths = any(1, 4); paths != 0; --paths) {
      const auto kind = any(0, 5);
      ticks += kind == 0 ? line() : kind == 1 ? circle() : arc();
    }
    if (ticks == 0) return;  // the only path was an arc with an end too close to its centre
    // At most one tick per clock; the densest arcs make a step every 16 ticks.
    const double pace = any(0, 1) == 0 ? 1.0 : static_cast<double>(any(1000, 5000)) / 1000;
    const std::uint64_t rate = pace > 1 ? static_cast<std::uint64_t>(0x1p64 / pace) : ~std::uint64_t{0};
    ASSERT_TRUE(bench_.feed(ticks, rate)) << "refusal " << bench_.read(reg::kRefusal) << ", fault "
                                          << bench_.read(reg::kFault) << ", " << ticks << " ticks";
    ASSERT_TRUE(bench_.end());
    ASSERT_TRUE(bench_.finish(static_cast<std::uint64_t>(static_cast<double>(ticks) * pace) + 20'000));
    ASSERT_EQ(bench_.core.outputs().fault, 0U);
    for (unsigned n = 0; n < kAxes; ++n)
      ASSERT_EQ(static_cast<std::int32_t>(bench_.core.position(n)), position_[n]) << "axis " << n;
  }

  unsigned arcs = 0;
  unsigned helices = 0;

 private:
  static model::CardConfig config() {
    model::CardConfig config;
    config.axes = kAxes;
    config.engines |= card_map::engines::kArcGenerator;
    return config;
  }

  std::int64_t any(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }

  std::uint64_t line() {
    const std::int64_t ticks = any(1000, 3000);
    std::vector<std::int64_t> increments;
    for (unsigned n = 0; n < kAxes; ++n) increments.push_back(increment(n, any(-50, 50), ticks));
    EXPECT_TRUE(bench_.line(static_cast<std::uint64_t>(ticks), increments));
    return static_cast<std::uint64_t>(ticks);
  }

  // Increment of `pulses` in `ticks`; also adds the pulses to the expected position.
  std::int64_t increment(unsigned axis, std::int64_t pulses, std::int64_t ticks) {
    position_[axis] += static_cast<std::int32_t>(pulses);
    return std::llround(std::ldexp(static_cast<long double>(pulses) / static_cast<long double>(ticks), 40));
  }

  // A full circle on the accumulator.
  std::uint64_t circle() {
    const std::int64_t radius = any(1, 6);
    const auto ticks = static_cast<std::uint64_t>(8 * radius * any(10, 30));
    EXPECT_TRUE(bench_.circle(ticks, radius, any(0, 1) == 0));
    return ticks;
  }

  std::uint64_t arc() {
    ArcPoints arc;
    const long double radius = std::exp(std::log(5000.0L) * static_cast<long double>(any(0, 1000)) / 1000);
    const long double start = static_cast<long double>(any(0, 6283)) / 1000;
    const long double sweep = std::min(static_cast<long double>(any(100, 6283)) / 1000, 400 / radius);
    arc.clockwise = any(0, 1) == 0;
    arc.turns = radius < 20 && any(0, 4) == 0 ? 2 : 0;
    arc.ticks_a_pulse = static_cast<unsigned>(any(16, 40));
    const long double end = arc.clockwise ? start - sweep : start + sweep;
    for (unsigned i = 0; i < 2; ++i) {
      arc.centre[i] = any(-128, 128);
      const long double centre = static_cast<long double>(arc.centre[i]) / 256;
      arc.start[i] = std::llround(centre + radius * (i == 0 ? std::cos(start) : std::sin(start)));
      arc.end[i] = std::llround(centre + radius * (i == 0 ? std::cos(end) : std::sin(end)));
    }
    if (arc.radii().start < 0.5L || arc.radii().end < 0.5L) return 0;
    return send(arc);
  }

  std::uint64_t send(ArcPoints arc) {
    arc.axis_x = static_cast<std::uint8_t>(any(0, kAxes - 1));
    arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + any(1, kAxes - 1)) % kAxes);
    // At most 1/16 pulse per path tick.
    const std::int64_t most = static_cast<std::int64_t>(prepare_command(arc).path_ticks) / 16;
    std::array<std::int64_t, card_map::kMaxAxes> further{};
    for (unsigned n = 0; n < kAxes; ++n) {
      if (n != arc.axis_x && n != arc.axis_y && any(0, 1) == 0) further[n] = any(-most, most);
      position_[n] += static_cast<std::int32_t>(further[n]);
    }
    driver::ArcChordCommand command = prepare_command(arc, further);
    const auto path_ticks = static_cast<std::int64_t>(command.path_ticks);
    command.ticks = static_cast<std::uint64_t>(any(0, 1) == 0 ? path_ticks : path_ticks + any(0, path_ticks));
    command.prescale = driver::rounded_share(command.path_ticks, command.ticks);
    position_[arc.axis_x] += static_cast<std::int32_t>(arc.end[0] - arc.start[0]);
    position_[arc.axis_y] += static_cast<std::int32_t>(arc.end[1] - arc.start[1]);
    std::vector<std::uint32_t> words;
    driver::encode(command, bench_.number++, words);
    EXPECT_TRUE(bench_.send(words));
    ++arcs;
    helices += further == std::array<std::int64_t, card_map::kMaxAxes>{} ? 0U : 1U;
    return command.ticks;
  }

  std::mt19937_64 random_;
  CoreBench bench_;
  std::array<std::int32_t, kAxes> position_{};
};

TEST(ArcProgram, EveryArcAndHelixEndsWhereItShould) {
  ArcProgram program(20261122);
  // The long run makes more than 10,000 helices.
  const int programs = std::getenv("TRAMMEL_LONG") != nullptr ? 15'000 : 300;
  for (int i = 0; i < programs && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(i);
    program.run();
  }
  EXPECT_GT(program.arcs, static_cast<unsigned>(programs));
  EXPECT_GT(program.helices, static_cast<unsigned>(programs) * 2 / 3);
}

}  // namespace
}  // namespace trammel::testing
