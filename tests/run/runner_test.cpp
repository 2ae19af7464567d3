#include "trammel/run/runner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "clocks.hpp"
#include "dying_bus.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/commanded_course.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

using ::testing::HasSubstr;

ProgramLines lines_of(const std::string& text) {
  return [text = std::make_shared<const std::string>(text)]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<gcode::TextLines>(*text, "p.ngc");
  };
}

class RunnerTest : public testing::Test {
 protected:
  Outcome run(const std::string& text) {
    Runner runner = make(text);
    runner.plan();
    return runner.run(card_);
  }
  Runner make(const std::string& text) {
    return Runner(lines_of(text), machine_, planner::limits_of(card_.identification()));
  }
  static std::string error_of(const std::function<void()>& call) {
    try {
      call();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  driver::Card card_ = driver::Card::open(*engine_);
};

TEST_F(RunnerTest, RunsAProgramToItsEnd) {
  Runner runner = make("G1 X1 Y2 F600\nG4 P0.1\nG2 X2 Y1 I1 F600\nM3\nM2\n");
  StepRecorder recorder({}, kinematics::Kinematics(machine_));
  engine_->set_sink(&recorder);
  runner.add(recorder);
  const Plan plan = runner.plan();
  EXPECT_EQ(plan.file, "p.ngc");
  EXPECT_EQ(plan.segments, 2U);
  EXPECT_EQ(plan.end[0], 160);
  EXPECT_EQ(plan.accepted.count("M3"), 1U);
  EXPECT_EQ(recorder.steps()[0], 0U) << "nothing moves in the first pass";
  const Outcome outcome = runner.run(card_);
  recorder.finish();
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{160, 80, 0, 0}));
  EXPECT_EQ(outcome.commands, plan.commands);
  EXPECT_NO_THROW(recorder.check(outcome.counted));
  const double seconds = static_cast<double>(engine_->cycles()) / kClock;
  EXPECT_NEAR(plan.seconds, seconds, 0.02 * seconds);
  EXPECT_GT(recorder.deviation().largest_line(), 0);
  EXPECT_LE(recorder.deviation().largest_line(), 0.7081);
}

// Measures the largest deviation of the path from a circle, in pulses of an axis.
class CircleMeter final : public driver::StepSink {
 public:
  CircleMeter(double centre_x, double centre_y, double radius, double scale_x, double scale_y)
      : centre_{centre_x, centre_y}, radius_(radius), scale_{scale_x, scale_y} {}
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override {
    if (step.axis > 1) return;
    at_[step.axis] += step.direction;
    ++steps;
    const double x = at_[0] / scale_[0] - centre_[0];
    const double y = at_[1] / scale_[1] - centre_[1];
    const double off = std::abs(std::hypot(x, y) - radius_) / radius_;  // relative error of the radius
    farthest = std::max(farthest, off * std::hypot(x * scale_[0], y * scale_[1]));
  }

  double farthest = 0;  // pulses
  int steps = 0;

 private:
  std::array<double, 2> centre_;
  double radius_;
  std::array<double, 2> scale_;
  std::array<double, 2> at_{};
};

// A circle on axes of unequal steps/mm is an ellipse in pulses. The accumulator rounds its centre and semi-axes to
// whole pulses.
TEST_F(RunnerTest, ACircleOnUnequalScalesGoesOutAsAnEllipse) {
  machine::apply_override(machine_, "axis.y.steps_per_mm=123.4");
  RunSettings settings;
  settings.arcs = planner::ArcsBy::kAccumulator;
  Runner runner(lines_of("F1200 G2 X0 Y0 I5.003 J2.007\nG3 X0 Y4.014 I-5.003 J2.007\nM2\n"), machine_,
                planner::limits_of(card_.identification()), settings);
  StepRecorder recorder({}, kinematics::Kinematics(machine_));
  engine_->set_sink(&recorder);
  runner.add(recorder);
  runner.plan();
  const Outcome outcome = runner.run(card_);
  recorder.finish();
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{0, 495, 0, 0}));
  EXPECT_GT(recorder.deviation().largest_arc(), 0.3);
  EXPECT_LE(recorder.deviation().largest_arc(), 1.1);
  EXPECT_EQ(recorder.deviation().largest_line(), 0) << "no chords";
}

TEST_F(RunnerTest, AnEllipsesPulsesAreNearTheCircle) {
  machine::apply_override(machine_, "axis.y.steps_per_mm=123.4");
  RunSettings settings;
  settings.arcs = planner::ArcsBy::kAccumulator;
  Runner runner(lines_of("F1200 G2 X0 Y0 I5.003 J2.007\nM2\n"), machine_, planner::limits_of(card_.identification()),
                settings);
  CircleMeter circle(5.003, 2.007, std::hypot(5.003, 2.007), 80, 123.4);
  engine_->set_sink(&circle);
  runner.plan();
  runner.run(card_);
  EXPECT_GT(circle.steps, 4000);
  EXPECT_LE(circle.farthest, 1.7);  // measured: 1.61
  EXPECT_GT(circle.farthest, 0.3);
}

