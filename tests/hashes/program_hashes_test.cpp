// The steps of whole programs against hashes recorded from an earlier card: the same path steps, and for programs
// without arcs the same times at the pins except for the constants below. The hashes are recorded again only on
// request:
// TRAMMEL_WRITE_HASHES=tests/data/program_hashes.json build/release/bin/test_hashes [--gtest_filter=...]
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <regex>
#include <string>
#include <utility>

#include "step_hashes.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::test {
namespace {

using nlohmann::json;

// Clocks by which this card is later than the recorded one: at the first step, and additionally at each barrier.
constexpr Shift kShift = {3, 1};

constexpr const char* kHashes = TRAMMEL_HASHES_FILE;

struct Job {
  std::string folder;
  std::string program;
  sim::EngineKind engine;
  std::string set;                            // override of the machine, or empty
  std::optional<std::uint32_t> engines = {};  // kModel: mask of the engines if they differ from those of the usual card
};

// For the names of the tests.
void PrintTo(const Job& job, std::ostream* out) { *out << job.program; }

bool is_model(const Job& job) { return job.engine == sim::EngineKind::kModel; }

// Ends of the programs, computed from their text, in pulses at 80 steps/mm.
const std::map<std::string, std::vector<std::int64_t>> kEnds = {
    // Z ends 2 mm above the last layer, 35.4 mm; E is the sum over all G92 E0: 2644.55913 mm.
    {"octocat.gcode", {400, 400, 2992, 211565}},
    {"extruder.ngc", {0, 0, 160, 320}},
    {"dwells.ngc", {0, 0, 0, 80}},
};

// Passes the commands of a run to the hasher.
class Watch final : public run::Observer {
 public:
  Watch(StepHasher& hasher, const sim::Engine& engine) : hasher_(hasher), engine_(engine) {}
  void sending(const planner::PlannedBlock& planned) override {
    const planner::Geometry geometry = planned.block.geometry;
    hasher_.block(geometry == planner::Geometry::kChords ? StepHasher::Path::kChords
                  : geometry == planner::Geometry::kArc  ? StepHasher::Path::kArc
                                                         : StepHasher::Path::kNoArc);
  }
  void command(std::uint64_t /*number*/, const driver::Command& command) override { hasher_.command(command); }
  void sent() override { hasher_.sent(engine_.cycles()); }

