// The second reading of whole programs, and whether it can say no.
#include "motion_judge.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "trammel/driver/card.hpp"
#include "trammel/gcode/line_source.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::test {
namespace {

constexpr std::uint32_t kClock = 1'000'000;
constexpr double kTight = 1.001;  // increments and rates are integers

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
  Program(run::ProgramLines lines, const machine::Machine& machine) : machine_(machine) {
    const auto engine = sim::make_model_engine(
        sim::EngineOptions{static_cast<unsigned>(std::max<std::size_t>(4, machine.axes.size())), kClock, false});
    driver::Card card = driver::Card::open(*engine);
    engine->set_sink(&recorder_);
    run::Runner runner(std::move(lines), machine_, planner::limits_of(card.identification()));
    runner.add(recorder_);
    seconds_ = runner.plan().seconds;
    runner.run(card);
  }

  MotionVerdict verdict() const { return judge_motion(recorder_.commands, {machine_, kClock, 0.01}); }
  double farthest() const { return farthest_from_motion(recorder_.commands, recorder_.steps); }
  double seconds() const { return seconds_; }
  Recorder& recorder() { return recorder_; }

 private:
  machine::Machine machine_;
  Recorder recorder_;
  double seconds_ = 0;
};

run::ProgramLines text(const std::string& program) {
  return [text = std::make_shared<const std::string>(program)]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<gcode::TextLines>(*text, "program");
  };
}

// Limits so high that a clock of 1 MHz is no limit, and steps short enough.
machine::Machine machine_of(double velocity, double acceleration, double jerk) {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.max_velocity = velocity;
    axis.max_acceleration = acceleration;
    axis.max_jerk = jerk;
  }
  return machine;
}

void expect_within_limits(const MotionVerdict& verdict) {
  EXPECT_LE(verdict.velocity.share, kTight) << "command " << verdict.velocity.command;
  EXPECT_LE(verdict.acceleration.share, kTight) << "command " << verdict.acceleration.command;
  EXPECT_LE(verdict.jerk.share, kTight) << "command " << verdict.jerk.command;
  EXPECT_LE(verdict.acceleration_jump.share, 0.01) << "command " << verdict.acceleration_jump.command;
  EXPECT_LE(verdict.rate_jump.share, 1) << "command " << verdict.rate_jump.command;
  EXPECT_LE(verdict.rest.share, 1.01) << "command " << verdict.rest.command;
  EXPECT_LE(verdict.corner.share, kTight) << "command " << verdict.corner.command;
  EXPECT_GT(verdict.updates, 0U);
}

// A zigzag of short lines in a cube, with feeds that change.
std::string random_lines(unsigned seed) {
  std::mt19937 random(seed);
  std::string program = "G21 G90 G94\n";
  double x = 0, y = 0, z = 0;
  for (int i = 0; i < 60; ++i) {
    const double length = std::exp2(std::uniform_real_distribution<>(-5, 4)(random));
    const double heading = std::uniform_real_distribution<>(0, 6.28)(random);
    x += length * std::cos(heading);
    y += length * std::sin(heading);
    if (random() % 4 == 0) z += std::uniform_real_distribution<>(-1, 1)(random);
    if (i % 10 == 0) program += fmt::format("F{:.0f}\n", std::uniform_real_distribution<>(300, 9000)(random));
    program += fmt::format("G{} X{:.4f} Y{:.4f} Z{:.4f}\n", random() % 12 == 0 ? 0 : 1, x, y, z);
  }
  return program + "M2\n";
}

TEST(MotionJudge, RandomLinesAreWithinTheirLimits) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Program program(text(random_lines(seed)), machine_of(100, 1000, 0));
    const MotionVerdict verdict = program.verdict();
    expect_within_limits(verdict);
    EXPECT_GT(verdict.acceleration.share, 0.9);
    EXPECT_NEAR(verdict.seconds(kClock), program.seconds(), 0.001 * program.seconds());
    EXPECT_LE(program.farthest(), 0.8);
  }
}

TEST(MotionJudge, Debug) {
  for (const char* p : {"G1 X10 F6000\nM2\n", "G1 X10 F6000\nX10.01\nX10.02\nM2\n", "G1 X10 F6000\nX0\nM2\n"}) {
    Program program(text(p), machine_of(100, 1000, 0));
    const MotionVerdict v = program.verdict();
    auto& r = program.recorder();
    fmt::print("{} plan {} reading {} steps {} .. {} far {}\n", p, program.seconds(), v.seconds(kClock), r.steps.front().cycle, r.steps.back().cycle, program.farthest());
    for (auto& c : r.commands) if (auto* f = std::get_if<driver::FeedCommand>(&c)) fmt::print("  {} {} {} {}\n", f->ticks, double(f->rate)*0x1p-64, f->acceleration*0x1p-64, f->floor*0x1p-32);
    fmt::print("vel {} acc {} rate {} rest {} corner {}\n", v.velocity.share, v.acceleration.share, v.rate_jump.share, v.rest.share, v.corner.share);
  }
}

}  // namespace
}  // namespace trammel::test
