// Outputs that a program switches and inputs that the run's options set, at the pins of both engines.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "command.hpp"

namespace trammel::test {
namespace {

constexpr double kClock = 1e6;

// A row of --outputs.
struct Change {
  std::uint64_t cycle = 0;
  unsigned output = 0;
  int level = 0;
};

std::vector<Change> read_changes(const std::string& file) {
  std::vector<Change> changes;
  std::istringstream rows(contents(file));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "cycle,output,level");
  while (std::getline(rows, row)) {
    Change change;
    char comma = 0;
    std::istringstream(row) >> change.cycle >> comma >> change.output >> comma >> change.level;
    changes.push_back(change);
  }
  return changes;
}

class PathIo : public testing::Test {
 protected:
  // Runs on both engines, whose results must be equal.
  nlohmann::json run(const std::string& program, const std::string& options) {
    for (const std::string engine : {"model", "rtl"}) {
      const std::string file = command_.path(engine);
      const Outcome outcome =
          command_.run("run " + program + " --clock 1000000 --engine " + engine + " " + options + " --json " +
                       command_.path("j") + " --outputs " + file + " --steps " + file + ".s");
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      summary_ = outcome.out;
    }
    EXPECT_EQ(contents(command_.path("model")), contents(command_.path("rtl")));
    EXPECT_EQ(contents(command_.path("model.s")), contents(command_.path("rtl.s")));
    changes_ = read_changes(command_.path("rtl"));
    steps_ = read_steps(command_.path("rtl.s"));
    return read_json(command_.path("j"));
  }
  // Position of X in pulses when an output changes, with the fraction (0 .. 1) of the time to the next pulse.
  double place_of(const Change& change) const {
    double pulses = 0;
    std::uint64_t before = 0;
    for (const Step& step : steps_) {
      if (step.axis != 0) continue;
      if (step.cycle > change.cycle) {
        return pulses + static_cast<double>(change.cycle - before) / static_cast<double>(step.cycle - before);
      }
      pulses += step.direction;
      before = step.cycle;
    }
    return pulses;
  }

  Command command_;
  std::string summary_;
  std::vector<Change> changes_;
  std::vector<Step> steps_;
};

constexpr char kOutputs[] = "--set outputs.m3=0 --set 'outputs.m4=[0,1]' --set outputs.m8=3";

// The last tick of a path comes half a pulse after its last step.
TEST_F(PathIo, OutputsChangeAtTheirPlaceOnThePathWithoutAStop) {
  const std::string words =
      command_.write("a.ngc", "F1200\nS1000 M3\nG1 X10\nM8\nG1 X20\nX30 M4\nM5\nX40\nM9\nX50 M3\nM2\n");
  const std::string plain = command_.write("b.ngc", "F1200\nG1 X10\nG1 X20\nX30\nX40\nX50\nM2\n");
  const nlohmann::json without = run(plain, kOutputs);
  const std::vector<Step> steps = steps_;
  const nlohmann::json with = run(words, kOutputs);
  struct Expected {
    unsigned output;
    int level;
    double mm;
  };
  // M4 sets output 0, which is set already. M5 clears both.
  const std::vector<Expected> expected{{0, 1, 0},  {3, 1, 10}, {1, 1, 20}, {0, 0, 30},
                                       {1, 0, 30}, {0, 1, 40}, {3, 0, 40}, {0, 0, 50}};
  ASSERT_EQ(changes_.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(changes_[i].output, expected[i].output);
    EXPECT_EQ(changes_[i].level, expected[i].level);
    const bool in_motion = expected[i].mm > 0 && expected[i].mm < 50;
    EXPECT_NEAR(place_of(changes_[i]), expected[i].mm * 80 + (in_motion ? 0.5 : 0), in_motion ? 0.03 : 0.5);
  }
  EXPECT_LT(changes_.front().cycle, steps_.front().cycle) << "before the first pulse";
  EXPECT_GT(changes_.back().cycle, steps_.back().cycle) << "off behind the last one";
  // The pulses are those of the program without output words. All are later by the same time, because more is sent
  // before the first.
  ASSERT_EQ(steps_.size(), steps.size());
  const std::uint64_t later = steps_.front().cycle - steps.front().cycle;
  EXPECT_LT(later, 200U);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    ASSERT_LE(steps_[i].cycle - steps[i].cycle, later + 20) << i;
    ASSERT_GE(steps_[i].cycle - steps[i].cycle + 20, later) << i;
  }
  EXPECT_EQ(with["motion"]["stops"], 1);
  EXPECT_EQ(without["outputs"][0]["on"], 0);
  EXPECT_EQ(
      with["outputs"].dump(),
      R"([{"level":0,"off":2,"on":2,"output":0,"words":["M3","M4"]},)"
      R"({"level":0,"off":1,"on":1,"output":1,"words":["M4"]},{"level":0,"off":1,"on":1,"output":3,"words":["M8"]}])");
  EXPECT_NE(summary_.find("output 0 (M3, M4): switched on 2 times, off 2 times, off at the end\n"), std::string::npos)
      << summary_;
  EXPECT_NE(summary_.find("no output for it in [spindle] of the machine file: S (1)\n"), std::string::npos) << summary_;
}

