// A laser whose power follows the speed must burn evenly. The test counts the energy in each mm of a path with corners,
// holds and overrides at the output's pin of the simulated card, and compares it with the programmed energy. The same
// program at constant power burns a mm with a hold at more than twice the energy.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "trammel/driver/trigonometry.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

constexpr std::uint32_t kLaserClock = 100'000'000;
constexpr double kLaserStepsPerMm = 400;  // of X and Y
constexpr double kLaserFeed = 25;         // mm/s
constexpr double kLaserPower = 0.6;       // fraction of the maximum S
constexpr unsigned kLaserOutput = 1;

// Distance along the path, in mm, of a position of X and Y. It is called for each step, in order.
using PathLength = std::function<double(double x, double y)>;

// For lines along X or Y: the sum of the steps' lengths.
PathLength along_axes() {
  return [x_before = 0.0, y_before = 0.0, length = 0.0](double x, double y) mutable {
    length += std::abs(x - x_before) + std::abs(y - y_before);
    x_before = x;
    y_before = y;
    return length;
  };
}

// For a line from (0, 0): the projection of the position on the line.
PathLength along_line(double x_end, double y_end) {
  const double length = std::hypot(x_end, y_end);
  return [=](double x, double y) { return (x * x_end + y * y_end) / length; };
}

// For a counterclockwise circle from (0, 0) around (radius, 0), less than 4/3 turns.
PathLength along_circle(double radius) {
  return [=, most = 0.0](double x, double y) mutable {
    double angle = std::atan2(-y, radius - x);
    if (angle < -1e-2 || (most > 2 && angle < 2)) angle += 2 * driver::kPi;
    most = std::max(most, angle);
    return angle * radius;
  };
}

// Counts the clocks with the laser on in each mm of the path. A mm begins with the first step at or after its start,
// and ends with the first step at or after its end.
class EnergyMeter final : public driver::StepSink {
 public:
  explicit EnergyMeter(PathLength length) : length_(std::move(length)) {}
  void pin_step(const driver::PinStep& step) override {
    if (step.axis > 1) return;
    account(step.cycle);
    steps_.at(step.axis) += step.direction;
    if (length_(steps_[0] / kLaserStepsPerMm, steps_[1] / kLaserStepsPerMm) < mm_) return;
    if (mm_ != 0) lit_.push_back(in_mm_);
    in_mm_ = 0;
    ++mm_;
  }
  void path_step(const driver::PathStep& /*step*/) override {}
  void outputs_changed(const driver::OutputChange& change) override {
    account(change.cycle);
    on_ = (change.levels >> kLaserOutput & 1U) != 0;
    edges_ += (change.changed >> kLaserOutput & 1U) != 0 ? 1 : 0;
  }
  const std::vector<double>& lit() const { return lit_; }
  std::uint64_t edges() const { return edges_; }
  bool on() const { return on_; }
  // All clocks with the laser on so far, including those outside of the counted mm.
  double all() const { return all_; }

 private:
  void account(std::uint64_t cycle) {
    if (on_) in_mm_ += static_cast<double>(cycle - at_);
    if (on_) all_ += static_cast<double>(cycle - at_);
    at_ = cycle;
  }

  PathLength length_;
  std::array<double, 2> steps_{};
  double mm_ = 0;
  std::vector<double> lit_;
  double in_mm_ = 0;
  double all_ = 0;
  std::uint64_t at_ = 0;
  std::uint64_t edges_ = 0;
  bool on_ = false;
};

// Program lines of a cut, and the function that measures along its path.
struct Cut {
  std::string lines;
  std::function<PathLength()> length;
};

// Right angles, a reversal, and lines shorter than 1 mm.
Cut corners() {
  std::string lines = "G1 X12\nG1 Y8\nX4\nY3\nX10\nX6\nY5\n";
  for (int i = 0; i < 12; ++i) lines += (i % 2 == 0 ? "G91 X0.5\n" : "G91 Y0.25\n");
  return {lines + "G90 G1 X30\nG1 Y20\n", along_axes};
}

// A diagonal of lines of 5 mm, one command each.
Cut diagonal() {
  std::string lines;
  for (int i = 1; i <= 13; ++i) lines += fmt::format("G1 X{} Y{}\n", 4 * i, 3 * i);
  return {lines, [] { return along_line(4, 3); }};
}

