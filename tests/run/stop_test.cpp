// A run that is stopped on its path, and the next program, which starts there.
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "clocks.hpp"
#include "steps.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/run/machine_position.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

constexpr char kStopProgram[] =
    "F3000\nG1 X8 Y3\nG2 X12 Y7 I4\nG4 P0.1\nG1 X2 Y9.3 Z1.7\nG3 X2 Y9.3 J-3\nG1 X30\nG0 X0 Y0 Z0\n";

// A card on its own bus, for several programs one after another.
class StopBench {
 public:
  StopBench() { engine->set_sink(&steps); }

  ProgramLines lines(const std::string& text) {
    return [text = std::make_shared<const std::string>(text)]() -> std::unique_ptr<gcode::LineSource> {
      return std::make_unique<gcode::TextLines>(*text, "p.ngc");
    };
  }
  Outcome run(const std::string& text, const RunSettings& settings = {}) {
    Runner runner(lines(text), machine, planner::limits_of(card.identification()), settings);
    runner.plan();
    return runner.run(card);
  }

  machine::Machine machine = machine::default_machine();
  std::unique_ptr<sim::Engine> engine = sim::make_model_engine(sim::EngineOptions{4, kSlowClock, false});
  sim::TimedBus bus{*engine, kSlowClock, 1e9};
  driver::Card card = driver::Card::open(bus);
  test::Steps steps;
};

bool same(const driver::PathStep& a, const driver::PathStep& b) {
  return a.command == b.command && a.tick == b.tick && a.axis == b.axis && a.direction == b.direction;
}

TEST(Stop, OnThePathWithThePositionKnownAndTheNextProgramFromThere) {
  StopBench whole;
  whole.run(kStopProgram);
  const double end = static_cast<double>(whole.steps.pins.back().cycle) / kSlowClock;
  // The last ramp is excluded, because a stop does not shorten it.
  for (double at = 0.03; at < end - 0.2; at += 0.0617) {
    SCOPED_TRACE(at);
    StopBench bench;
    MachinePosition position(bench.card.read_snapshot(), bench.machine);
    const auto due = static_cast<std::uint64_t>(at * kSlowClock);
    bench.bus.at(due, [&](sim::Engine&) { bench.card.request_stop(); });
    std::optional<std::size_t> line;
    planner::Pulses told{};
    try {
      bench.run(kStopProgram);
    } catch (const StoppedOnPath& stopped) {
      line = stopped.line();
      told = stopped.position();
    }
    ASSERT_TRUE(line);
    const std::size_t made = bench.steps.path.size();
    ASSERT_LT(made, whole.steps.path.size());
    for (std::size_t i = 0; i < made; ++i) ASSERT_TRUE(same(bench.steps.path[i], whole.steps.path[i])) << i;
    EXPECT_EQ(bench.steps.pins.size(), made) << "every step of the path came out, and none after it";
    EXPECT_TRUE(bench.card.in_position());
    EXPECT_FALSE(bench.card.read_status().held) << "the hold is over, or soon will be";
    // A ramp from full speed takes 0.3 s. At 50 of 150 mm/s the slew is doubled, and the ramp takes half of that.
    EXPECT_LE(
        static_cast<double>(bench.steps.pins.back().cycle - std::min(due, bench.steps.pins.back().cycle)) / kSlowClock,
        0.32);
    position.look(bench.card.read_snapshot());
    planner::Pulses counted{};
    for (const driver::PinStep& step : bench.steps.pins) counted[step.axis] += step.direction;
    EXPECT_EQ(position.pulses(), counted);
    EXPECT_EQ(told, counted);

    RunSettings there;
    there.start = position.millimetres();
    const Outcome outcome = bench.run("G91 G1 X1 F600\nG90 Y5\nG0 X0 Y0 Z0\n", there);
    EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{0, 0, 0, 0}));
    position.look(bench.card.read_snapshot());
    EXPECT_EQ(position.pulses(), planner::Pulses{}) << "as the card counts";
  }
}

TEST(Stop, TellsTheLineThatTheCardWasAt) {
  StopBench bench;
  bench.bus.at(std::uint64_t{7} * kSlowClock / 2, [&](sim::Engine&) { bench.card.request_stop(); });
  try {
    bench.run("F600\nG1 X10\nY10\nX20\nY20\nX30\n");  // each line takes a second
    FAIL() << "not stopped";
  } catch (const StoppedOnPath& stopped) {
    EXPECT_EQ(stopped.line(), 5U);
  }
}

// Lines of one pulse each, with a dwell between them. They do not fill the queue, as if the source were slower than the
// card.
class PausingLines final : public gcode::LineSource {
 public:
  PausingLines(driver::Card& card, unsigned& read) : card_(card), read_(read) {}
  const std::string& name() const override { return name_; }
  bool next(std::string_view& line) override {
    if (read_ == 100) return false;
    if (++read_ == 50) card_.request_stop();
    line = read_ % 2 == 0 ? "G4 P0.001" : "G91 G1 X0.0125 F600";
    return true;
  }

 private:
  std::string name_ = "slow.ngc";
  driver::Card& card_;
  unsigned& read_;
};

