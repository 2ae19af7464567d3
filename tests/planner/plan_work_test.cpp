// Planning always ends: its work is counted and compared with its bounds, for random programs on random machines.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "plan.hpp"
#include "random.hpp"
#include "trammel/planner/s_curve_plan.hpp"

namespace trammel::planner {
namespace {

using test::Random;

struct Planning {
  PlanWork work;
  std::size_t blocks = 0;
  std::optional<gcode::Error> error;
};

Planning planning_of(const std::string& program, const machine::Machine& machine) {
  class Ignored final : public driver::CommandSink {
   public:
    void put(const driver::Command& /*command*/) override {}
  };
  gcode::TextLines lines(program, "program");
  gcode::Reader reader(lines, machine);
  BlockBuilder blocks(reader, machine, kCard);
  Planner planner(blocks, machine, kCard);
  Planning planning;
  Ignored sink;
  for (PlannedBlock block; planner.next(sink, block);) ++planning.blocks;
  planning.work = planner.work();
  planning.error = blocks.error();
  return planning;
}

void set_axis(machine::MachineAxis& axis, double velocity, double acceleration, double jerk) {
  axis.max_velocity = velocity;
  axis.max_acceleration = acceleration;
  axis.max_jerk = jerk;
  axis.step_length_ns = axis.step_space_ns = 100;
  axis.direction_setup_ns = axis.direction_hold_ns = 0;
}

machine::Machine equal_axes(double velocity, double acceleration, double jerk) {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) set_axis(axis, velocity, acceleration, jerk);
  return machine;
}

void expect_within_bounds(const PlanWork& work) {
  EXPECT_LE(work.windows, SCurvePlan::kMaxWindows * work.spans + work.runs);
  EXPECT_LE(work.ramps, SCurvePlan::kMaxRamps * work.window_spans);
}

// The feeds of the lines and of the arc differ in their last bit.
TEST(PlanWork, ALineBehindAnArcAtTheSameFeedEnds) {
  machine::Machine machine = equal_axes(200, 3'000, 30'000);
  machine.motion.junction_deviation = 0.05;
  const Planning planning = planning_of("G1 F6000\nG1 X-20 Y-36\nG3 X4 Y-63 R23\nG1 X31 Y-67\n", machine);
  EXPECT_EQ(planning.blocks, 4U);
  EXPECT_EQ(planning.error, std::nullopt);
  expect_within_bounds(planning.work);
}

// One phase covers more blocks than the ring buffer holds behind the window.
TEST(PlanWork, AStraightLineOfManyBlocksEnds) {
  struct {
    double jerk;
    double window;
    int blocks;
  } const cases[] = {{100'000, 10'000, 25'000}, {0, 100'000, 150'000}};
  for (const auto& line : cases) {
    std::string program = "G1 F18000\n";
    for (int i = 1; i <= line.blocks; ++i) program += fmt::format("X{:.2f}\n", 0.02 * i);
    machine::Machine machine = equal_axes(300, 3'000, line.jerk);
    machine.motion.window = line.window;
    const Planning planning = planning_of(program, machine);
    EXPECT_EQ(planning.blocks, static_cast<std::size_t>(line.blocks) + 1) << "jerk " << line.jerk;
    EXPECT_EQ(planning.error, std::nullopt) << "jerk " << line.jerk;
  }
}

// A machine with equal or different axes, of 10 to 3,000 steps/mm; the jerk is 5 to 500 times the acceleration.
machine::Machine random_machine(Random& random) {
  machine::Machine machine = machine::default_machine();
  const bool alike = random.below(2) == 0;
  for (machine::MachineAxis& axis : machine.axes) {
    if (alike && &axis != machine.axes.data()) {
      const char letter = axis.letter;
      axis = machine.axes[0];
      axis.letter = letter;
      continue;
    }
    const double acceleration = random.logarithmic(100, 10'000);
    set_axis(axis, random.logarithmic(5, 500), acceleration, acceleration * random.logarithmic(5, 500));
    axis.steps_per_mm = random.logarithmic(10, 3'000);
  }
  constexpr double kWindows[] = {2, 3, 5, 16, 64, 256, 4'096, 16'384};
  machine.motion.window = kWindows[random.below(std::size(kWindows))];
  machine.motion.junction_deviation = random.below(8) == 0 ? 0 : random.logarithmic(0.001, 0.5);
  if (random.below(4) == 0) machine.motion.max_override = random.uniform(1, 2);
  if (random.below(4) == 0) machine.motion.hold_reserve = random.uniform(0, 0.9);
  return machine;
}

// Length of the next motion. `kind` 0: any size; 1: equal and tiny; 2: long; 3: tiny; 4 and 5: one of these at random.
double random_length(Random& random, std::size_t kind, double tiny) {
  switch (kind < 4 ? kind : random.below(4)) {
    case 0:
      return random.logarithmic(0.01, 100);
    case 1:
      return tiny;
    case 2:
      return random.logarithmic(0.5, 100);
    default:
      return random.logarithmic(0.001, 0.1);
  }
}

// Lines and arcs, some with further axes; rapids, dwells, exact stops, new feeds.
std::string random_program(Random& random, double velocity) {
  const double feed = random.below(2) == 0 ? 30 * velocity : random.logarithmic(60, 30'000);
  std::string program = fmt::format("G21 G90 G17 G64 G1 F{:.0f}\n", feed);
  const std::size_t kind = random.below(6);
  const double tiny = random.logarithmic(0.002, 0.5);
  const std::size_t blocks = 5 + random.below(80);
  double x = 0, y = 0, z = 0, e = 0, heading = random.uniform(0, 6.28);
  for (std::size_t i = 0; i < blocks; ++i) {
    const double length = random_length(random, kind, tiny);
    heading += kind == 1 ? random.uniform(-0.1, 0.2) * tiny : random.below(3) == 0 ? 0 : random.uniform(-1.5, 1.5);
    if (random.below(40) == 0) program += random.below(2) == 0 ? "G61.1\n" : "G64\n";
    if (random.below(80) == 0) program += "G4 P0.01\n";
    if (random.below(20) == 0) program += fmt::format("F{:.0f}\n", random.logarithmic(60, 30'000));
    x += length * std::cos(heading);
    y += length * std::sin(heading);
    if (random.below(kind == 2 ? 2 : 15) == 0) {
      const double radius = length * random.uniform(0.51, 3) + 1e-4;
      program += fmt::format("G{} X{:.5f} Y{:.5f} R{:.5f}\n", 2 + random.below(2), x, y,
                             random.below(3) == 0 ? -radius : radius);
      heading = random.uniform(0, 6.28);
      continue;
    }
    program += fmt::format("G{} X{:.5f} Y{:.5f}", random.below(25) == 0 ? 0 : 1, x, y);
    if (random.below(6) == 0) program += fmt::format(" Z{:.5f}", z += random.uniform(-0.2, 0.2) * length);
    if (random.below(4) == 0) program += fmt::format(" E{:.5f}", e += 0.085 * length);
    program += "\n";
  }
  return program;
}

// TRAMMEL_SEED repeats one program; TRAMMEL_LONG runs a hundred times as many.
TEST(PlanWork, IsWithinItsBoundsForRandomPrograms) {
  const char* const wanted = std::getenv("TRAMMEL_SEED");
  const std::uint64_t first = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 0;
  const std::uint64_t programs = wanted != nullptr ? 1 : std::getenv("TRAMMEL_LONG") != nullptr ? 100'000 : 1'000;
  double windows = 0;
  double ramps = 0;
  for (std::uint64_t seed = first; seed < first + programs; ++seed) {
    SCOPED_TRACE(fmt::format("repeat with TRAMMEL_SEED={}", seed));
    Random random(seed);
    const machine::Machine machine = random_machine(random);
    const std::string program = random_program(random, machine.axes[0].max_velocity);
    Planning planning;
    ASSERT_NO_THROW(planning = planning_of(program, machine));
    ASSERT_EQ(planning.error, std::nullopt) << gcode::describe(*planning.error);
    expect_within_bounds(planning.work);
    if (HasFailure()) return;
    const PlanWork& work = planning.work;
    windows = std::max(windows, static_cast<double>(work.windows) / static_cast<double>(work.spans + work.runs));
    ramps = std::max(ramps, static_cast<double>(work.ramps) / static_cast<double>(work.window_spans));
  }
  RecordProperty("windows_a_span", std::to_string(windows));
  RecordProperty("ramps_a_span", std::to_string(ramps));
}

}  // namespace
}  // namespace trammel::planner
