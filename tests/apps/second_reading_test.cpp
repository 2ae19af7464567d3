// A second evaluation of the command's output, from the --steps file alone and with independent geometry. The tests
// write the G-code from a table of shapes, so they know the path without reading a program.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "command.hpp"

namespace trammel::test {
namespace {

constexpr std::size_t kAxes = 4;    // X Y Z E of the default machine
constexpr double kStepsPerMm = 80;  // of each axis
constexpr double kPi = 3.14159265358979323846;

using Place = std::array<double, kAxes>;         // mm
using Pulses = std::array<std::int64_t, kAxes>;  // pulses

// A move to `target`. `turn`: 0: a line; +1: G3, counter-clockwise; -1: G2. An arc lies in plane G17, G18 or G19. Its
// centre is `to_centre` (first and second axis of the plane, mm) from its start.
struct Shape {
  Place target{};
  int turn = 0;
  int plane = 17;
  std::array<double, 2> to_centre{};
};

Shape line(double x, double y, double z = 0, double e = 0) {
  Shape shape;
  shape.target = {x, y, z, e};
  return shape;
}

Shape arc(int turn, int plane, Place target, double first, double second) {
  Shape shape;
  shape.target = target;
  shape.turn = turn;
  shape.plane = plane;
  shape.to_centre = {first, second};
  return shape;
}

// The plane's axes, in the order in which a counter-clockwise turn leads from the first to the second.
std::array<std::size_t, 2> plane_axes(int plane) {
  if (plane == 18) return {2, 0};
  if (plane == 19) return {1, 2};
  return {0, 1};
}

Pulses rounded(const Place& place) {
  Pulses pulses{};
  for (std::size_t a = 0; a < kAxes; ++a) pulses[a] = std::llround(place[a] * kStepsPerMm);
  return pulses;
}

std::string gcode(const std::vector<Shape>& shapes, double feed) {
  std::string text = fmt::format("G21 G90 G91.1 F{:g}\n", feed);
  for (const Shape& shape : shapes) {
    const auto& t = shape.target;
    const char* motion = shape.turn == 0 ? "G1" : shape.turn > 0 ? "G3" : "G2";
    text += fmt::format("G{} {} X{:.4f} Y{:.4f} Z{:.4f} E{:.4f}", shape.plane, motion, t[0], t[1], t[2], t[3]);
    if (shape.turn != 0) {
      const auto axes = plane_axes(shape.plane);
      text += fmt::format(" {}{:.4f} {}{:.4f}", "IJK"[axes[0]], shape.to_centre[0], "IJK"[axes[1]], shape.to_centre[1]);
    }
    text += '\n';
  }
  return text + "M2\n";
}

// Follows one shape: tells how far a position is off it, and whether its end was reached.
class Walk {
 public:
  Walk(const Shape& shape, const Place& from)
      : shape_(shape), start_(rounded(from)), end_(rounded(shape.target)), axes_(plane_axes(shape.plane)) {
    for (std::size_t a = 0; a < kAxes; ++a) moving_ += start_[a] != end_[a] ? 1 : 0;
    if (shape.turn == 0) return;
    std::array<double, 2> end{};
    for (std::size_t i = 0; i < 2; ++i) {
      centre_[i] = (from[axes_[i]] + shape.to_centre[i]) * kStepsPerMm;
      end[i] = shape.target[axes_[i]] * kStepsPerMm - centre_[i];
    }
    angle_ = std::atan2(-shape.to_centre[1], -shape.to_centre[0]);
    sweep_ = shape.turn * (std::atan2(end[1], end[0]) - angle_);
    while (sweep_ <= 1e-9) sweep_ += 2 * kPi;
    start_radius_ = radius(start_);
    end_radius_ = radius(end_);
  }

  bool is_line() const { return shape_.turn == 0; }
  double bound() const { return is_line() ? std::sqrt(moving_) / 2 + 0.001 : 1.1; }
  int direction(std::size_t axis) const { return end_[axis] > start_[axis] ? 1 : end_[axis] < start_[axis] ? -1 : 0; }

  bool done(const Pulses& at) const {
    if (at != end_) return false;
    return is_line() || std::abs(swept_ - sweep_) < 0.1;
  }

  // Distance from the path in pulses. For a line: to the segment, including its ends; for an arc: to the annulus.
  double distance(const Pulses& at) {
    if (is_line()) return distance_to_line(at);
    const auto [x, y] = from_centre(at);
    const double angle = std::atan2(y, x);
    swept_ += shape_.turn * std::remainder(angle - angle_, 2 * kPi);
    angle_ = angle;
    const double r = std::hypot(x, y);
    double off = std::max({r - std::max(start_radius_, end_radius_), std::min(start_radius_, end_radius_) - r, 0.0});
    for (std::size_t a = 0; a < kAxes; ++a) {
      if (a != axes_[0] && a != axes_[1]) off += static_cast<double>(std::abs(at[a] - start_[a]));
    }
    return off;
  }

