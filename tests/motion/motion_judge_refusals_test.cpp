// The judge of motion must detect motion that breaks the limits.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "judged_program.hpp"

namespace trammel::test {
namespace {

// Judges motion by other limits than those it was planned for.
class MotionJudgeSaysNo : public testing::Test {
 protected:
  static MotionVerdict judged(const std::string& program, const machine::Machine& planned,
                              const machine::Machine& judged) {
    Program run(text(program), planned);
    return judge_motion(run.recorder().commands, {judged, kClock, 0.01});
  }
  const std::string square_ = "G21 G90 G94 F6000\nG1 X20\nY20\nX0\nY0\nM2\n";
};

TEST_F(MotionJudgeSaysNo, ToSpeedAboveAnAxissLimit) {
  EXPECT_GT(judged(square_, machine_of(100, 1000, 0), machine_of(98, 1000, 0)).velocity.share, 1.001);
}

TEST_F(MotionJudgeSaysNo, ToAccelerationAboveAnAxissLimit) {
  EXPECT_GT(judged(square_, machine_of(100, 1000, 0), machine_of(100, 950, 0)).acceleration.share, 1.04);
}

TEST_F(MotionJudgeSaysNo, ToATrapezoidWhereJerkIsLimited) {
  const MotionVerdict verdict = judged(square_, machine_of(100, 1000, 0), machine_of(100, 1000, 20000));
  EXPECT_GT(verdict.acceleration_jump.share, 0.5);
  EXPECT_GT(verdict.rest.share, 1.01);
}

// A planner that ignores the acceleration of curves: it plans for a machine with ten times the acceleration.
TEST_F(MotionJudgeSaysNo, ToArcsThatAreTooFast) {
  const std::string circle = "G21 G90 G94 F6000\nG2 X0 Y0 I5 J0\nM2\n";
  EXPECT_GT(judged(circle, machine_of(100, 10000, 0), machine_of(100, 1000, 0)).acceleration.share, 1.5);
}

TEST_F(MotionJudgeSaysNo, ToCornersThatAreTooFast) {
  EXPECT_GT(judged(random_lines(1), machine_of(100, 10000, 0), machine_of(100, 1000, 0)).corner.share, 1.5);
}

TEST_F(MotionJudgeSaysNo, ToARateThatJumps) {
  Program run(text(square_), machine_of(100, 1000, 0));
  for (driver::Command& command : run.recorder().commands) {
    auto* piece = std::get_if<driver::FeedCommand>(&command);
    if (piece != nullptr && piece->acceleration == 0) piece->rate -= piece->rate / 100;
  }
  EXPECT_GT(run.verdict().rate_jump.share, 1.5);
}

// At a change of ticks per mm: from X alone to X with 4 times as much E, above the floor.
TEST_F(MotionJudgeSaysNo, ToARateThatJumpsWhereTheDensityChanges) {
  const machine::Machine machine = machine_of(100, 1000, 0);
  gcode::TextLines lines("G21 G90 G94 F600\nG1 X40\nG1 X80 E-160\nG1 X120\nM2\n", "program");
  Planned planned(lines, machine, 10 * kClock);
  const auto judged = [&] { return judge_motion(planned.commands, {machine, 10 * kClock, 0.01}).rate_jump.share; };
  ASSERT_LE(judged(), 1);
  std::vector<driver::FeedCommand*> begins;  // first piece of each line
  bool begin = true;
  for (driver::Command& command : planned.commands) {
    auto* piece = std::get_if<driver::FeedCommand>(&command);
    if (piece != nullptr && begin) begins.push_back(piece);
    begin = piece == nullptr;
  }
  ASSERT_EQ(begins.size(), 3U);
  for (const std::size_t line : {1U, 2U}) {
    const std::uint64_t right = begins[line]->rate;
    begins[line]->rate = right / 50 * 51;
    EXPECT_GT(judged(), 1.5) << line;
    begins[line]->rate = right;
  }
}

TEST_F(MotionJudgeSaysNo, ToAStreamOfWhichAPieceIsMissing) {
  Program run(text(square_), machine_of(100, 1000, 0));
  auto& commands = run.recorder().commands;
  commands.erase(commands.begin());
  EXPECT_THROW(static_cast<void>(run.verdict()), std::runtime_error);
}

TEST_F(MotionJudgeSaysNo, ToStepsThatAreLateMissingOrTooMany) {
  Program run(text("G21 G90 G94 F6000\nG1 X20 Y7\nG2 X20 Y7 I4 J1\nG1 X0 Y0\nM2\n"), machine_of(100, 1000, 0));
  std::vector<TimedStep>& steps = run.recorder().steps;
  ASSERT_LE(run.farthest(), 0.8);
  const std::vector<TimedStep> right = steps;
  for (std::size_t i = steps.size() / 3; i < steps.size(); ++i) steps[i].cycle += 60;  // half a pulse at 8,000 per s
  EXPECT_GT(run.farthest(), 0.8);
  steps = right;
  steps.erase(steps.begin() + 500);
  EXPECT_GT(run.farthest(), 0.8);
  steps = right;
  steps.push_back(steps.back());
  EXPECT_GT(run.farthest(), 0.8);
}

}  // namespace
}  // namespace trammel::test
