// Programs that are planned and run for the judge of motion, and their machines.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "motion_judge.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/gcode/line_source.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::test {

inline constexpr std::uint32_t kClock = 1'000'000;

class Recorder final : public run::Observer, public driver::StepSink {
 public:
  void command(std::uint64_t /*number*/, const driver::Command& command) override { commands.push_back(command); }
  void pin_step(const driver::PinStep& step) override { steps.push_back({step.cycle, step.axis, step.direction}); }
  void path_step(const driver::PathStep& /*step*/) override {}

  std::vector<driver::Command> commands;
  std::vector<TimedStep> steps;
};

class Program {
 public:
  Program(run::ProgramLines lines, const machine::Machine& machine, std::uint32_t clock_hz = kClock)
      : machine_(machine), clock_hz_(clock_hz) {
    const auto engine = sim::make_model_engine(
        sim::EngineOptions{static_cast<unsigned>(std::max<std::size_t>(4, machine.axes.size())), clock_hz, false});
    driver::Card card = driver::Card::open(*engine);
    engine->set_sink(&recorder_);
    run::Runner runner(std::move(lines), machine_, planner::limits_of(card.identification()));
    runner.add(recorder_);
    seconds_ = runner.plan().seconds;
    runner.run(card);
  }

  MotionVerdict verdict() const {
    return judge_motion(recorder_.commands, {machine_, static_cast<double>(clock_hz_), 0.01});
  }
  double farthest() const { return farthest_from_motion(recorder_.commands, recorder_.steps); }
  double seconds() const { return seconds_; }
  Recorder& recorder() { return recorder_; }

 private:
  machine::Machine machine_;
  std::uint32_t clock_hz_;
  Recorder recorder_;
  double seconds_ = 0;
};

inline run::ProgramLines text(const std::string& program) {
  return [text = std::make_shared<const std::string>(program)]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<gcode::TextLines>(*text, "program");
  };
}

// The default machine with these limits on each axis, in mm/s, mm/s^2 and mm/s^3; a jerk of 0 is no limit.
inline machine::Machine machine_of(double velocity, double acceleration, double jerk) {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.max_velocity = velocity;
    axis.max_acceleration = acceleration;
    axis.max_jerk = jerk;
  }
  return machine;
}

// A fast machine that a clock of 1 MHz can still drive: 300 mm/s, 3000 mm/s^2, jerk in mm/s^3.
inline machine::Machine fast_machine(double jerk) { return machine_of(300, 3000, jerk); }

// The margins above 1 are for integers and, at corners, for the directions of rounded ends.
inline void expect_within_limits(const MotionVerdict& verdict) {
  EXPECT_LE(verdict.velocity.share, 1.001) << "command " << verdict.velocity.command;
  EXPECT_LE(verdict.acceleration.share, 1.001) << "command " << verdict.acceleration.command;
  EXPECT_LE(verdict.jerk.share, 1.001) << "command " << verdict.jerk.command;
  EXPECT_LE(verdict.acceleration_jump.share, 0.01) << "command " << verdict.acceleration_jump.command;
  EXPECT_LE(verdict.rate_jump.share, 1) << "command " << verdict.rate_jump.command;
  EXPECT_LE(verdict.rest.share, 1.01) << "command " << verdict.rest.command;
  EXPECT_LE(verdict.corner.share, 1.005) << "command " << verdict.corner.command;
  EXPECT_GT(verdict.updates, 0U);
}

// A zigzag of short lines in a cube, with changing feeds.
inline std::string random_lines(unsigned seed, bool other_axis = false) {
  std::mt19937 random(seed);
  std::string program = "G21 G90 G94\n";
  double x = 0, y = 0, z = 0, e = 0;
  for (int i = 0; i < 60; ++i) {
    const double length = std::exp2(std::uniform_real_distribution<>(-5, 4)(random));
    const double heading = std::uniform_real_distribution<>(0, 6.28)(random);
    x += length * std::cos(heading);
    y += length * std::sin(heading);
    if (random() % 4 == 0) z += std::uniform_real_distribution<>(-1, 1)(random);
    if (i % 10 == 0) program += fmt::format("F{:.0f}\n", std::uniform_real_distribution<>(300, 9000)(random));
    program += fmt::format("G{} X{:.4f} Y{:.4f} Z{:.4f}", random() % 12 == 0 ? 0 : 1, x, y, z);
    if (other_axis) e += length * std::exp2(std::uniform_real_distribution<>(-3, 5)(random)) * (random() % 4 ? 1 : -1);
    program += other_axis ? fmt::format(" E{:.4f}\n", e) : "\n";
  }
  return program + "M2\n";
}

// The commands of a program and its planned seconds; nothing runs.
struct Planned final : driver::CommandSink {
  Planned(gcode::LineSource& lines, const machine::Machine& machine, std::uint32_t clock_hz, double feed_scale = 1) {
    gcode::ReaderOptions options;
    options.block_delete = true;
    options.feed_scale = feed_scale;
    gcode::Reader reader(lines, machine, {}, options);
    planner::CardLimits card;
    card.clock_hz = clock_hz;
    card.axes = static_cast<unsigned>(std::max<std::size_t>(4, machine.axes.size()));
    card.classes = true;
    planner::BlockBuilder blocks(reader, machine, card);
    planner::Planner planner(blocks, machine, card);
    for (planner::PlannedBlock block; planner.next(*this, block);) {
      if (planner::moves(block.block)) seconds += block.seconds;
      if (block.block.corner == planner::Corner::kBlended) ++blends;
    }
    error = blocks.error();
  }
  void put(const driver::Command& command) override { commands.push_back(command); }

  std::vector<driver::Command> commands;
  double seconds = 0;
  std::size_t blends = 0;
  std::optional<gcode::Error> error;
};

}  // namespace trammel::test
