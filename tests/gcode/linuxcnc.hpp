// Runs programs in LinuxCNC's own interpreter, rs274, for tests. Compares its canonical motions with the motions of the
// reader, in machine coordinates.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode::linuxcnc {

constexpr double kMmPerInch = 25.4;
// Tolerance, mm. rs274 prints coordinates and offsets with four decimals, of an inch; two offsets add to a coordinate.
constexpr double kPrinted = 0.008;

struct Canonical {
  MotionKind kind = MotionKind::kTraverse;
  std::array<double, 3> end{};     // mm, machine coordinates
  std::array<double, 2> centre{};  // mm, machine coordinates, in the plane's order
  bool clockwise = false;
  int turns = 0;    // turns that the arc begins
  double feed = 0;  // mm/min
  double seconds = 0;
};

// Runs a command and returns its output.
inline std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  ::pclose(pipe);
  return text;
}

// Skips its tests if rs274 is missing. If TRAMMEL_REQUIRE_LINUXCNC is set, the tests fail instead.
class LinuxcncTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!output_of("command -v rs274 2>/dev/null").empty()) return;
    constexpr const char* kMissing = "rs274 is not installed: scripts/setup --linuxcnc installs LinuxCNC";
    if (std::getenv("TRAMMEL_REQUIRE_LINUXCNC") != nullptr) FAIL() << kMissing;
    GTEST_SKIP() << kMissing;
  }
};

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "trammel-rs274-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string write(const char* name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// The numbers between the brackets of a canonical call.
inline std::vector<double> arguments_of(const std::string& call) {
  std::vector<double> numbers;
  const char* at = call.c_str() + call.find('(') + 1;
  while (*at != '\0') {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at) {
      ++at;
    } else {
      numbers.push_back(number);
      at = end;
    }
  }
  return numbers;
}

// Converts canonical calls to motions in machine coordinates.
class Canon {
 public:
  std::vector<Canonical> steps;
  bool ended = false;

  void call(const std::string& text) {
    const std::string name = text.substr(0, text.find('('));
    const std::vector<double> a = arguments_of(text);
    if (name == "USE_LENGTH_UNITS") unit_ = text.find("INCHES") != std::string::npos ? kMmPerInch : 1;
    if (name == "SET_G5X_OFFSET") set(system_, a, 1);
    if (name == "SET_G92_OFFSET") set(shift_, a, 0);
    if (name == "USE_TOOL_LENGTH_OFFSET") set(tool_, a, 0);
    if (name == "SELECT_PLANE")
      plane_ = text.find("XY") != std::string::npos ? 0 : text.find("XZ") != std::string::npos ? 1 : 2;
    if (name == "SET_FEED_RATE") feed_ = a[0] * unit_;
    if (name == "STRAIGHT_TRAVERSE") go(MotionKind::kTraverse, a);
    if (name == "STRAIGHT_FEED") go(MotionKind::kLine, a);
    if (name == "STRAIGHT_PROBE") go(MotionKind::kProbe, a);
    if (name == "ARC_FEED") arc(a);
    if (name == "DWELL") {
      Canonical& step = steps.emplace_back();
      step.kind = MotionKind::kDwell;
      step.end = here_;
      step.seconds = a[0];
    }
    if (name == "PROGRAM_END") ended = true;
  }

