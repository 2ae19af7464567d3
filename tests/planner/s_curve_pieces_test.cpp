// S-curves as pieces of the card: from the program to the ticks of the feed generator, by the rules of its page.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "plan.hpp"
#include "trammel/driver/feed_time.hpp"

namespace trammel::planner {
namespace {

constexpr double kUpdate = 32;

machine::Machine machine_with_jerk(double jerk) {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) axis.max_jerk = jerk;
  return machine;
}

std::vector<driver::FeedCommand> pieces_of(const std::string& text, const machine::Machine& machine) {
  const Plan plan = plan_text(text, machine, {kClock, 4, true});
  std::vector<driver::FeedCommand> pieces;
  for (const Planned& block : plan.blocks) {
    for (const driver::FeedCommand& piece : commands<driver::FeedCommand>(block)) pieces.push_back(piece);
  }
  return pieces;
}

// The result of a piece in the feed generator.
struct Made {
  double first = 0;  // first rate, ticks per clock
  double last = 0;
  double gain = 0;  // gain of the last update
  double clocks = 0;
};

Made make(const driver::FeedCommand& piece) {
  double rate = static_cast<double>(piece.rate) * 0x1p-64;
  double gain = static_cast<double>(piece.acceleration) * 0x1p-64;
  const double jerk = static_cast<double>(piece.jerk) * 0x1p-64;
  const double floor = piece.floor * 0x1p-32;
  Made made;
  made.first = rate;
  for (double left = static_cast<double>(piece.ticks);;) {
    made.last = made.clocks == 0 ? rate : std::max(rate, floor);
    const double clocks = std::min(kUpdate, left / made.last);
    made.clocks += clocks;
    left -= clocks * made.last;
    if (left <= 1e-9) return made;
    made.gain = gain;
    rate += gain;
    gain += jerk;
  }
}

TEST(SCurvePieces, AMoveHasSevenOfThemAndItsTime) {
  // The speed is 100 mm/s after 0.12 s and 6 mm.
  const machine::Machine machine = machine_with_jerk(50'000);
  const std::vector<driver::FeedCommand> pieces = pieces_of("G1 X100 F6000", machine);
  ASSERT_EQ(pieces.size(), 7U);
  double clocks = 0;
  for (const driver::FeedCommand& piece : pieces) clocks += make(piece).clocks;
  const double seconds = 100.0 / 100 + 100.0 / 1000 + 1000.0 / 50'000;
  // The last tick runs at the floor, so it is 1.5 ms earlier than on the curve.
  EXPECT_NEAR(clocks / kClock, seconds - 0.0015, 1e-4);
  const Plan plan = plan_text("G1 X100 F6000", machine, {kClock, 4, true});
  EXPECT_NEAR(plan.blocks[0].planned.seconds, clocks / kClock, 1e-5);
}

// Distance over time of a single move, by the formulas of its seven phases: jerk for r seconds, no jerk for c seconds,
// -jerk for r seconds, constant speed, and the same in reverse.
struct ClosedForm {
  double length, jerk, r, c, cruise;

  ClosedForm(double of, double speed, double acceleration, double with_jerk) : length(of), jerk(with_jerk) {
    r = std::min({acceleration / jerk, std::sqrt(speed / jerk), std::cbrt(length / (2 * jerk))});
    // v (2 r + c) = length, v = jerk r (r + c), if that is below `speed`.
    const double most = std::max(0.0, speed / (jerk * r) - r);
    const double free = (std::sqrt(r * r + 4 * length / (jerk * r)) - 3 * r) / 2;
    c = r < acceleration / jerk ? 0 : std::clamp(free, 0.0, most);
    cruise = std::max(0.0, length / top() - 2 * r - c);
  }
  double top() const { return jerk * r * (r + c); }
  double seconds() const { return 4 * r + 2 * c + cruise; }
  double at(double t) const { return 2 * t > seconds() ? length - rise(seconds() - t) : rise(t); }

 private:
  double rise(double t) const {
    if (t <= r) return jerk * t * t * t / 6;
    if (t <= r + c) return rise(r) + jerk * r * r / 2 * (t - r) + jerk * r * (t - r) * (t - r) / 2;
    const double ramp = 2 * r + c;
    if (t > ramp) return top() * ramp / 2 + top() * (t - ramp);
    const double left = ramp - t;
    return top() * ramp / 2 - top() * left + jerk * left * left * left / 6;
  }
};

// Ticks come at the times of the closed form, within 0.0125 % of the total time, except the last tick (1/128 of a pulse
// here). It takes 1 / floor instead of the 3 / floor of the closed form.
TEST(SCurvePieces, LoneMovesAreWhereTheClosedFormIs) {
  const struct {
    double speed, acceleration, jerk;
  } machines[] = {{100, 500, 30'000}, {150, 1'000, 50'000}, {300, 3'000, 100'000}};
  for (const auto& m : machines) {
    machine::Machine machine = machine_with_jerk(m.jerk);
    machine.axes[0].max_velocity = m.speed;
    machine.axes[0].max_acceleration = m.acceleration;
    for (const double length : {0.1, 0.3, 1.0, 3.0, 10.0, 100.0}) {
      const ClosedForm form(length, m.speed, m.acceleration, m.jerk);
      const std::vector<driver::FeedCommand> pieces =
          pieces_of(fmt::format("G1 X{} F{}", length, m.speed * 60), machine);
      std::uint64_t all = 0;
      for (const driver::FeedCommand& piece : pieces) all += piece.ticks;
      double clocks = 0;
      double worst = 0;
      std::uint64_t ticks = 0;
      for (driver::FeedCommand piece : pieces) {
        const std::uint64_t of_piece = piece.ticks;
        const std::uint64_t every = std::max<std::uint64_t>(1, of_piece / 12);
        for (std::uint64_t k = every; k <= of_piece && ticks + k + 2 <= all; k += every) {
          piece.ticks = k;
          const double seconds = (clocks + make(piece).clocks) / kClock;
          const double right = static_cast<double>(ticks + k) / static_cast<double>(all) * length;
          // The error as a time, by the speed at this place.
          const double here = form.at(seconds);
          const double speed = (form.at(seconds + 1e-6) - form.at(seconds - 1e-6)) / 2e-6;
          worst = std::max(worst, std::abs(here - right) / speed);
        }
        piece.ticks = of_piece;
        clocks += make(piece).clocks;
        ticks += of_piece;
      }
      // The last tick takes 1 / floor; in the closed form it would take 3 / floor.
      const double floor = std::cbrt(4.5 * m.jerk * static_cast<double>(all) / length);
      EXPECT_LT(worst, 1.25e-4 * form.seconds()) << length;
      EXPECT_NEAR(clocks / kClock, form.seconds() - 2 / floor, 2e-5) << length;
    }
  }
}

// The planned time is that of the closed form less 2 / (4.5 j D)^(1/3), with D ticks per mm: before rest a tick would
// take 3 / floor, but the last tick takes 1 / floor. The first tick takes its whole time.
TEST(SCurvePieces, LoneMovesTakeTheClosedFormLessTwoThirdsOfTheLastTick) {
  double worst = 0;
  double largest_term = 0;
  for (const double acceleration : {300.0, 1'000.0, 3'000.0}) {
    for (const double rise : {0.1, 0.03, 0.01, 0.002}) {  // s
      const double jerk = acceleration / rise;
      const double speed = 100;
      machine::Machine machine = machine_with_jerk(jerk);
      machine.axes[0].max_velocity = speed;
      machine.axes[0].max_acceleration = acceleration;
      for (const double length : {0.05, 0.1, 0.3, 1.0, 3.0, 10.0, 50.0, 300.0}) {
        const std::string text = fmt::format("G1 X{:.6f} F{:.6f}", length, speed * 60);
        const Plan plan = plan_text(text, machine, kCard);
        ASSERT_FALSE(plan.error);
        std::uint64_t ticks = 0;
        for (const driver::FeedCommand& piece : commands<driver::FeedCommand>(plan.blocks[0])) ticks += piece.ticks;
        const double floor = std::cbrt(4.5 * jerk * static_cast<double>(ticks) / length);
        const double form = ClosedForm(length, speed, acceleration, jerk).seconds();
        const double off = std::abs(plan.blocks[0].planned.seconds - (form - 2 / floor)) / form;
        EXPECT_LE(off, 0.001) << text << " a " << acceleration << " j " << jerk;
        worst = std::max(worst, off);
        largest_term = std::max(largest_term, 2 / floor / form);
      }
    }
  }
  EXPECT_GT(largest_term, 0.02);
  RecordProperty("worst", fmt::format("{:.6f}", worst));
  RecordProperty("largest_term", fmt::format("{:.4f}", largest_term));
}

TEST(SCurvePieces, OneGoesOnWhereTheOtherEnded) {
  const std::string program = "G1 X100 F6000\nX60\nY0.3\nY20\nX60.05 Y20.05\nX90 Y50\nG1 X0 Y0 F600\nM2\n";
  const std::vector<driver::FeedCommand> pieces = pieces_of(program, machine_with_jerk(50'000));
  ASSERT_GT(pieces.size(), 30U);
  Made before;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Made made = make(pieces[i]);
    const bool rests = i == 0 || pieces[i - 1].stop_distance == 0;
    const double gain = std::abs(static_cast<double>(pieces[i].acceleration)) * 0x1p-64;
    const double allowed = std::abs(before.gain) + gain + 0.001 * std::max(made.first, before.last);
    if (!rests) {
      EXPECT_LE(std::abs(made.first - before.last), allowed) << i;
    }
    before = made;
  }
}

TEST(SCurvePieces, AreMadeWhereEveryAxisHasAJerk) {
  machine::Machine machine = machine_with_jerk(50'000);
  EXPECT_EQ(profile_of(machine, {}), SpeedProfile::kSCurve);
  EXPECT_EQ(profile_of(machine, {false, SpeedProfile::kTrapezoid}), SpeedProfile::kTrapezoid);
  machine.axes.back().max_jerk = 0;
  EXPECT_EQ(profile_of(machine, {}), SpeedProfile::kTrapezoid);
  EXPECT_EQ(profile_of(machine, {false, SpeedProfile::kSCurve}), SpeedProfile::kSCurve);
  EXPECT_EQ(pieces_of("G1 X100 F6000", machine).size(), 3U);
}

// The stream refuses pieces that would reverse the feed. The planner makes none, at fast and slow clocks, with short
// moves among long ones.
TEST(SCurvePieces, NoneReversesTheFeed) {
  std::mt19937 random(5);
  const auto below = [&random](double most) { return std::uniform_real_distribution<>(0, most)(random); };
  for (int round = 0; round < 60; ++round) {
    const machine::Machine machine = machine_with_jerk(std::pow(10, 3.5 + below(3)));
    CardLimits card;
    card.clock_hz = static_cast<std::uint32_t>(std::pow(10, 5.2 + below(3)));
    std::string text = "F" + std::to_string(300 + below(8000)) + "\n";
    for (int i = 0; i < 60; ++i) {
      text += "G1 X" + std::to_string(below(1) < 0.5 ? below(60) : i * 0.05) + " Y" + std::to_string(below(0.2) * i);
      text += i % 9 == 0 ? "\nG4 P0\n" : "\n";
    }
    const Plan plan = plan_text(text, machine, card);
    ASSERT_FALSE(plan.error);
    for (const Planned& block : plan.blocks) {
      for (const driver::FeedCommand& piece : commands<driver::FeedCommand>(block)) {
        ASSERT_FALSE(driver::ticks_to_reversal(piece))
            << *driver::ticks_to_reversal(piece) << " of " << piece.ticks << ", clock " << card.clock_hz << ", line "
            << block->line << ", round " << round;
      }
    }
  }
}

}  // namespace
}  // namespace trammel::planner
