// Runs that are stopped anywhere and continued: the steps before and after the stop together are those of the
// undisturbed run.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "clocks.hpp"
#include "dying_bus.hpp"
#include "steps.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/run/interrupted.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

// Numbers the counted commands of a run within the whole program, so that steps of several runs can be compared.
class CountedCommands final : public Observer {
 public:
  explicit CountedCommands(std::uint64_t first) : next_(first) {}
  void command(std::uint64_t /*number*/, const driver::Command& command) override {
    const bool counts = !std::holds_alternative<driver::FeedCommand>(command) && driver::counts_as_begun(command);
    numbers_.push_back(counts ? next_++ : 0);
  }
  std::uint64_t of(std::uint64_t number) const { return numbers_.at(number); }

 private:
  std::uint64_t next_;
  std::vector<std::uint64_t> numbers_;
};

// Number of the program's counted command, tick, axis, direction.
using ResumedStep = std::tuple<std::uint64_t, std::uint64_t, unsigned, int>;

struct ResumeCase {
  const char* name;
  planner::ArcsBy arcs;
  const char* entry;  // override of the machine file
};

constexpr char kResumeProgram[] =
    "F3000\nM3\nG1 X4 Y1.5\nG2 X6 Y3.5 I2\nG4 P0.1\nM8\nG1 X1 Y4.3 Z0.7\nG3 X1 Y4.3 J-1.5\nG0 X9\nG3 X8 Y3 R2 Z0.1 "
    "F900\nM5\nG0 X0 Y0 Z0\n";

// A card that is used by several runs of one program.
class ResumeBench {
 public:
  explicit ResumeBench(const ResumeCase& variant, std::uint64_t last_cycle = ~std::uint64_t{0})
      : dying_(*engine, last_cycle) {
    engine->set_sink(&made_);
    machine::apply_override(machine_, "outputs.m3=0");
    machine::apply_override(machine_, "outputs.m8=2");
    if (*variant.entry != 0) machine::apply_override(machine_, variant.entry);
    settings_.arcs = variant.arcs;
  }
  // Start of the next run. Without these calls it runs the whole program.
  void from(const RunSettings::Place& place) { settings_.place = place; }
  void from_line(std::size_t line) { settings_.first_line = line; }

  // Calls `opened` with the card before anything moves. Collects the steps also when the run ends with an exception.
  template <class BusOfRun, class Opened>
  void run(BusOfRun& bus, std::chrono::milliseconds watchdog, Opened opened) {
    driver::Card card = driver::Card::open(bus);
    opened(card);
    Runner runner = runner_of(kResumeProgram, card, settings_);
    begin_ = begin_of(settings_, runner.plan());
    CountedCommands counted(begin_.first);
    runner.add(counted);
    const driver::WatchdogScope scope(card, watchdog);
    try {
      runner.run(card);
    } catch (...) {
      take(counted);
      throw;
    }
    take(counted);
  }
  void run() {
    run(*engine, std::chrono::milliseconds(0), [](driver::Card&) {});
  }
  // Runs until the host dies. The card then stops by itself.
  void run_and_die() {
    EXPECT_THROW(run(dying_, std::chrono::milliseconds(300), [](driver::Card&) {}), RunError);
    engine->wait(4 * kSlowClock);
    driver::Card card = driver::Card::open(*engine);
    EXPECT_NE(card.read_faults(), 0U);
    card.clear_faults();
  }
  void run_and_stop(std::uint64_t cycle) {
    sim::TimedBus bus(*engine, kSlowClock, 1e9);
    const auto stop_at_cycle = [&](driver::Card& card) {
      bus.at(cycle, [&card](sim::Engine&) { card.request_stop(); });
    };
    EXPECT_THROW(run(bus, std::chrono::milliseconds(0), stop_at_cycle), StoppedOnPath);
  }
  RunSettings::Place place() {
    driver::Card card = driver::Card::open(*engine);
    const std::optional<RunSettings::Place> place = place_of(begin_, card.read_rest());
    if (!place) throw std::runtime_error("the place is not known");
    return *place;
  }
  // Moves away and back, as an operator does.
  void jog_away_and_back() {
    driver::Card card = driver::Card::open(*engine);
    Runner away = runner_of("G91 G1 X2 F3000\nX-2\n", card, {});
    away.plan();
    away.run(card);
    made_.path.clear();
  }
  const std::vector<ResumedStep>& steps() const { return steps_; }

  std::unique_ptr<sim::Engine> engine = sim::make_model_engine(sim::EngineOptions{4, kSlowClock, false});