 private:
  std::array<double, 2> from_centre(const Pulses& at) const {
    return {static_cast<double>(at[axes_[0]]) - centre_[0], static_cast<double>(at[axes_[1]]) - centre_[1]};
  }
  double radius(const Pulses& at) const {
    const auto [x, y] = from_centre(at);
    return std::hypot(x, y);
  }
  double distance_to_line(const Pulses& at) const {
    double dot = 0;
    double length = 0;
    for (std::size_t a = 0; a < kAxes; ++a) {
      const auto d = static_cast<double>(end_[a] - start_[a]);
      dot += d * static_cast<double>(at[a] - start_[a]);
      length += d * d;
    }
    const double share = length > 0 ? std::clamp(dot / length, 0.0, 1.0) : 0.0;
    double square = 0;
    for (std::size_t a = 0; a < kAxes; ++a) {
      const auto d = static_cast<double>(end_[a] - start_[a]);
      square += std::pow(static_cast<double>(at[a] - start_[a]) - share * d, 2);
    }
    return std::sqrt(square);
  }

  Shape shape_;
  Pulses start_;
  Pulses end_;
  std::array<std::size_t, 2> axes_;
  int moving_ = 0;
  std::array<double, 2> centre_{};  // pulses
  double angle_ = 0;                // of the last position, radians
  double sweep_ = 0;                // angle of the whole arc, positive
  double swept_ = 0;                // angle covered so far
  double start_radius_ = 0;
  double end_radius_ = 0;
};

struct Reading {
  Pulses end{};
  Pulses counts{};
  double line = 0;  // largest distances, pulses
  double arc = 0;
  std::size_t finished = 0;  // number of shapes whose ends were reached, in order
};

// Follows the steps along the shapes. Reports each rule that a step violates.
Reading read(const std::vector<Step>& steps, const std::vector<Shape>& shapes) {
  Reading result;
  Place from{};
  std::size_t i = 0;
  std::vector<Walk> walks;
  for (const Shape& shape : shapes) {
    walks.emplace_back(shape, from);
    from = shape.target;
  }
  // A shape shorter than a pulse makes no steps.
  const auto skip_empty = [&] {
    while (result.finished < walks.size() && walks[result.finished].done(result.end)) ++result.finished;
  };
  skip_empty();
  while (i < steps.size()) {
    if (result.finished == walks.size()) {
      ADD_FAILURE() << "a step after the end, in cycle " << steps[i].cycle;
      return result;
    }
    Walk& walk = walks[result.finished];
    const std::uint64_t cycle = steps[i].cycle;
    for (; i < steps.size() && steps[i].cycle == cycle; ++i) {
      const Step& step = steps[i];
      if (step.axis >= kAxes) {
        ADD_FAILURE() << "an axis that the machine has not, in cycle " << cycle;
        return result;
      }
      result.end[step.axis] += step.direction;
      ++result.counts[step.axis];
      if (walk.is_line()) {
        EXPECT_EQ(step.direction, walk.direction(step.axis)) << "in cycle " << cycle;
      }
    }
    const double off = walk.distance(result.end);
    if (off > walk.bound()) {
      ADD_FAILURE() << "shape " << result.finished << ": " << off << " pulses off in cycle " << cycle;
      return result;
    }
    double& largest = walk.is_line() ? result.line : result.arc;
    largest = std::max(largest, off);
    if (walk.done(result.end)) ++result.finished;
    skip_empty();
  }
  return result;
}

void expect_agreement(const std::vector<Shape>& shapes, double feed, const std::string& engine) {
  const Command command;
  const std::string program = command.write("shapes.ngc", gcode(shapes, feed));
  const Outcome outcome = command.run("run " + program + " --clock 1000000 --engine " + engine + " --steps " +
                                      command.path("steps.csv") + " --json " + command.path("out.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err << contents(program);
  const nlohmann::json json = read_json(command.path("out.json"));
  const Reading reading = read(read_steps(command.path("steps.csv")), shapes);
  EXPECT_EQ(reading.finished, shapes.size()) << contents(program);
  EXPECT_EQ(reading.end, rounded(shapes.back().target));
  EXPECT_EQ(json["final_position"].get<Pulses>(), reading.end);
  EXPECT_EQ(json["steps"].get<Pulses>(), reading.counts);
  // The tool measures before the shapers. If no pulse waits for its direction, both results are equal.
  EXPECT_NEAR(json["max_deviation"]["line"].get<double>(), reading.line, 0.01);
  EXPECT_NEAR(json["max_deviation"]["arc"].get<double>(), reading.arc, 0.01);
  if (engine == "rtl") {
    EXPECT_EQ(json["lockstep_cycles"], json["cycles"]);
    EXPECT_EQ(json["mismatches"], 0);
  } else {
    EXPECT_TRUE(json["lockstep_cycles"].is_null());
  }
}

std::vector<Shape> lines() {
  return {line(3, 1),       line(1.5, 4.0625), line(-2, -1.55, 2.3), line(-2.01, 5, 2.3, 1.7),
          line(0, 0, 0, 0), line(0, 0, -3),    line(0.0063, 0.0062), line(12.34, -0.05, 1)};
}

// Starting at (5, 0): quarters, halves, three quarters and full turns in both directions, and an end that is off the
// circle by less than the rounding.
std::vector<Shape> arcs(int turn) {
  const double t = turn;
  return {line(5, 0),
          arc(turn, 17, {0, 5 * t, 0, 0}, -5, 0),
          arc(turn, 17, {-5, 0, 0, 0}, 0, -5 * t),
          arc(turn, 17, {5, 0, 0, 0}, 5, 0),
          arc(turn, 17, {5, 0, 0, 0}, -3, 0),
          arc(turn, 17, {0, -5 * t, 0, 0}, -5, 0),
          arc(turn, 17, {0, -5 * t, 0, 0}, 1.2345, -2.1),
          arc(turn, 17, {3.5355, -3.5355 * t, 0, 0}, 0, 5 * t)};
}

std::vector<Shape> other_planes(int turn) {
  const double t = turn;
  return {line(4, 0, 0),
          // G18: first axis Z, second X.
          arc(turn, 18, {0, 0, -4 * t, 0}, 0, -4), arc(turn, 18, {0, 0, -4 * t, 0}, 2.5, 1), line(0, 4, 0),
          // G19: first axis Y, second Z.
          arc(turn, 19, {0, 0, 4 * t, 0}, -4, 0), arc(turn, 19, {0, 0, 4 * t, 0}, -0.5, -1.75)};
}

TEST(SecondReading, LinesInTwoToFourAxes) { expect_agreement(lines(), 3000, "model"); }
TEST(SecondReading, ArcsCounterClockwise) { expect_agreement(arcs(1), 1500, "model"); }
TEST(SecondReading, ArcsClockwise) { expect_agreement(arcs(-1), 1500, "model"); }
TEST(SecondReading, OtherPlanesCounterClockwise) { expect_agreement(other_planes(1), 1500, "model"); }
TEST(SecondReading, OtherPlanesClockwise) { expect_agreement(other_planes(-1), 1500, "model"); }

TEST(SecondReading, RandomLines) {
  std::mt19937 random(20);
  // Targets in units of 0.0001 mm, as the program writes them.
  std::uniform_int_distribution<int> place(-60000, 60000);
  std::vector<Shape> shapes;
  for (int i = 0; i < 60; ++i) {
    Shape shape;
    for (std::size_t a = 0; a < kAxes; ++a) {
      const int previous = i == 0 ? 0 : static_cast<int>(std::lround(shapes.back().target[a] * 10000));
      shape.target[a] = (random() % 3 == 0 ? previous : place(random)) / 10000.0;
    }
    shapes.push_back(shape);
  }
  expect_agreement(shapes, 4000, "model");
}

TEST(SecondReading, VerilatedCard) {
  expect_agreement(
      {line(1, 0.4), line(2, 0, 0.5), arc(1, 17, {2, 0, 0.5, 0}, -1, 0), arc(-1, 17, {1, -1, 0.5, 0}, -1, 0)}, 3000,
      "rtl");
}

TEST(SecondReading, ExampleEndsWhereItSays) {
  const Command command;
  const Outcome outcome = command.run("run " TRAMMEL_EXAMPLES_DIR "/part.ngc --engine model --clock 1000000 --steps " +
                                      command.path("steps.csv") + " --json " + command.path("out.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  Pulses end{};
  Pulses counts{};
  for (const Step& step : read_steps(command.path("steps.csv"))) {
    end.at(step.axis) += step.direction;
    ++counts.at(step.axis);
  }
  EXPECT_EQ(end, Pulses{}) << "it ends with G28: at the home of every axis";
  const nlohmann::json json = read_json(command.path("out.json"));
  EXPECT_EQ(json["final_position"].get<Pulses>(), end);
  EXPECT_EQ(json["steps"].get<Pulses>(), counts);
}

}  // namespace
}  // namespace trammel::test
