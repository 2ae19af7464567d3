// Outputs that a program switches, on a card: they switch without a stop, and the host's count of commands stays right.
#include <gtest/gtest.h>

#include <memory>

#include "clocks.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/output_recorder.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

ProgramLines lines(const std::string& text) {
  return [text]() -> std::unique_ptr<gcode::LineSource> { return std::make_unique<gcode::TextLines>(text, "p.ngc"); };
}

class Bench {
 public:
  explicit Bench(const sim::ModelOptions& options = sim::EngineOptions{4, kSlowClock, false})
      : engine(sim::make_model_engine(options)), bus(*engine, kSlowClock, 1e9), card(driver::Card::open(bus)) {
    machine::apply_override(machine, "outputs.m3=0");
    machine::apply_override(machine, "outputs.m8=2");
    fork.add(recorder);
    engine->set_sink(&fork);
  }
  Outcome run(const std::string& text) {
    Runner runner(lines(text), machine, planner::limits_of(card.identification()));
    runner.plan();
    return runner.run(card);
  }

  machine::Machine machine = machine::default_machine();
  std::unique_ptr<sim::Engine> engine;
  sim::TimedBus bus;
  driver::Card card;
  OutputRecorder recorder;
  StepFork fork;
};

// Each pair of output words precedes a line. The program has more commands than fit in a queue.
std::string program(int lines_of_it) {
  std::string text = "F1200\n";
  for (int i = 0; i < lines_of_it; ++i)
    text += (i % 2 == 0 ? "M3 M8\nG1 X" : "M5 M9\nG1 X") + std::to_string(i + 1) + "\n";
  return text;
}

TEST(PathOutputs, AreCountedByTheHostAsTheCardDoes) {
  Bench bench;
  EXPECT_EQ(bench.run(program(300)).final_position[0], 300 * 80);
  EXPECT_EQ(bench.recorder.outputs()[0].on, 150U);
  EXPECT_EQ(bench.recorder.outputs()[0].off, 150U);
  EXPECT_EQ(bench.recorder.outputs()[2].on, 150U);
  EXPECT_FALSE(bench.recorder.outputs()[2].level);
  EXPECT_EQ(bench.recorder.outputs()[1].on, 0U);
}

// A line of 1 mm takes 50 ms at 20 mm/s. The count of commands begun tells the line at which the card is; output
// commands are not in this count.
TEST(PathOutputs, TheLineThatTheCardIsAtIsKnown) {
  Bench bench;
  bench.bus.at(std::uint64_t{kSlowClock} * 5, [&](sim::Engine&) { bench.card.request_stop(); });
  std::size_t line = 0;
  try {
    bench.run(program(300));
  } catch (const StoppedOnPath& stopped) {
    line = stopped.line();
  }
  const auto here = static_cast<std::size_t>(bench.engine->positions()[0]) / 80;  // mm; program line 2 n + 1 ends at n
  EXPECT_NEAR(static_cast<double>(line), static_cast<double>(2 * (here + 1) + 1), 1);
}

TEST(PathOutputs, StayAsTheyAreBehindAProgramWithoutItsEnd) {
  Bench bench;
  bench.run("M3\nG1 X1 F600\n");
  EXPECT_TRUE(bench.recorder.outputs()[0].level);
  bench.run("G1 X-1 F600\nM2\n");
  EXPECT_FALSE(bench.recorder.outputs()[0].level) << "M2 switches off what it finds";
}

TEST(PathOutputs, OutputsThatTheCardLacksAreRefused) {
  Bench bench;
  machine::apply_override(bench.machine, "outputs.m7=4");
  EXPECT_THROW(configure(bench.card, bench.machine), driver::ArgumentError);
  machine::apply_override(bench.machine, "outputs.m7=3");
  EXPECT_NO_THROW(configure(bench.card, bench.machine));

  sim::ModelOptions bare(sim::EngineOptions{4, kSlowClock, false});
  bare.engines = card_map::engines::kLines | card_map::engines::kArcGenerator | card_map::engines::kJerk |
                 card_map::engines::kUnderrunHold;
  Bench without(bare);
  try {
    without.run("G1 X1 F600\nM3\n");
    ADD_FAILURE() << "it has no path commands";
  } catch (const ProgramError& error) {
    EXPECT_EQ(error.error().code, gcode::ErrorCode::kNoOutput);
  }
  EXPECT_EQ(without.engine->positions()[0], 0) << "nothing has moved";
  EXPECT_EQ(without.run("M5\nG1 X1 F600\nM2\n").final_position[0], 80);
}

}  // namespace
}  // namespace trammel::run