 private:
  Runner runner_of(const char* text, const driver::Card& card, const RunSettings& settings) const {
    return {[text] { return std::make_unique<gcode::TextLines>(text, "p.ngc"); }, machine_,
            planner::limits_of(card.identification()), settings};
  }
  void take(const CountedCommands& counted) {
    engine->wait(4 * kSlowClock);  // the card may still be on the ramp of its own stop
    for (const driver::PathStep& step : made_.path) {
      steps_.emplace_back(counted.of(step.command), step.tick, step.axis, step.direction);
    }
    made_.path.clear();
  }

  machine::Machine machine_ = machine::default_machine();
  RunSettings settings_;
  DyingBus dying_;
  test::Steps made_;
  std::vector<ResumedStep> steps_;
  RunBegin begin_;
};

class Resume : public ::testing::TestWithParam<ResumeCase> {
 protected:
  Resume() {
    whole_.run();
    end_ = whole_.engine->cycles() - 4 * kSlowClock;
  }

  ResumeBench whole_{GetParam()};  // the undisturbed run
  std::uint64_t end_ = 0;          // end of its motion, clocks
};

// Each run is stopped at another place, continued, and stopped again.
TEST_P(Resume, StopsOnRequestAndGoesOnWithTheSameSteps) {
  for (std::uint64_t part = 1; part < 12; ++part) {
    SCOPED_TRACE(part);
    ResumeBench bench(GetParam());
    bench.run_and_stop(end_ * part / 13);
    const std::size_t before = bench.steps().size();
    ASSERT_LT(before, whole_.steps().size());
    const RunSettings::Place place = bench.place();
    if (part % 3 == 0) bench.jog_away_and_back();
    bench.from(place);
    if (part % 2 == 0) {
      bench.run_and_stop(bench.engine->cycles() + end_ / 13);
      bench.from(bench.place());
    }
    bench.run();
    ASSERT_TRUE(bench.steps() == whole_.steps())
        << before << " steps before, " << bench.steps().size() << " in all, " << whole_.steps().size() << " wanted";
    EXPECT_EQ(bench.engine->positions(), whole_.engine->positions());
  }
}

TEST_P(Resume, OutlivesTheHost) {
  for (std::uint64_t part = 2; part < 9; part += 3) {
    SCOPED_TRACE(part);
    ResumeBench bench(GetParam(), end_ * part / 13);
    bench.run_and_die();
    ASSERT_LT(bench.steps().size(), whole_.steps().size());
    bench.from(bench.place());
    bench.run();
    ASSERT_TRUE(bench.steps() == whole_.steps());
    EXPECT_EQ(bench.engine->read(card_map::reg::kUnderruns), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, Resume,
                         ::testing::Values(ResumeCase{"generator", planner::ArcsBy::kGenerator, ""},
                                           ResumeCase{"accumulator", planner::ArcsBy::kAccumulator, ""},
                                           ResumeCase{"eight_directions", planner::ArcsBy::kEightDirections, ""},
                                           ResumeCase{"conics", planner::ArcsBy::kAccumulator,
                                                      "axis.y.steps_per_mm=128"},
                                           ResumeCase{"chords", planner::ArcsBy::kChords, ""}),
                         [](const auto& variant) { return variant.param.name; });

constexpr ResumeCase kByGenerator{"generator", planner::ArcsBy::kGenerator, ""};

// A place that is not on the path, as when something else has moved the card since the stop: REST then belongs to a
// later stop.
TEST(PlaceOfARun, IsRefusedWhereTheMachineWasNotOnThePath) {
  ResumeBench bench(kByGenerator);
  RunSettings::Place place;  // the start of the first line
  place.position[0] = 1;
  bench.from(place);
  EXPECT_THROW(bench.run(), ProgramError);
  place.position[0] = 0;
  place.path.ticks_left = 1000;
  bench.from(place);
  EXPECT_THROW(bench.run(), ProgramError) << "all but 1000 ticks are some pulses";
  place.path.ticks_left = PathPlace::kAllTicks;
  bench.from(place);
  bench.run();
  EXPECT_EQ(bench.engine->positions()[0], 0);
  EXPECT_FALSE(bench.steps().empty());
}

// A run from each line on makes the whole run's steps of that line and of all later lines.
TEST(FromLine, TheStepsOfTheUndisturbedRun) {
  ResumeBench whole(kByGenerator);
  whole.run();
  for (std::size_t line = 2; line <= 12; ++line) {
    SCOPED_TRACE(line);
    ResumeBench bench(kByGenerator);
    bench.from_line(line);
    bench.run();
    ASSERT_LE(bench.steps().size(), whole.steps().size());
    ASSERT_FALSE(bench.steps().empty());
    const auto from = whole.steps().end() - static_cast<std::ptrdiff_t>(bench.steps().size());
    EXPECT_TRUE(std::equal(from, whole.steps().end(), bench.steps().begin()));
    if (line <= 3) {
      EXPECT_EQ(bench.steps().size(), whole.steps().size());
    }
  }
}

}  // namespace
}  // namespace trammel::run