Cut circle() {
  return {"G3 X0 Y0 I10 J0\n", [] { return along_circle(10); }};
}

std::string laser_program(const char* spindle, const Cut& cut) {
  return fmt::format("G0 X0 Y0\n{} S600 F1500\n{}M5\nM2\n", spindle, cut.lines);
}

struct Burnt {
  double least = 1e9;  // smallest and largest energy of a mm, as fractions of the programmed energy
  double most = 0;
  std::size_t mm = 0;
  std::uint64_t edges = 0;
  bool on = false;
};

// Runs a cut; `disturbed`: with holds and overrides while the card moves.
Burnt burn(const char* spindle, const Cut& cut, bool disturbed) {
  machine::Machine machine = machine::default_machine();
  for (const char axis : {'x', 'y'})
    machine::apply_override(machine, fmt::format("axis.{}.steps_per_mm={}", axis, kLaserStepsPerMm));
  machine::apply_override(machine, "spindle.output=1");
  machine::apply_override(machine, "spindle.pwm_hz=10000");
  machine::apply_override(machine, "spindle.laser=true");
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, kLaserClock, false});
  sim::TimedBus bus(*engine, kLaserClock, 1e9);
  driver::Card card = driver::Card::open(bus);
  configure(card, machine);
  EnergyMeter meter(cut.length());
  engine->set_sink(&meter);
  const auto at = [&](double seconds, std::uint32_t address, std::uint32_t data) {
    bus.at(static_cast<std::uint64_t>(seconds * kLaserClock), [=](sim::Engine& e) { e.write(address, data); });
  };
  namespace reg = card_map::reg;
  if (disturbed) {
    at(0.3, reg::kHold, 1);
    at(0.5, reg::kHold, 0);
    at(0.9, reg::kRatioFeed, 0x8000);
    at(1.4, reg::kRatioFeed, 0x4000);
    at(1.9, reg::kRatioFeed, 0x10000);
    at(2.1, reg::kHold, 1);
    at(2.2, reg::kHold, 0);
  }
  const std::string text = laser_program(spindle, cut);
  const auto lines = [&text]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<gcode::TextLines>(text, "laser.ngc");
  };
  Runner runner(lines, machine, planner::limits_of(card.identification()));
  runner.plan();
  runner.run(card);
  Burnt burnt;
  const double programmed = kLaserPower * kLaserClock / kLaserFeed;  // clocks with the laser on per mm
  for (const double lit : meter.lit()) {
    burnt.least = std::min(burnt.least, lit / programmed);
    burnt.most = std::max(burnt.most, lit / programmed);
  }
  burnt.mm = meter.lit().size();
  burnt.edges = meter.edges();
  burnt.on = meter.on();
  return burnt;
}

void print_burnt(const char* what, const Burnt& b) {
  std::printf("%-34s %3zu mm: %.4f to %.4f of the programmed energy in each\n", what, b.mm, b.least, b.most);
}

class LaserEnergy : public testing::TestWithParam<std::pair<const char*, Cut (*)()>> {};

TEST_P(LaserEnergy, IsThatOfTheProgramInEachMillimetre) {
  const Cut cut = GetParam().second();
  const Burnt calm = burn("M4", cut, false);
  const Burnt disturbed = burn("M4", cut, true);
  const Burnt constant = burn("M3", cut, true);
  print_burnt("M4", calm);
  print_burnt("M4, holds and overrides", disturbed);
  print_burnt("M3, holds and overrides", constant);
  EXPECT_GT(calm.mm, 60U);
  EXPECT_GT(calm.edges, 40'000U);
  for (const Burnt& b : {calm, disturbed}) {
    EXPECT_GT(b.least, 0.99);
    EXPECT_LT(b.most, 1.01);
    EXPECT_FALSE(b.on);
  }
  EXPECT_GT(constant.most, 2) << "a mm with a hold in it";
  EXPECT_FALSE(constant.on);
}

INSTANTIATE_TEST_SUITE_P(Paths, LaserEnergy,
                         testing::Values(std::pair{"corners", &corners}, std::pair{"diagonal", &diagonal},
                                         std::pair{"circle", &circle}),
                         [](const auto& cut) { return std::string(cut.param.first); });

}  // namespace
}  // namespace trammel::run
