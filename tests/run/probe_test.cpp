// Programs that probe, on the model's card: the position of the edge according to the steps at the pins, the lines that
// use this position, and the place at which a run stops that cannot continue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "clocks.hpp"
#include "steps.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kPulses = 80;  // pulses per mm
constexpr std::size_t kZ = 2;

class ProbingProgram : public testing::Test {
 protected:
  ProbingProgram() {
    engine_->set_sink(&steps_);
    machine_.probe.input = 2;
  }
  void touch_at(double seconds, bool touches = true) {
    bus_.at(static_cast<std::uint64_t>(seconds * kClock),
            [touches](sim::Engine& engine) { engine.set_inputs(touches ? 0b100 : 0); });
  }
  Runner make(const std::string& text) {
    const auto shared = std::make_shared<const std::string>(text);
    return Runner([shared] { return std::make_unique<gcode::TextLines>(*shared, "p.ngc"); }, machine_,
                  planner::limits_of(card_.identification()));
  }
  Outcome run(const std::string& text) {
    Runner runner = make(text);
    plan_ = runner.plan();
    return runner.run(card_);
  }
  std::string error_of(const std::string& text) {
    try {
      run(text);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }
  std::int64_t position(std::size_t axis) const { return steps_.position(axis); }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  sim::TimedBus bus_{*engine_, kClock, 1e9};
  driver::Card card_ = driver::Card::open(bus_);
  test::Steps steps_;
  Plan plan_;
};

// At 2 mm/s a pulse takes 6,250 clocks, so the delay of the input's synchroniser does not change the position.
TEST_F(ProbingProgram, ResultIsWhereTheCardWas) {
  touch_at(2);
  const Outcome outcome = run("G0 X3\nG38.2 Z-10 F120\n#1=#5063\nG0 Z[#1+2] X[#5070*10]\nM2\n");
  const std::int64_t edge = steps_.position(kZ, 2 * kClock + 8);
  ASSERT_EQ(outcome.probes.size(), 1U);
  EXPECT_TRUE(outcome.probes[0].tripped);
  EXPECT_EQ(outcome.probes[0].line, 2U);
  EXPECT_EQ(outcome.probes[0].edge[kZ], static_cast<double>(edge) / kPulses);
  EXPECT_LT(edge, -3 * kPulses);
  EXPECT_GT(edge, -4 * kPulses);
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{10 * kPulses, 0, edge + 2 * kPulses, 0}));
  EXPECT_EQ(position(kZ), edge + 2 * kPulses);
  EXPECT_EQ(plan_.probes, 1U);
  EXPECT_EQ(plan_.lines_on_probes, 1U) << "the assignment moves nothing";
  EXPECT_EQ(outcome.parameters.at(1), static_cast<double>(edge) / kPulses);
}

// The recorder rejects a step of a command that was not announced to it.
TEST_F(ProbingProgram, StepsBelongToTheirCommands) {
  StepRecorder::Options options;
  StepRecorder recorder(options, kinematics::Kinematics(machine_));
  engine_->set_sink(&recorder);
  touch_at(2);
  Runner runner = make("M3\nG38.2 Z-10 F120\nG2 X2 I1 F600\nG38.3 X3\nG1 X0 Y1 Z0\nM2\n");
  runner.add(recorder);
  runner.plan();
  const Outcome outcome = runner.run(card_);
  recorder.finish();
  EXPECT_NO_THROW(recorder.check(outcome.counted));
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{0, kPulses, 0, 0}));
  EXPECT_LE(recorder.deviation().largest_line(), 0.8671) << "three axes, where the probe cut its line, too";
}

TEST_F(ProbingProgram, OffsetsComeFromWhereItStands) {
  touch_at(2);
  const Outcome outcome = run("G38.2 Z-10 F120\nG10 L20 P2 Z1\nG55\nG1 Z5 F600\nG0 Z1\nM2\n");
  const std::int64_t rest = outcome.final_position[kZ];
  EXPECT_LT(rest, -3 * kPulses);
  EXPECT_EQ(position(kZ), rest);
  EXPECT_LE(rest, steps_.position(kZ, 2 * kClock)) << "it stands behind the edge";
  EXPECT_NEAR(outcome.parameters.at(5243), static_cast<double>(rest) / kPulses - 1, 1e-12);
}

TEST_F(ProbingProgram, SeveralProbesAndTheWayBack) {
  touch_at(2);
  touch_at(3, false);
  const Outcome outcome = run("G38.2 Z-10 F120\n#1=#5063\nG38.4 Z#1 F1\nG0 Z0\nG91 G38.3 X1 F600\nG0 X[#5070+1]\nM2\n");
  ASSERT_EQ(outcome.probes.size(), 3U);
  EXPECT_EQ(outcome.probes[1].edge[kZ], static_cast<double>(steps_.position(kZ, 3 * kClock + 8)) / kPulses);
  EXPECT_FALSE(outcome.probes[2].tripped);
  EXPECT_EQ(outcome.final_position[0], 2 * kPulses);
}

TEST_F(ProbingProgram, StreamedProgramsProbeToo) {
  touch_at(2);
  Runner runner = make("G38.2 Z-10 F120\nG0 Z[#5063+2]\nM2\n");
  const Outcome outcome = runner.stream(card_);
  EXPECT_EQ(outcome.final_position[kZ], steps_.position(kZ, 2 * kClock + 8) + 2 * kPulses);
  EXPECT_EQ(runner.last_plan().probes, 1U);
}