// S of [spindle] on the card that the command simulates: 500 of 1000 is half of each period, 1000 the whole.
TEST_F(PathIo, TheSpindlesPulsesFollowS) {
  const std::string program = command_.write("a.ngc", "F1200\nM3 S500\nG1 X10\nS1000\nX20\nM5\nX30\n");
  const nlohmann::json with = run(program, "--set spindle.output=2");
  ASSERT_GT(changes_.size(), 900U);
  std::uint64_t high[2] = {0, 0};  // clocks, in the two parts of the path
  std::uint64_t clocks[2] = {0, 0};
  for (std::size_t i = 0; i + 1 < changes_.size(); ++i) {
    ASSERT_EQ(changes_[i].output, 2U);
    const std::uint64_t time = changes_[i + 1].cycle - changes_[i].cycle;
    const std::size_t part = i + 2 < changes_.size() ? 0 : 1;  // at full width the output does not change
    clocks[part] += time;
    if (changes_[i].level != 0) high[part] += time;
  }
  EXPECT_NEAR(static_cast<double>(high[0]) / static_cast<double>(clocks[0]), 0.5, 0.002);
  EXPECT_EQ(high[1], clocks[1]);
  EXPECT_NEAR(static_cast<double>(clocks[1]), 0.5 * kClock, 0.03 * kClock) << "10 mm at 20 mm/s";
  EXPECT_EQ(changes_.back().level, 0) << "M5";
  EXPECT_EQ(with["outputs"][0]["words"], nlohmann::json({"S"}));
  EXPECT_NE(summary_.find("output 2 (S): switched on "), std::string::npos) << summary_;
  EXPECT_EQ(summary_.find("no output for it"), std::string::npos) << summary_;
}

TEST_F(PathIo, AStartInTheMiddleRestoresOutputs) {
  const std::string program = command_.write("a.ngc", "F1200\nM3\nG1 X10\nM8\nX20\nM9\nX30\n");
  run(program, std::string(kOutputs) + " --from-line 5");
  ASSERT_EQ(changes_.size(), 3U);
  EXPECT_EQ(changes_[0].output, 0U);
  EXPECT_EQ(changes_[1].output, 3U);
  EXPECT_EQ(changes_[0].cycle, changes_[1].cycle);
  EXPECT_LT(changes_[0].cycle, steps_.front().cycle);
  EXPECT_NEAR(place_of(changes_[2]), 10 * 80 + 0.5, 0.03) << "M9 behind the first of its lines";
}

TEST_F(PathIo, OutputsThatTheCardLacksAreBadInput) {
  const std::string program = command_.write("a.ngc", "G1 X1 F600\nM7\nX2\n");
  const Outcome outcome = command_.run("run " + program + " --engine model --set outputs.m7=4");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("a.ngc:2: output 4 of the machine file: the card has 4"), std::string::npos)
      << outcome.err;
}