TEST(Stop, WhileLinesComeSlowly) {
  StopBench bench;
  unsigned read = 0;
  Runner runner([&] { return std::make_unique<PausingLines>(bench.card, read); }, bench.machine,
                planner::limits_of(bench.card.identification()));
  EXPECT_THROW(runner.stream(bench.card), StoppedOnPath);
  EXPECT_LT(read, 60U) << "it was not looked for before the end";
}

// Requests a stop before the card has received any command: while a window of blocks is read, or when its last line has
// been read. (SCurvePlan.CallsBeforeEachRamp tests a stop while a window is planned.)
class WindowOfLines final : public gcode::LineSource {
 public:
  WindowOfLines(driver::Card& card, unsigned stop_at, unsigned& read) : card_(card), stop_at_(stop_at), read_(read) {}
  const std::string& name() const override { return name_; }
  bool next(std::string_view& line) override {
    if (++read_ == stop_at_) card_.request_stop();
    line = read_ % 2 == 0 ? "G91 G1 X0.1 F600" : "G91 G1 X0.1 F900";
    return read_ <= kWindow;
  }

  static constexpr unsigned kWindow = 1000;

 private:
  std::string name_ = "window.ngc";
  driver::Card& card_;
  unsigned stop_at_;
  unsigned& read_;
};

class SentNothing final : public Observer {
 public:
  void sending(const planner::PlannedBlock& block) override { ADD_FAILURE() << "line " << block.block.line; }
};

TEST(Stop, WhileAWindowIsPlanned) {
  for (const unsigned stop_at : {100U, WindowOfLines::kWindow + 1}) {
    SCOPED_TRACE(stop_at);
    StopBench bench;
    machine::apply_override(bench.machine, "motion.window=2000");
    for (machine::MachineAxis& axis : bench.machine.axes) axis.max_jerk = 10'000;
    unsigned read = 0;
    Runner runner([&] { return std::make_unique<WindowOfLines>(bench.card, stop_at, read); }, bench.machine,
                  planner::limits_of(bench.card.identification()));
    SentNothing observer;
    runner.add(observer);
    try {
      runner.stream(bench.card);
      ADD_FAILURE() << "not stopped";
    } catch (const StoppedOnPath& stopped) {
      EXPECT_EQ(stopped.line(), 0U);
      EXPECT_EQ(std::string(stopped.what()).find("window.ngc: before the first command: "), 0U) << stopped.what();
    }
    EXPECT_LE(read, stop_at + 1);
    EXPECT_TRUE(bench.steps.pins.empty());
  }
}

// Stops in a dwell, in a hold, and when nothing runs.
TEST(Stop, AtRest) {
  StopBench bench;
  bench.bus.at(kSlowClock / 2, [&](sim::Engine&) { bench.card.request_stop(); });
  EXPECT_THROW(bench.run("G4 P100\nG0 X1\n"), StoppedOnPath);
  EXPECT_TRUE(bench.steps.pins.empty());
  bench.card.set_hold(true);
  bench.bus.at(bench.engine->cycles() + kSlowClock, [&](sim::Engine&) { bench.card.request_stop(); });
  EXPECT_THROW(bench.run("G0 X1\n"), StoppedOnPath);
  EXPECT_TRUE(bench.steps.pins.empty());
  bench.card.stop();
  EXPECT_EQ(bench.run("G0 X1\n").final_position[0], 80);
}

// The timeout follows from the ramp of 0.3 s from full ratio. A ramp at the slowest slew would take 45 minutes at this
// clock.
TEST(Stop, GivesUpWhereTheRampDoesNotEnd) {
  StopBench bench;
  bench.card.set_longest_step_wait(std::chrono::milliseconds(1));
  driver::Stream stream(bench.card);
  bench.card.set_slew_time(std::chrono::milliseconds(300));
  stream.send(driver::FeedCommand{std::uint64_t{1} << 39, std::uint64_t{1} << 60, 0, 0, 1, 0});
  stream.send(driver::LineCommand{std::uint64_t{1} << 39, 1, {std::int64_t{1} << 34}});
  const std::uint64_t before = bench.engine->cycles();
  // Another program releases the hold again and again.
  for (unsigned i = 1; i < 3000; ++i) {
    bench.bus.at(before + i * 400, [](sim::Engine& engine) { engine.write(card_map::reg::kHold, 0); });
  }
  EXPECT_THROW(bench.card.stop(std::chrono::milliseconds(200)), driver::TimeoutError);
}

TEST(MachinePosition, IsSetByTheHostAndFollowsTheCardThroughItsWrap) {
  const machine::Machine machine = machine::default_machine();
  driver::Snapshot card;
  card.position[0] = 2'147'483'600;
  MachinePosition position(card, machine);
  EXPECT_EQ(position.pulses(), planner::Pulses{});
  position.set(0, -12.5);
  position.set(1, 3.00625);  // 240.5 pulses
  EXPECT_EQ(position.pulses()[0], -1000);
  EXPECT_EQ(position.pulses()[1], 241);
  card.position[0] = -2'147'483'596;  // 100 pulses further, across the wrap
  card.position[1] = -41;
  position.look(card);
  EXPECT_EQ(position.pulses()[0], -900);
  EXPECT_DOUBLE_EQ(position.millimetres()[0], -11.25);
  EXPECT_DOUBLE_EQ(position.millimetres()[1], 2.5);
}

}  // namespace
}  // namespace trammel::run