// Steps in 8 directions stay closer to the circle than steps of one axis at a time.
TEST_F(RunnerTest, EightDirectionsAreNearerToTheCircle) {
  const auto farthest = [&](planner::ArcsBy arcs) {
    RunSettings settings;
    settings.arcs = arcs;
    Runner runner(lines_of("F1200 G2 I5 J2\nM2\n"), machine_, planner::limits_of(card_.identification()), settings);
    StepRecorder recorder({}, kinematics::Kinematics(machine_));
    engine_->set_sink(&recorder);
    runner.add(recorder);
    runner.plan();
    EXPECT_EQ(runner.run(card_).final_position, (std::vector<std::int64_t>(4, 0)));
    recorder.finish();
    return recorder.deviation().largest_arc();
  };
  EXPECT_LE(farthest(planner::ArcsBy::kEightDirections), 0.52);
  EXPECT_GE(farthest(planner::ArcsBy::kAccumulator), 0.7);
}

TEST_F(RunnerTest, RunsSeveralPrograms) {
  EXPECT_EQ(run("G0 X1\n").final_position[0], 80);
  const driver::Card again = driver::Card::open(*engine_);
  EXPECT_EQ(again.identification().axes, 4U);
}

TEST_F(RunnerTest, ConfiguresTheCard) {
  machine::apply_override(machine_, "axis.x.step_length_ns=10000");
  machine::apply_override(machine_, "axis.x.step_space_ns=20000");
  run("G0 X1\n");
  EXPECT_EQ(card_.timing().pulse_period[0], driver::shortest_pulse_period(10, 20));
}

// The slew time is 2 v / a of the axis with the longest, 0.3 s here, but at most that of the card's slowest slew.
TEST_F(RunnerTest, SlewFollowsFromTheAxes) {
  const auto slew = [this] { return card_.parts().registers.read(card_map::reg::kSlew); };
  run("G0 X1\n");
  EXPECT_EQ(slew(), driver::Card::kSlowestSlew / 300'000);
  machine::apply_override(machine_, "axis.y.max_acceleration=500");
  run("G0 X1\n");
  EXPECT_EQ(slew(), driver::Card::kSlowestSlew / 600'000);
  machine::apply_override(machine_, "axis.y.max_acceleration=0.15");
  run("G0 X1\n");
  EXPECT_EQ(slew(), 1U);
}

struct Event {
  std::string what;
  std::size_t line = 0;
  std::uint64_t number = 0;
  bool operator==(const Event& other) const {
    return what == other.what && line == other.line && number == other.number;
  }
};

class Events final : public Observer {
 public:
  void planned(const planner::PlannedBlock& block, std::uint64_t first) override {
    list.push_back({"planned", block.block.line, first});
  }
  void sending(const planner::PlannedBlock& block) override { list.push_back({"sending", block.block.line, 0}); }
  void command(std::uint64_t number, const driver::Command& /*command*/) override {
    list.push_back({"command", 0, number});
  }
  void sent() override { list.push_back({"sent", 0, 0}); }
  void progress(const Progress& /*progress*/) override { ++looks; }
  std::vector<Event> list;
  int looks = 0;
};

TEST_F(RunnerTest, TellsItsObserversInOrder) {
  Runner runner = make("G4 P0.01\nG4 P0.02\n");
  Events events;
  runner.add(events);
  runner.plan();
  EXPECT_EQ(events.list, (std::vector<Event>{{"planned", 1, 0}, {"planned", 2, 1}, {"planned", 2, 2}}));
  events.list.clear();
  runner.run(card_);
  EXPECT_EQ(events.list, (std::vector<Event>{{"sending", 1, 0},
                                             {"command", 0, 0},
                                             {"sent", 0, 0},
                                             {"sending", 2, 0},
                                             {"command", 0, 1},
                                             {"sent", 0, 0},
                                             {"sending", 2, 0},
                                             {"command", 0, 2},
                                             {"sent", 0, 0}}));
  EXPECT_GT(events.looks, 3);
}

TEST_F(RunnerTest, RefusesAProgramBeforeAnythingMoves) {
  EXPECT_THAT(error_of([&] { run("G0 X1\nG0 X2 Q\n"); }), HasSubstr("p.ngc:2: "));
  machine::apply_override(machine_, "axis.x.max=10");
  EXPECT_THAT(error_of([&] { run("G0 X1\nG0 X11\n"); }), HasSubstr("p.ngc:2: X11 is beyond the axis's max of 10"));
  EXPECT_EQ(card_.read_snapshot().position[0], 0);
}

TEST_F(RunnerTest, RefusesAProgramThatChangesBetweenThePasses) {
  int opened = 0;
  Runner runner(
      [&]() -> std::unique_ptr<gcode::LineSource> {
        return std::make_unique<gcode::TextLines>(opened++ == 0 ? "G0 X1\n" : "G0 X2\n", "p.ngc");
      },
      machine_, planner::limits_of(card_.identification()));
  runner.plan();
  EXPECT_THAT(error_of([&] { runner.run(card_); }), HasSubstr("has changed"));
}

// The program is read only once: the lines before the error are executed, and the card comes to rest.
TEST_F(RunnerTest, StreamsWithoutAFirstPass) {
  Runner runner = make("F600\nG1 X1\nG1 Y2\nM3\n");
  const Outcome outcome = runner.stream(card_);
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{80, 160, 0, 0}));
  EXPECT_EQ(runner.last_plan().segments, 2U);
  EXPECT_EQ(runner.last_plan().commands, outcome.commands);
  EXPECT_EQ(runner.last_plan().accepted.count("M3"), 1U);
  RunSettings there;
  there.start = {1, 2};
  Runner wrong(lines_of("F600\nG1 X2\nG1 Y2.5\nX\nX0\n"), machine_, planner::limits_of(card_.identification()), there);
  EXPECT_THAT(error_of([&] { wrong.stream(card_); }), HasSubstr("p.ngc:4: malformed number"));
  EXPECT_TRUE(card_.in_position());
  EXPECT_EQ(engine_->positions(), (std::vector<std::int64_t>{160, 200, 0, 0}));
}