TEST_F(PathIo, InputsAreScripted) {
  const std::string program = command_.write("a.ngc", "G1 X2 F1200\n");
  const nlohmann::json made = run(program, "--input-at 0.05:3:1 --input-at 0.02:1:1 --input-at 0.06:1:0");
  ASSERT_EQ(made["events"].size(), 3U);
  const std::vector<std::vector<double>> expected{{0.02, 1, 1}, {0.05, 3, 1}, {0.06, 1, 0}};
  for (std::size_t i = 0; i < 3; ++i) {
    const nlohmann::json& event = made["events"][i];
    EXPECT_EQ(event["event"], "input");
    EXPECT_EQ(event["input"], expected[i][1]);
    EXPECT_EQ(event["level"], expected[i][2]);
    EXPECT_GE(event["cycle"], expected[i][0] * kClock);
    EXPECT_LE(event["cycle"], expected[i][0] * kClock + 20);
  }
  EXPECT_EQ(made["inputs"], 8) << "as the card's INPUTS has them";
  EXPECT_TRUE(run(program, "")["inputs"].is_null());
  for (const auto& [text, message] : std::map<std::string, std::string>{
           {"1:2", "SECONDS:INPUT:LEVEL"},
           {"0.5", "SECONDS:INPUT:LEVEL"},
           {"x:1:1", "x is not a time"},
           {"-1:1:1", "-1 is not a time"},
           {"1:16:1", "16 is not an input of the simulated card (0 to 15"},
           {"1:-1:1", "-1 is not an input"},
           {"1:0.5:1", "0.5 is not an input"},
           {"1:1:2", "2 is not a level (0 or 1)"},
           {"1:1:", " is not a level"},
           {"1:1:1:1", "1:1 is not a level"},
       }) {
    const Outcome outcome = command_.run("run " + program + " --engine model --input-at=" + text);
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << text << ": " << outcome.err;
  }
}

// Rapids have 150 mm/s, feeds 20 mm/s.
TEST_F(PathIo, RapidsHaveAnOverrideOfTheirOwn) {
  const std::string program = command_.write("a.ngc", "G0 X60\nG1 X50 F1200\n");
  // Speed of X, mm/s, over the middle half of the pulses from `first` to `last`.
  const auto speed = [&](std::size_t first, std::size_t last) {
    const std::size_t quarter = (last - first) / 4;
    const double clocks = static_cast<double>(steps_[last - quarter].cycle - steps_[first + quarter].cycle);
    return static_cast<double>(last - first - 2 * quarter) / 80 / (clocks / kClock);
  };
  struct Case {
    std::string options;
    double rapid;
    double feed;
  };
  for (const auto& [options, rapid, feed] : std::vector<Case>{{"", 150, 20},
                                                              {"--rapid-override 25", 37.5, 20},
                                                              {"--override 50", 150, 10},
                                                              {"--override 50 --rapid-override 25", 37.5, 10}}) {
    run(program, options);
    EXPECT_NEAR(speed(0, 4800), rapid, rapid * 0.02) << options;
    EXPECT_NEAR(speed(4800, 5599), feed, feed * 0.02) << options;
  }
  const auto refused = [&](const std::string& options, const std::string& message) {
    const Outcome outcome = command_.run("run " + program + " --engine model " + options);
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << options << ": " << outcome.err;
  };
  refused("--rapid-override 101", "--rapid-override: 101 is not an override from 0 to 100 percent");
  refused("--rapid-override=-1", "-1 is not an override");
  refused("--rapid-override fast", "fast is not an override");
  refused("--rapid-override nan", "nan is not an override");
  refused("--rapid-override 0", "would never finish, because it has 1 rapids");
  refused("--rapid-override 0 --stream", "needs the whole program before the run");
  EXPECT_EQ(
      command_.run("run " + command_.write("b.ngc", "G1 X1 F600\n") + " --engine model --rapid-override 0").status, 0);
}

}  // namespace
}  // namespace trammel::test
