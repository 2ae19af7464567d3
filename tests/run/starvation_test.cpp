// A card that gets its commands too late, or no more commands: it holds on the path and continues by itself. If the
// host has died, it stays where it is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "clocks.hpp"
#include "dying_bus.hpp"
#include "steps.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

// A circle of radius 10 mm at 20 mm/s. With 3000 chords of 0.02 mm each line takes 1 ms, and a stop, which is 3 mm
// long, exceeds the largest stop distance, a quarter of the full queues. With 1000 chords it does not.
constexpr int kChords = 3000;
constexpr int kLongChords = 1000;

std::string circle(int chords) {
  std::string text = "F1200\n";
  for (int i = 1; i <= chords; ++i) {
    const double angle = i * 2 * 3.141592653589793 / chords;
    text += fmt::format("G1 X{:.5f} Y{:.5f}\n", 10 - 10 * std::cos(angle), 10 * std::sin(angle));
  }
  return text;
}

// Makes the host pause for `seconds` at every `every`-th block.
class Stalls final : public Observer {
 public:
  Stalls(sim::Engine& engine, std::uint64_t every, double seconds)
      : engine_(engine), every_(every), seconds_(seconds) {}
  void sending(const planner::PlannedBlock& /*block*/) override {
    if (++blocks_ % every_ == 0) engine_.wait(static_cast<std::uint64_t>(seconds_ * kClock));
  }

 private:
  sim::Engine& engine_;
  std::uint64_t every_;
  double seconds_;
  std::uint64_t blocks_ = 0;
};

class StarvationTest : public testing::Test {
 protected:
  struct Made {
    std::string identity;
    std::uint32_t under_runs = 0;
    std::uint64_t cycles = 0;
  };
  StarvationTest() {
    machine::apply_override(machine_, "motion.window=256");
    machine::apply_override(machine_, "motion.junction_deviation=0.05");
    fork_.add(steps_);
    fork_.add(identity_);
    engine_->set_sink(&fork_);
  }
  static ProgramLines lines(const std::string& program) {
    return [text = std::make_shared<const std::string>(program)]() -> std::unique_ptr<gcode::LineSource> {
      return std::make_unique<gcode::TextLines>(*text, "p.ngc");
    };
  }
  Made run(driver::Bus& bus, Observer* observer = nullptr, const std::string& program = circle(kChords)) {
    driver::Card card = driver::Card::open(bus);
    Runner runner(lines(program), machine_, planner::limits_of(card.identification()));
    if (observer != nullptr) runner.add(*observer);
    runner.plan();
    const Outcome outcome = runner.run(card);
    EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{0, 0, 0, 0}));
    EXPECT_TRUE(outcome.under_runs);
    return {identity_.text(), outcome.under_runs.value_or(0), engine_->cycles()};
  }
  // The host dies in mid path. The card comes to rest on the path, and another program continues from there. `made`:
  // the number of steps up to that rest.
  void die(int chords, std::size_t& made);
  static Made plain() {
    class Fresh final : public StarvationTest {
     public:
      void TestBody() override {}
      Made made() { return run(*engine_); }
    };
    return Fresh().made();
  }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  test::Steps steps_;
  PathIdentity identity_;
  StepFork fork_;
};

TEST_F(StarvationTest, SlowBus) {
  const Made whole = plain();
  EXPECT_EQ(whole.under_runs, 0U);
  sim::TimedBus bus(*engine_, kClock, 8000);
  const Made starved = run(bus);
  EXPECT_EQ(starved.identity, whole.identity);
  EXPECT_GT(starved.under_runs, 0U);
  EXPECT_GT(starved.cycles, whole.cycles * 3 / 2);
}

// Each line runs from rest to rest and is shorter than a stop from its speed may be. While a line runs, the pieces of
// the next line arrive before its path. The card must not hold because of commands behind a stop.
TEST_F(StarvationTest, LinesThatEndAtRestAreNotStarvedByThoseBehindThem) {
  std::string program = "G61.1\nF3000\n";
  for (int i = 0; i < 20; ++i) program += "G1 X1\nX0\n";
  EXPECT_EQ(run(*engine_, nullptr, program).under_runs, 0U);
}

TEST_F(StarvationTest, HostThatStalls) {
  const Made whole = plain();
  Stalls stalls(*engine_, 700, 2);
  const Made stalled = run(*engine_, &stalls);
  EXPECT_EQ(stalled.identity, whole.identity);
  EXPECT_GE(stalled.under_runs, 2U);
  EXPECT_GT(stalled.cycles, whole.cycles + 2 * kClock);
}

void StarvationTest::die(int chords, std::size_t& made) {
  class Fresh final : public StarvationTest {
   public:
    void TestBody() override {}
    std::vector<driver::PathStep> path(int chords) {
      run(*engine_, nullptr, circle(chords));
      return steps_.path;
    }
  };
  const std::vector<driver::PathStep> whole = Fresh().path(chords);
  DyingBus bus(*engine_, kClock * 3 / 2);
  EXPECT_THROW(run(bus, nullptr, circle(chords)), RunError);
  engine_->wait(std::uint64_t{20} * kClock);
  made = steps_.path.size();
  ASSERT_GT(made, 300U);
  ASSERT_LT(made, whole.size());
  for (std::size_t i = 0; i < made; ++i) {
    ASSERT_TRUE(steps_.path[i].tick == whole[i].tick && steps_.path[i].command == whole[i].command &&
                steps_.path[i].axis == whole[i].axis && steps_.path[i].direction == whole[i].direction)
        << i;
  }
  EXPECT_EQ(steps_.pins.size(), made);
  EXPECT_EQ(engine_->read(card_map::reg::kFault), 0U);
  EXPECT_EQ(engine_->read(card_map::reg::kUnderruns), 1U);
  EXPECT_NE(engine_->read(card_map::reg::kStatus) & card_map::field::kStatusUnderrun, 0U) << "held by it still";
  // Another program opens the card: the position is known, and a program continues from there.
  driver::Card card = driver::Card::open(*engine_);
  card.stop();
  EXPECT_EQ(steps_.path.size(), made);
  RunSettings there;
  const std::vector<std::int64_t> here = engine_->positions();
  for (std::size_t a = 0; a < 4; ++a) there.start[a] = static_cast<double>(here[a]) / 80;
  Runner home([] { return std::make_unique<gcode::TextLines>("G0 X0 Y0\n", "p.ngc"); }, machine_,
              planner::limits_of(card.identification()), there);
  home.plan();
  home.run(card);
  EXPECT_EQ(engine_->positions(), (std::vector<std::int64_t>{0, 0, 0, 0}));
}

TEST_F(StarvationTest, HostThatDiesInTheMiddle) {
  std::size_t made = 0;
  ASSERT_NO_FATAL_FAILURE(die(kLongChords, made));
  // A ramp: the last pulses are farther apart than those in the constant phase, by more than the changing direction on
  // the circle causes.
  const std::uint64_t last_tenth = steps_.pins[made - 1].cycle - steps_.pins[made - 11].cycle;
  const std::uint64_t before = steps_.pins[made - 700].cycle - steps_.pins[made - 710].cycle;
  EXPECT_GT(last_tenth, 2 * before);
}

// The queues may run dry before the card is at rest. The path and the known position are right all the same.
TEST_F(StarvationTest, HostThatDiesWhereAStopIsLongerThanTheQueues) {
  std::size_t made = 0;
  ASSERT_NO_FATAL_FAILURE(die(kChords, made));
}

}  // namespace
}  // namespace trammel::run