 private:
  StepHasher& hasher_;
  const sim::Engine& engine_;
};

struct Outcome {
  StepHashes hashes;
  double largest_line_deviation = 0;
  std::vector<std::int64_t> final_position;
  std::optional<std::uint64_t> lockstep_cycles;
};

Outcome run(const Job& job, Shift shift = kShift) {
  machine::Machine machine = machine::default_machine();
  if (!job.set.empty()) machine::apply_override(machine, job.set);
  sim::SimulationOptions options;
  options.kind = job.engine;
  options.clock_hz = is_model(job) ? 100'000'000 : 1'000'000;
  sim::ModelOptions model(options);
  model.engines = job.engines;
  const std::unique_ptr<sim::Engine> engine = job.engines ? sim::make_model_engine(model) : sim::make_engine(options);
  StepHasher hasher(shift);
  run::StepRecorder recorder({}, kinematics::Kinematics::in_pulses(machine.axes.size()));
  Watch watch(hasher, *engine);
  run::StepFork steps;
  steps.add(recorder);
  steps.add(hasher);
  engine->set_sink(&steps);
  driver::Card card = driver::Card::open(*engine);
  const std::string file = job.folder + "/" + job.program;
  run::Runner runner([&] { return std::make_unique<gcode::FileLines>(file); }, machine,
                     planner::limits_of(card.identification()));
  runner.add(recorder);
  runner.add(watch);
  runner.plan();
  const run::Outcome outcome = runner.run(card);
  recorder.finish();
  recorder.check(outcome.counted);
  return {hasher.finish(), recorder.deviation().largest_line(), outcome.final_position, engine->lockstep_cycles()};
}

StepHashes hashes_of(const Job& job, Shift shift = kShift) { return run(job, shift).hashes; }

std::string key(const Job& job) { return job.set.empty() ? job.program : job.program + " " + job.set; }

json to_json(const StepHashes& hashes) {
  json result;
  result["path"] = fmt::format("{:016x}", hashes.path);
  result["path_steps"] = hashes.path_steps;
  result["barriers"] = hashes.barriers;
  if (hashes.pins) {
    result["pins"] = fmt::format("{:016x}", *hashes.pins);
    result["start"] = hashes.start;
  }
  return result;
}

json read_hashes(const std::string& file) {
  std::ifstream in(file);
  return in ? json::parse(in) : json::object();
}

class Programs : public testing::TestWithParam<Job> {};

TEST_P(Programs, MakeTheRecordedSteps) {
  const Job& job = GetParam();
  const std::string engine = is_model(job) ? "model, 100 MHz" : "rtl, 1 MHz";
  const Outcome outcome = run(job);
  const StepHashes& hashes = outcome.hashes;
  EXPECT_LE(outcome.largest_line_deviation, std::sqrt(outcome.final_position.size()) / 2 + 0.001);
  if (const auto end = kEnds.find(job.program); end != kEnds.end()) {
    EXPECT_EQ(outcome.final_position, end->second);
  }
  EXPECT_EQ(outcome.lockstep_cycles.has_value(), !is_model(job));
  EXPECT_GT(hashes.path_steps, 600U);
  if (hashes.pins) {
    ASSERT_TRUE(hashes.lead);
    EXPECT_GT(*hashes.lead, 0) << "a path waited for the host: its times hang on those of the bus";
    RecordProperty("lead", std::to_string(*hashes.lead));
  }
  if (const char* file = std::getenv("TRAMMEL_WRITE_HASHES")) {
    json all = read_hashes(file);
    all[engine][key(job)] = to_json(hashes);
    std::ofstream(file) << all.dump(2) << "\n";
    GTEST_SKIP() << "recorded, not compared";
  }
  const json recorded = read_hashes(kHashes);
  ASSERT_TRUE(recorded.contains(engine) && recorded[engine].contains(key(job))) << kHashes;
  EXPECT_EQ(to_json(hashes), recorded[engine][key(job)]);
}

std::string run_name(const testing::TestParamInfo<Job>& info) {
  std::string name = key(info.param).substr(0, key(info.param).find('.')) + (is_model(info.param) ? "_model" : "_rtl");
  if (!info.param.set.empty()) name += "_unequal";
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

std::vector<Job> runs_of(const std::string& folder, const std::vector<std::string>& programs,
                         const std::vector<sim::EngineKind>& engines, const std::string& set = "") {
  std::vector<Job> runs;
  for (const sim::EngineKind engine : engines) {
    for (const std::string& program : programs) runs.push_back({folder, program, engine, set});
  }
  return runs;
}

const std::vector<sim::EngineKind> kBoth = {sim::EngineKind::kModel, sim::EngineKind::kRtl};
const std::vector<sim::EngineKind> kModelOnly = {sim::EngineKind::kModel};
const std::string kExamples = TRAMMEL_EXAMPLES_DIR;
const std::string kData = TRAMMEL_DATA_DIR;

INSTANTIATE_TEST_SUITE_P(Examples, Programs,
                         testing::ValuesIn(runs_of(kExamples, {"extruder.ngc", "inch.ngc", "part.ngc", "relative.ngc"},
                                                   kBoth)),
                         run_name);
INSTANTIATE_TEST_SUITE_P(Dwells, Programs, testing::ValuesIn(runs_of(kData, {"dwells.ngc"}, kBoth)), run_name);
// With other steps/mm for Y, the circles of the XY plane are sent as chords.
INSTANTIATE_TEST_SUITE_P(Chords, Programs,
                         testing::ValuesIn(runs_of(kExamples, {"relative.ngc", "inch.ngc"}, kBoth,
                                                   "axis.y.steps_per_mm=100")),
                         run_name);
#ifdef TRAMMEL_SHARED_GCODE_DIR
INSTANTIATE_TEST_SUITE_P(Shared, Programs,
                         testing::ValuesIn(runs_of(TRAMMEL_SHARED_GCODE_DIR,
                                                   {"arc-xz-plane.gcode", "arc-yz-plane.gcode", "circle-inch.gcode",
                                                    "g2-arc.gcode", "jsdc-laser.gcode", "octocat.gcode", "tball.gcode"},
                                                   kModelOnly)),
                         run_name);
#endif

// Changes that must change the hashes of a run.

// The program with every match of each expression replaced.
using Replacements = std::vector<std::pair<const char*, const char*>>;
StepHashes hashes_of_changed(const Job& job, const Replacements& replacements, Shift shift = kShift) {
  std::ifstream in(job.folder + "/" + job.program);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const auto& [from, to] : replacements) {
    const std::string changed = std::regex_replace(text, std::regex(from), to);
    EXPECT_NE(changed, text) << from;
    text = changed;
  }
  Job other = job;
  other.folder = testing::TempDir();
  other.program = fmt::format("changed_{}", ::getpid());
  const std::string file = other.folder + "/" + other.program;
  std::ofstream(file) << text;
  StepHashes hashes = hashes_of(other, shift);
  std::remove(file.c_str());
  return hashes;
}

class Changes : public testing::Test {
 protected:
  const Job job_{kExamples, "extruder.ngc", sim::EngineKind::kModel, ""};
  const StepHashes card_ = hashes_of(job_);
};

TEST_F(Changes, OfOnePulseShow) {
  const StepHashes other = hashes_of_changed(job_, {{"E5\n", "E5.0125\n"}});
  EXPECT_EQ(other.path_steps, card_.path_steps + 1);
  EXPECT_NE(other.path, card_.path);
  EXPECT_NE(other.pins, card_.pins);
}

TEST_F(Changes, OfOneClockOfOneAxisShowAtThePinsOnly) {
  // 101 clocks instead of 100.
  const StepHashes other =
      hashes_of({kExamples, "extruder.ngc", sim::EngineKind::kModel, "axis.x.direction_setup_ns=1010"});
  EXPECT_EQ(other.path, card_.path);
  EXPECT_NE(other.pins, card_.pins);
}

TEST_F(Changes, OfTheFeedShowAtThePins) {
  const StepHashes other = hashes_of_changed(job_, {{"F1200", "F1201"}});
  EXPECT_NE(other.pins, card_.pins);
}

TEST_F(Changes, OfTheStartShowInTheStartAlone) {
  const StepHashes other = hashes_of(job_, {kShift.start + 3, kShift.barrier});
  EXPECT_EQ(other.pins, card_.pins);
  EXPECT_EQ(other.start, card_.start - 3);
}

// Uses a card without the under-run hold, because with it a motion from rest waits for queues that fill as fast as the
// bus allows.
class BarrierShift : public testing::Test {
 protected:
  const Job job_{kData, "dwells.ngc", sim::EngineKind::kModel, "",
                 card_map::engines::kLines | card_map::engines::kJerk};
  const StepHashes card_ = hashes_of(job_, {0, 0});
};

TEST_F(BarrierShift, IsTakenOffOnceABarrier) {
  const StepHashes shifted = hashes_of(job_, {0, 1});
  EXPECT_EQ(card_.barriers, 6U) << "five dwells and the end";
  EXPECT_EQ(shifted.path, card_.path);
  EXPECT_EQ(shifted.start, card_.start - 1) << "one dwell lies before the first step";
  EXPECT_NE(shifted.pins, card_.pins);
}

// Every dwell is one clock (10 ns) longer, as on a card that takes one more clock at each barrier. A dwell of 0 clocks
// is not used, because it takes as long as a dwell of 1 clock.
TEST_F(BarrierShift, CancelsAClockMoreADwell) {
  const std::pair<const char*, const char*> none_of_0 = {"P0.0000000", "P0.0000500"};
  const std::pair<const char*, const char*> longer = {"G4 P0.[0-9]{6}0", "$&1"};
  const StepHashes base = hashes_of_changed(job_, {none_of_0}, {0, 0});
  const StepHashes shifted = hashes_of_changed(job_, {none_of_0, longer}, {0, 1});
  EXPECT_EQ(shifted.pins, base.pins);
  EXPECT_EQ(shifted.start, base.start);
  EXPECT_NE(hashes_of_changed(job_, {none_of_0, longer}, {0, 0}).pins, base.pins);
}

}  // namespace
}  // namespace trammel::test
