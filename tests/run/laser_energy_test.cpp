// A laser whose power follows the speed burns evenly: the energy in each mm of a path with corners, holds and
// overrides, counted at the output's pin of the simulated card, against the programmed one; and the same program at
// constant power.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

constexpr std::uint32_t kLaserClock = 100'000'000;
constexpr double kLaserStepsPerMm = 80;  // of X and Y
constexpr double kLaserFeed = 25;        // mm/s
constexpr double kLaserPower = 0.6;      // of S at most
constexpr unsigned kLaserOutput = 1;

// Lit clocks between the steps that begin each mm of the path. Lines along X or Y alone: each step is 1/80 mm of path.
class EnergyMeter final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& step) override {
    if (step.axis > 1) return;
    account(step.cycle);
    if (steps_ % static_cast<unsigned>(kLaserStepsPerMm) == 0 && steps_ != 0) {
      lit_.push_back(in_mm_);
      in_mm_ = 0;
    }
    if (steps_ == 0) in_mm_ = 0;
    ++steps_;
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
  // Lit clocks so far, in a mm or not.
  double all() const { return all_; }

 private:
  void account(std::uint64_t cycle) {
    if (on_) in_mm_ += static_cast<double>(cycle - at_);
    if (on_) all_ += static_cast<double>(cycle - at_);
    at_ = cycle;
  }

  std::vector<double> lit_;
  double in_mm_ = 0;
  double all_ = 0;
  std::uint64_t at_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t edges_ = 0;
  bool on_ = false;
};

// Right angles, a reversal, lines of less than a millimetre, and a line of another feed.
std::string laser_program(const char* spindle) {
  std::string text = std::string("G0 X0 Y0\n") + spindle + " S600\nG1 X12 F1500\nG1 Y8\nX4\nY3\nX10\nX6\nY5\n";
  for (int i = 0; i < 12; ++i) text += (i % 2 == 0 ? "G91 X0.5\n" : "G91 Y0.25\n");
  return text + "G90 G1 X30\nG1 Y20\nM5\nM2\n";
}

struct Burnt {
  double least = 1e9;  // shares of the programmed energy, of each mm
  double most = 0;
  std::size_t mm = 0;
  std::uint64_t edges = 0;
  bool on = false;
};

// Holds and overrides come while the card moves.
Burnt burn(const char* spindle, bool disturbed) {
  machine::Machine machine = machine::default_machine();
  machine::apply_override(machine, "spindle.output=1");
  machine::apply_override(machine, "spindle.pwm_hz=10000");
  machine::apply_override(machine, "spindle.laser=true");
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, kLaserClock, false});
  sim::TimedBus bus(*engine, kLaserClock, 1e9);
  driver::Card card = driver::Card::open(bus);
  configure(card, machine);
  EnergyMeter meter;
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
  const std::string text = laser_program(spindle);
  const auto lines = [&text]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<gcode::TextLines>(text, "laser.ngc");
  };
  Runner runner(lines, machine, planner::limits_of(card.identification()));
  runner.plan();
  runner.run(card);
  Burnt burnt;
  const double programmed = kLaserPower * kLaserClock / kLaserFeed;  // lit clocks of 1 mm
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

TEST(LaserEnergy, IsThatOfTheProgramInEachMillimetre) {
  const Burnt calm = burn("M4", false);
  const Burnt disturbed = burn("M4", true);
  const Burnt constant = burn("M3", true);
  print_burnt("M4", calm);
  print_burnt("M4, holds and overrides", disturbed);
  print_burnt("M3, holds and overrides", constant);
  EXPECT_GT(calm.mm, 70U);
  EXPECT_GT(calm.edges, 40'000U);
  for (const Burnt& b : {calm, disturbed}) {
    EXPECT_GT(b.least, 0.99);
    EXPECT_LT(b.most, 1.01);
    EXPECT_FALSE(b.on);
  }
  EXPECT_GT(constant.most, 2) << "a mm with a hold in it";
  EXPECT_FALSE(constant.on);
}

}  // namespace
}  // namespace trammel::run