 private:
  using Place = std::array<double, 3>;
  void set(Place& place, const std::vector<double>& a, std::size_t first) {
    for (std::size_t i = 0; i < 3; ++i) place[i] = a[first + i] * unit_;
  }
  double machine(std::size_t axis, double value) const {
    return value * unit_ + system_[axis] + shift_[axis] + tool_[axis];
  }
  Canonical& arrive(MotionKind kind, const Place& end) {
    Canonical& step = steps.emplace_back();
    step.kind = kind;
    step.end = here_ = end;
    step.feed = kind == MotionKind::kTraverse ? 0 : feed_;
    return step;
  }
  void go(MotionKind kind, const std::vector<double>& a) {
    arrive(kind, {machine(0, a[0]), machine(1, a[1]), machine(2, a[2])});
  }
  // Arguments of ARC_FEED: end and centre in the plane's order, turns (above 0: counter-clockwise), end on the third
  // axis.
  void arc(const std::vector<double>& a) {
    constexpr std::size_t kAxes[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    const auto& axes = kAxes[plane_];
    Place end{};
    end[axes[0]] = machine(axes[0], a[0]);
    end[axes[1]] = machine(axes[1], a[1]);
    end[axes[2]] = machine(axes[2], a[5]);
    Canonical& step = arrive(MotionKind::kArc, end);
    step.centre = {machine(axes[0], a[2]), machine(axes[1], a[3])};
    step.clockwise = a[4] < 0;
    step.turns = static_cast<int>(std::abs(a[4]));
  }

  double unit_ = 1;
  double feed_ = 0;
  std::size_t plane_ = 0;
  Place system_{};
  Place shift_{};
  Place tool_{};
  Place here_{};
};

// Removes motions without length and dwells of 0 s. Arcs stay, because a full circle ends at its start.
inline std::vector<Canonical> without_stills(const std::vector<Canonical>& steps) {
  std::vector<Canonical> moving;
  std::array<double, 3> here{};
  for (const Canonical& step : steps) {
    double way = 0;
    for (std::size_t i = 0; i < 3; ++i) way = std::max(way, std::abs(step.end[i] - here[i]));
    const bool still = step.kind == MotionKind::kDwell ? step.seconds == 0 : way < kPrinted;
    if (!still || step.kind == MotionKind::kArc) moving.push_back(step);
    here = step.end;
  }
  return moving;
}

inline machine::Machine make_machine() {
  machine::Machine machine = machine::default_machine();
  machine.tools.push_back({1, {0, 0, 12.5}});
  machine.tools.push_back({2, {0, 0, 20}});
  machine.probe.input = 0;
  return machine;
}

inline std::vector<Canonical> read_by_linuxcnc(const std::string& text, bool& ended) {
  const Folder folder;
  const std::string program = folder.write("program.ngc", text);
  const std::string variables = folder.write("program.var", "");
  // The machine of rs274 is in inches.
  const std::string tools = folder.write(
      "tool.tbl", fmt::format("T1 P1 Z{:.10f} D0.1\nT2 P2 Z{:.10f} D0.1\n", 12.5 / kMmPerInch, 20 / kMmPerInch));
  // rs274 writes its tool table into HOME. Tests that run in parallel must not share this directory.
  const std::string printed = output_of(
      fmt::format("HOME='{}' rs274 -g -t '{}' -v '{}' '{}' 2>/dev/null", folder.path(), tools, variables, program));
  Canon canon;
  for (std::size_t at = 0; at < printed.size();) {
    const std::size_t end = std::min(printed.find('\n', at), printed.size());
    const std::string line = printed.substr(at, end - at);
    const std::size_t number = line.find(" N");  // line number, in seven columns
    if (number != std::string::npos && line.size() > number + 8) canon.call(line.substr(number + 8));
    at = end + 1;
  }
  ended = canon.ended;
  return without_stills(canon.steps);
}

inline std::vector<Canonical> read_by_trammel(const std::string& text, std::string& error) {
  const machine::Machine machine = make_machine();
  TextLines lines(text, "p.ngc");
  Reader reader(lines, machine);
  std::vector<Canonical> steps;
  for (Motion motion; reader.next(motion);) {
    if (motion.kind == MotionKind::kEnd) break;
    Canonical& step = steps.emplace_back();
    step.kind = motion.kind;
    step.end = {motion.target[0], motion.target[1], motion.target[2]};
    step.feed = motion.feed * 60;
    step.seconds = motion.kind == MotionKind::kDwell ? motion.seconds : 0;
    if (motion.kind == MotionKind::kArc) {
      step.centre = {motion.centre_x, motion.centre_y};
      step.clockwise = motion.clockwise;
      step.turns = static_cast<int>(motion.turns) + 1;
    }
    if (reader.awaits_probe()) reader.assume_probed();
  }
  if (reader.error()) error = describe(*reader.error());
  return without_stills(steps);
}

inline void expect_same(const std::vector<Canonical>& ours, const std::vector<Canonical>& theirs) {
  EXPECT_EQ(ours.size(), theirs.size());
  ASSERT_GT(ours.size(), 0U);
  for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i) {
    SCOPED_TRACE(fmt::format("motion {}", i));
    ASSERT_EQ(ours[i].kind, theirs[i].kind);
    for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(ours[i].end[axis], theirs[i].end[axis], kPrinted) << axis;
    EXPECT_NEAR(ours[i].feed, theirs[i].feed, 0.01);
    EXPECT_NEAR(ours[i].seconds, theirs[i].seconds, 1e-4);
    EXPECT_EQ(ours[i].clockwise, theirs[i].clockwise);
    EXPECT_EQ(ours[i].turns, theirs[i].turns);
    for (std::size_t axis = 0; axis < 2; ++axis) EXPECT_NEAR(ours[i].centre[axis], theirs[i].centre[axis], kPrinted);
  }
}

// Applies `simplify` to both lists before the comparison.
template <class Simplify>
void expect_same(const std::string& text, Simplify simplify) {
  bool ended = false;
  std::string error;
  const std::vector<Canonical> theirs = read_by_linuxcnc(text, ended);
  const std::vector<Canonical> ours = read_by_trammel(text, error);
  ASSERT_TRUE(ended) << "rs274 refuses the program";
  ASSERT_EQ(error, "");
  expect_same(simplify(ours), simplify(theirs));
}

inline void expect_same(const std::string& text) {
  expect_same(text, [](const std::vector<Canonical>& steps) { return steps; });
}

}  // namespace trammel::gcode::linuxcnc
