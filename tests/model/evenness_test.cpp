// Times of steps: those of the golden card at a constant tick rate, against the times at which the commanded motion
// crosses half pulses. These are computed from the fields of the commands alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <random>

#include "chord_arc.hpp"
#include "core_bench.hpp"
#include "trammel/driver/increment.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
using model::ArcPoints;

constexpr unsigned kAxes = 4;
constexpr unsigned kMarker = 3;  // the axis that steps with every tick and so shows its time
constexpr std::uint64_t kTickClocks = 20;

class EvennessBench : public CoreBench {
 public:
  EvennessBench() : CoreBench(config()) {
    for (unsigned n = 0; n < kAxes; ++n) {
      EXPECT_TRUE(write(reg::step_length(n), 1));
      for (const auto address : {reg::step_space(n), reg::dir_setup(n), reg::dir_hold(n)})
        EXPECT_TRUE(write(address, 0));
    }
  }

  // Plays the path that was sent, at one tick per kTickClocks; returns the clock of its first marked tick.
  std::uint64_t play(std::uint64_t ticks) {
    steps.path.clear();
    EXPECT_TRUE(feed(ticks, static_cast<std::uint64_t>(std::ldexp(1.0L, 64) / kTickClocks)));
    EXPECT_TRUE(end());
    EXPECT_TRUE(finish(ticks * kTickClocks + 20'000));
    for (const auto& [command, tick, axis, direction, cycle] : steps.path) {
      if (axis == kMarker) return cycle;
    }
    ADD_FAILURE() << "no tick";
    return 0;
  }

 private:
  static model::CardConfig config() {
    model::CardConfig config;
    config.axes = kAxes;
    config.engines |= card_map::engines::kArcGenerator;
    return config;
  }
};

struct Lateness {
  double least = INFINITY;
  double most = -INFINITY;
  void look(double clocks) {
    least = std::min(least, clocks);
    most = std::max(most, clocks);
  }
};

// The j-th step of p pulses in N ticks is due after (j - 1/2) N / p ticks. Returns the largest relative deviation of an
// interval from N / p.
double judge_line(EvennessBench& bench, std::uint64_t ticks, const std::array<std::int64_t, 3>& pulses,
                  Lateness& lateness) {
  std::vector<std::int64_t> increments;
  for (const std::int64_t p : pulses)
    increments.push_back(std::llround(std::ldexp(static_cast<long double>(p) / static_cast<long double>(ticks), 40)));
  increments.push_back(kOnePulse);
  EXPECT_TRUE(bench.line(ticks, increments));
  const std::uint64_t first = bench.play(ticks);
  std::array<double, 3> made{};
  std::array<double, 3> last{};
  double uneven = 0;
  for (const auto& [command, tick, axis, direction, cycle] : bench.steps.path) {
    if (axis == kMarker) continue;
    const double pace = static_cast<double>(ticks * kTickClocks) / static_cast<double>(std::abs(pulses[axis]));
    const auto at = static_cast<double>(cycle - first + kTickClocks);
    made[axis] += 1;
    lateness.look(at - (made[axis] - 0.5) * pace);
    if (made[axis] > 1) uneven = std::max(uneven, std::abs(at - last[axis] - pace) / pace);
    last[axis] = at;
  }
  for (unsigned n = 0; n < 3; ++n) EXPECT_EQ(made[n], std::abs(static_cast<double>(pulses[n])));
  return uneven;
}

TEST(Evenness, StepsOfALineComeWithinATickAndAClock) {
  EvennessBench bench;
  std::mt19937_64 random(1);
  Lateness lateness;
  double uneven = 0;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t ticks = 200 + random() % 3000;
    // Every other line has at least 128 ticks per pulse.
    const std::uint64_t most = ticks / (i % 2 == 0 ? 128 : 2);
    std::array<std::int64_t, 3> pulses{};
    for (std::int64_t& p : pulses)
      p = static_cast<std::int64_t>(random() % (2 * most + 1)) - static_cast<std::int64_t>(most);
    const double share = judge_line(bench, ticks, pulses, lateness);
    if (i % 2 == 0) uneven = std::max(uneven, share);
  }
  EXPECT_GE(lateness.least, -1);
  EXPECT_LE(lateness.most, kTickClocks + 1);
  EXPECT_GT(lateness.most, kTickClocks / 2) << "the judge sees ticks";
  EXPECT_LE(uneven, 1.0 / 64);
  EXPECT_GT(uneven, 1.0 / 256) << "the judge sees intervals";
  std::cout << "steps of lines " << lateness.least << " to " << lateness.most << " clocks late at " << kTickClocks
            << " clocks a tick; intervals at 128 ticks a pulse and more off by " << uneven << " at most\n";
}

// Position of an axis after a number of path ticks, not necessarily whole, from the fields of an arc: presets for the
// first tick, then increments that change at odd half chords for Y and at even ones for X.
class Sum {
 public:
  explicit Sum(const model::ChordFields& fields) : state_(fields.state) {
    at_[0] = at_[1] = {0};
    for (unsigned i = 0; i < 2; ++i) at_[i].push_back(std::ldexp(static_cast<double>(fields.first[i]), -40));
    std::array<double, 2> by{};
    by[1] = next(1);
    by[0] = next(0);
    const std::uint64_t half = std::uint64_t{1} << (state_.m - 1);
    for (std::uint64_t t = 1; t < fields.path_ticks; ++t) {
      if (t % half == 0) {
        const unsigned axis = t / half % 2;
        by[axis] = next(axis);
      }
      for (unsigned i = 0; i < 2; ++i) at_[i].push_back(at_[i].back() + by[i]);
    }
  }