TEST_F(ProbingProgram, TheSecondMotorProbesAlong) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{5, kClock, false});
  test::Steps steps;
  engine->set_sink(&steps);
  sim::TimedBus bus(*engine, kClock, 1e9);
  bus.at(2 * kClock, [](sim::Engine& card) { card.set_inputs(0b100); });
  machine_.axes[kZ].second_motor = true;
  driver::Card card = driver::Card::open(bus);
  const auto lines = [] { return std::make_unique<gcode::TextLines>("G38.2 Z-10 F120\nG0 Z0\nM2\n", "p.ngc"); };
  Runner runner(lines, machine_, planner::limits_of(card.identification()));
  runner.plan();
  EXPECT_EQ(runner.run(card).counted[4], 0);
  EXPECT_EQ(steps.position(4, 2 * kClock), steps.position(kZ, 2 * kClock));
  EXPECT_LT(steps.position(4, 2 * kClock), -3 * kPulses);
}

TEST_F(ProbingProgram, AMissIsAnErrorWhereTheProgramSaysSo) {
  EXPECT_EQ(error_of("G0 X1\nG38.2 Z-1 F600\nG0 X2\nM2\n"), "p.ngc:2: the probe has met nothing on its way");
  EXPECT_EQ(position(kZ), -kPulses) << "at the end of its way";
  EXPECT_EQ(position(0), kPulses);
}

TEST_F(ProbingProgram, AMissMayBeAnAnswer) {
  const Outcome outcome = run("G38.3 Z-1 F600\nG0 X[1+#5070] Y#5063\nM2\n");
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{kPulses, -kPulses, -kPulses, 0}));
}

TEST_F(ProbingProgram, TouchesBeforeItMoves) {
  engine_->set_inputs(0b100);
  EXPECT_EQ(error_of("G0 X1\nG38.2 Z-1 F600\nM2\n"), "p.ngc:2: the probe touches before it moves");
  EXPECT_EQ(position(kZ), 0);
  engine_->set_inputs(0);
  EXPECT_EQ(error_of("G91 G38.4 Z-1 F600\nM2\n"), "p.ngc:1: the probe is free before it moves");
}

TEST_F(ProbingProgram, TheLevelIsTheMachineFiles) {
  machine_.probe.touched_level = false;
  EXPECT_EQ(error_of("G38.2 Z-1 F600\nM2\n"), "p.ngc:1: the probe touches before it moves");
}

// The edge is near Z-3.9, the target is Z-10. Whether the later lines are valid depends on that position.
TEST_F(ProbingProgram, LinesThatDependAreCheckedWhenReached) {
  machine_.axes[0].max = 5;
  touch_at(2);
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nG0 Y1\nG0 X[12+#5063]\nG0 Y2\nM2\n"), HasSubstr("p.ngc:3: X8."))
      << "at the target it would be X2";
  EXPECT_EQ(position(1), kPulses) << "what stands before is made, and ends at rest";
  EXPECT_EQ(position(0), 0);
}

TEST_F(ProbingProgram, WhatIsWrongAtTheTargetAloneRuns) {
  machine_.axes[0].min = -5;
  touch_at(2);
  // With the target's position these lines would be errors: X-8, a division by 0, an arc off its circle, a feed of 0.
  const Outcome outcome =
      run("G38.2 Z-10 F120\n#1=#5063\nG0 X[#1+2]\nG0 X[1/[#1+10]]\nG0 X0 Y0\nG91 G2 X2 I[1+0*[1/[#1+10]]] F600\n"
          "G90 G1 X0 F[10+#1]\nM2\n");
  EXPECT_EQ(outcome.final_position[0], 0);
}

TEST_F(ProbingProgram, WhatDoesNotDependIsCheckedBefore) {
  machine_.axes[0].max = 5;
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nG0 Z[#5063] X6\nM2\n"), HasSubstr("p.ngc:2: X6 is beyond"));
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nG0 Z[#5063] H1\nM2\n"), HasSubstr("p.ngc:2: H without G43"));
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nG[#5070] X1\nM2\n"), HasSubstr("p.ngc:2: 'G[#5070]' cannot depend"));
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nG1 X[1/0]\nM2\n"), HasSubstr("p.ngc:2: division by 0"));
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nG10 L2 P[1+#5070] X1\nM2\n"), HasSubstr("p.ngc:2: "));
  EXPECT_TRUE(steps_.pins.empty());
}

TEST_F(ProbingProgram, TheProbesOwnWayIsChecked) {
  machine_.axes[kZ].min = -9;
  EXPECT_THAT(error_of("G38.2 Z-10 F120\nM2\n"), HasSubstr("p.ngc:1: Z-10 is beyond"));
  EXPECT_THAT(error_of("G38.2 Z0 F120\nM2\n"), HasSubstr("p.ngc:1: G38.2 ends where it begins"));
  EXPECT_THAT(error_of("G93 G38.2 Z-1 F120\nM2\n"), HasSubstr("p.ngc:1: G38.2 needs a feed"));
  machine_.probe.input.reset();
  EXPECT_THAT(error_of("G38.2 Z-1 F120\nM2\n"), HasSubstr("p.ngc:1: G38.2: the machine file has no probe"));
}

TEST_F(ProbingProgram, AStartBehindAProbeIsRefused) {
  RunSettings settings;
  settings.first_line = 3;
  const auto lines = [] { return std::make_unique<gcode::TextLines>("G38.2 Z-10 F120\nG0 X1\nG0 X2\n", "p.ngc"); };
  Runner runner(lines, machine_, planner::limits_of(card_.identification()), settings);
  try {
    runner.plan();
    FAIL() << "no error";
  } catch (const ProgramError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.ngc:1: a probe before line 3"));
  }
}

}  // namespace
}  // namespace trammel::run
