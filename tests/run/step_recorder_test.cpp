#include "trammel/run/step_recorder.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "string_sink.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/run/step_fork.hpp"

namespace trammel::run {
namespace {

driver::LineCommand line(std::int64_t pulses) {
  driver::LineCommand result;
  result.ticks = 100;
  result.mask = 1;
  result.increment[0] = driver::rounded_increment(pulses, result.ticks);
  return result;
}

// Axes X, Y, Z with these steps/mm.
kinematics::Kinematics joints(const std::vector<double>& steps_per_mm) {
  machine::Machine machine = machine::default_machine();
  machine.axes.resize(steps_per_mm.size());
  for (std::size_t a = 0; a < steps_per_mm.size(); ++a) machine.axes[a].steps_per_mm = steps_per_mm[a];
  return kinematics::Kinematics(machine);
}

TEST(StepRecorder, WritesBothLists) {
  StringSink steps;
  StringSink path_steps;
  StepRecorder::Options options;
  options.steps = &steps;
  options.path_steps = &path_steps;
  const std::vector<double> steps_per_mm{80, 80};
  StepRecorder recorder(options, joints(steps_per_mm));
  recorder.command(3, line(-1));
  recorder.path_step({3, 50, 0, -1});
  recorder.pin_step({123456789012, 0, -1});
  recorder.finish();
  EXPECT_EQ(steps.text, "cycle,axis,direction\n123456789012,0,-1\n");
  EXPECT_EQ(path_steps.text, "command,tick,axis,direction\n3,50,0,-1\n");
}

TEST(StepRecorder, CountsAndChecksWhatThePinsMade) {
  StepRecorder::Options options;
  const std::vector<double> steps_per_mm{80, 80};
  StepRecorder recorder(options, joints(steps_per_mm));
  for (const int direction : {1, 1, -1}) recorder.pin_step({1, 1, static_cast<std::int8_t>(direction)});
  EXPECT_EQ(recorder.steps(), (std::vector<std::uint64_t>{0, 3}));
  EXPECT_EQ(recorder.position(), (std::vector<std::int64_t>{0, 1}));
  EXPECT_NO_THROW(recorder.check({0, 1}));
  EXPECT_THROW(recorder.check({0, 2}), std::runtime_error);
}

TEST(StepRecorder, KeepsOnePointATickForThePicture) {
  StepRecorder::Options options;
  const std::vector<double> steps_per_mm{80, 100};
  options.plot = true;
  options.clock_hz = 1000;
  StepRecorder recorder(options, joints(steps_per_mm));
  driver::LineCommand diagonal = line(2);
  diagonal.mask = 3;
  diagonal.increment[1] = diagonal.increment[0];
  recorder.command(0, diagonal);
  recorder.detail_of(0);
  recorder.path_step({0, 10, 0, 1});
  recorder.path_step({0, 10, 1, 1});
  recorder.path_step({0, 60, 0, 1});
  recorder.pin_step({1000, 0, 1});
  recorder.finish();
  const Point first{1 / 80.0, 1 / 100.0, 0};
  const Point second{2 / 80.0, 1 / 100.0, 0};
  EXPECT_EQ(recorder.detail(), (std::vector<Point>{first, second}));
  std::vector<Point> executed;
  for (const PathPoint& point : recorder.executed()) executed.push_back(point.at);
  EXPECT_EQ(executed, (std::vector<Point>{{0, 0, 0}, first, second}));
  EXPECT_FALSE(recorder.thinned());
  EXPECT_FALSE(recorder.speed().empty());
}

// Lists of any length go through a buffer of fixed size.
TEST(StepRecorder, WritesAsItGoes) {
  StringSink steps;
  StepRecorder::Options options;
  options.steps = &steps;
  const std::vector<double> steps_per_mm{80};
  StepRecorder recorder(options, joints(steps_per_mm));
  for (std::uint64_t i = 0; i < 20'000; ++i) recorder.pin_step({i, 0, 1});
  EXPECT_GT(steps.text.size(), 100'000U);
}

TEST(StepFork, GivesEverySinkEveryStep) {
  StepRecorder::Options options;
  const std::vector<double> steps_per_mm{80};
  StepRecorder first(options, joints(steps_per_mm));
  StringSink path_steps;
  options.path_steps = &path_steps;
  StepRecorder second(options, joints(steps_per_mm));
  StepFork fork;
  fork.add(first);
  fork.add(second);
  for (StepRecorder* recorder : {&first, &second}) recorder->command(0, line(1));
  fork.path_step({0, 50, 0, 1});
  fork.pin_step({60, 0, 1});
  second.finish();
  EXPECT_EQ(first.steps()[0], 1U);
  EXPECT_EQ(second.steps()[0], 1U);
  EXPECT_EQ(path_steps.text, "command,tick,axis,direction\n0,50,0,1\n");
}

}  // namespace
}  // namespace trammel::run