  double at(unsigned axis, double ticks) const {
    const double within = std::clamp(ticks, 0.0, static_cast<double>(at_[axis].size() - 1));
    const auto whole = std::min(static_cast<std::size_t>(within), at_[axis].size() - 2);
    const double part = within - static_cast<double>(whole);
    return at_[axis][whole] * (1 - part) + at_[axis][whole + 1] * part;
  }

 private:
  double next(unsigned axis) {
    const std::int64_t from = axis == 0 ? state_.y : state_.x;
    std::int64_t change = (from + (std::int64_t{1} << state_.k >> 1)) >> state_.k;
    if ((axis == 0) != state_.clockwise) change = -change;
    (axis == 0 ? state_.x : state_.y) += change;
    return std::ldexp(static_cast<double>(change + (axis == 0 ? state_.closing_x : state_.closing_y)), -40);
  }

  model::ChordRotation::State state_;
  std::array<std::vector<double>, 2> at_;
};

// The latest path tick before `ticks` at which the sum crossed the level in this direction; none if it is more than
// three path ticks back.
std::optional<double> crossing(const Sum& sum, unsigned axis, double level, int direction, double ticks) {
  for (double end = ticks; end > ticks - 3;) {
    const double begin = std::ceil(end) - 1;
    const double before = (sum.at(axis, begin) - level) * direction;
    const double after = (sum.at(axis, end) - level) * direction;
    if (before < 0 && after >= 0) return begin + (end - begin) * before / (before - after);
    end = begin;
  }
  return std::nullopt;
}

// Includes feed ticks that are not path ticks: the prescaler makes path tick i at feed tick (i - 1/2) / ratio.
void judge_arc(EvennessBench& bench, const ArcPoints& points, double ratio, Lateness& lateness) {
  driver::ArcChordCommand arc = model::prepare_command(points);
  arc.increment[kMarker] = kOnePulse;  // a step per path tick
  arc.mask |= 1U << kMarker;
  arc.ticks = static_cast<std::uint64_t>(static_cast<double>(arc.path_ticks) / ratio);
  arc.prescale = driver::rounded_share(arc.path_ticks, arc.ticks);
  const double share = std::ldexp(static_cast<double>(arc.prescale), -40);
  const Sum sum(model::fields_of(arc));
  std::vector<std::uint32_t> words;
  driver::encode(arc, bench.number++, words);
  ASSERT_TRUE(bench.send(words));
  const std::uint64_t first_path_tick = bench.play(arc.ticks);
  const double first = static_cast<double>(first_path_tick) - (std::ceil(0.5 / share) - 1) * kTickClocks;
  std::array<std::int64_t, 2> made{};
  for (const auto& [command, tick, axis, direction, cycle] : bench.steps.path) {
    if (axis == kMarker) continue;
    const double level = static_cast<double>(made[axis]) + 0.5 * direction;
    made[axis] += direction;
    const double at = static_cast<double>(cycle) - first + kTickClocks;
    // The prescaler rounds, so a path tick may come up to half a path tick early.
    const auto due = crossing(sum, axis, level, direction, at / kTickClocks * share + 0.5 + 1e-6);
    ASSERT_TRUE(due) << "axis " << axis << " pulse " << made[axis];
    lateness.look((at - *due / share * kTickClocks) / (kTickClocks * (1 + 1 / share) + 1));
  }
  EXPECT_EQ(made[0], points.end[0] - points.start[0]);
  EXPECT_EQ(made[1], points.end[1] - points.start[1]);
}

TEST(Evenness, StepsOfAnArcComeWithinAFeedTickAPathTickAndAClock) {
  EvennessBench bench;
  std::mt19937_64 random(2);
  Lateness lateness;
  for (int i = 0; i < 80; ++i) {
    ArcPoints arc;
    const long double radius = std::exp(std::log(300.0L) * static_cast<long double>(random() % 1000) / 1000);
    const long double from = static_cast<long double>(random() % 6283) / 1000;
    const long double to = from + static_cast<long double>(random() % 6000) / 1000 + 0.1L;
    arc.clockwise = random() % 2 == 0;
    for (unsigned n = 0; n < 2; ++n) {
      const auto part = [&](long double angle) { return n == 0 ? std::cos(angle) : std::sin(angle); };
      arc.start[n] = std::llround(radius * part(arc.clockwise ? to : from));
      arc.end[n] = std::llround(radius * part(arc.clockwise ? from : to));
    }
    if (arc.radii().start < 0.5L || arc.radii().end < 0.5L) continue;
    judge_arc(bench, arc, i % 3 == 0 ? 1 : 0.2 + 0.8 * static_cast<double>(random() % 1000) / 1000, lateness);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(lateness.least, -1);
  EXPECT_LE(lateness.most, 1);
  EXPECT_GT(lateness.most, 0.3) << "the judge sees ticks";
  std::cout << "steps of arcs " << lateness.least << " to " << lateness.most
            << " of a feed tick, a path tick and a clock late\n";
}

}  // namespace
}  // namespace trammel::testing