TEST_F(RunnerTest, RefusesAnotherCardThanThePlanned) {
  Runner runner(lines_of("G0 X1\n"), machine_, {2 * kClock, 4, true});
  runner.plan();
  EXPECT_THROW(runner.run(card_), std::invalid_argument);
}

// The queues hold about 500 dwells behind the one that runs.
TEST_F(RunnerTest, NamesTheLineThatRanAndNotTheLastThatWasSent) {
  std::string text = "G0 X1\n";
  for (int i = 0; i < 600; ++i) text += "G4 P1\n";
  DyingBus bus(*engine_, kClock / 2);  // within the first dwell
  driver::Card card = driver::Card::open(bus);
  Runner runner = make(text);
  Events events;
  runner.add(events);
  runner.plan();
  events.list.clear();
  std::size_t line = 0;
  EXPECT_THAT(error_of([&] {
                try {
                  runner.run(card);
                } catch (const RunError& error) {
                  line = error.line();
                  throw;
                }
              }),
              HasSubstr("p.ngc:2: "));
  EXPECT_EQ(line, 2U);
  EXPECT_GT(events.list.size(), 3 * 500U) << "the queues were full";
}

// If the link still works, the runner reads the card once more to find the line.
TEST_F(RunnerTest, NamesTheLineOfARefusal) {
  class Meddler final : public Observer {
   public:
    explicit Meddler(sim::Engine& engine) : engine_(engine) {}
    void progress(const Progress& /*progress*/) override {
      if (engine_.cycles() < 2'500'000 || std::exchange(done_, true)) return;
      try {
        engine_.write(0xFF0, 0);  // not a register
      } catch (const driver::Error&) {
      }
    }

   private:
    sim::Engine& engine_;
    bool done_ = false;
  };
  std::string text;
  for (int i = 0; i < 600; ++i) text += "G4 P1\n";
  Runner runner = make(text);
  Meddler meddler(*engine_);
  runner.add(meddler);
  runner.plan();
  EXPECT_THAT(error_of([&] { runner.run(card_); }), HasSubstr("p.ngc:3: "));
}

TEST_F(RunnerTest, ReportsFeedsThatAreNotReached) {
  Runner runner = make("G1 X10 F600\nG1 X100 F60000\nG1 X100.1 F6000\nG1 X100.05\n");
  const std::vector<FeedNotReached> feeds = runner.plan().feeds_not_reached;
  ASSERT_EQ(feeds.size(), 2U);
  EXPECT_EQ(feeds[0].cause, planner::SpeedLimit::kAcceleration);
  EXPECT_EQ(feeds[0].count, 2U);
  EXPECT_EQ(feeds[0].line, 4U) << "the shorter of the two";
  EXPECT_DOUBLE_EQ(feeds[0].wanted, 6000);
  EXPECT_LT(feeds[0].reached, 1000);
  EXPECT_EQ(feeds[1].cause, planner::SpeedLimit::kAxisVelocity);
  EXPECT_EQ(feeds[1].line, 2U);
  EXPECT_NEAR(feeds[1].reached, machine_.axes[0].max_velocity * 60, 1);
}

TEST_F(RunnerTest, DrawsTheCommandedCourse) {
  Runner runner = make("G1 X10 F600\nG2 X20 I5\n");
  CommandedCourse course(machine_);
  runner.add(course);
  runner.plan();
  const std::vector<PathPoint> points = course.points();
  ASSERT_EQ(points.size(), 1 + 1 + 64U);
  EXPECT_EQ(points[1].at[0], 10);
  EXPECT_NEAR(points[33].at[1], 5, 0.01) << "the top of the arc";
  EXPECT_FALSE(points[1].rapid);
  ASSERT_TRUE(course.detail_command());
  EXPECT_GT(*course.detail_command(), 3U) << "the arc rather than the line";
  EXPECT_EQ(course.detail().size(), StepRecorder::kDetailPoints + 1);
}

}  // namespace
}  // namespace trammel::run
