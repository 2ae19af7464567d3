#include "trammel/run/homing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "clocks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {
namespace {

using testing::HasSubstr;

// A switch that is pressed from a motor's pulse on, outward in `direction`; it bounces for some clocks at each change.
struct Switch {
  unsigned input = 0;
  unsigned motor = 0;
  std::int64_t edge = 0;  // pulse at which it is pressed first
  int direction = -1;
  std::int64_t width = 1'000'000;  // pulses that it stays pressed for: an index mark is short
  std::uint64_t bounce = 0;        // clocks
  bool broken = false;
  bool pressed = false;
  std::uint64_t changed = 0;
};

// An engine with switches at its inputs, which are looked at every kSlice clocks. The card stands at `start`, pulses.
class BusWithSwitches final : public driver::Bus {
 public:
  static constexpr std::uint64_t kSlice = 8;

  BusWithSwitches(sim::Engine& engine, std::vector<std::int64_t> start) : engine_(engine), start_(std::move(start)) {}

  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    const std::size_t made = engine_.transfer(accesses, count);
    look();
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override {
    const std::uint64_t end = engine_.cycles() + driver::clocks_of(time, kClock, "sleep");
    while (engine_.cycles() < end) {
      engine_.wait(std::min(slice(), end - engine_.cycles()));
      look();
    }
  }
  bool reports_refusals() const override { return true; }

  void add(const Switch& one) { switches_.push_back(one); }
  std::vector<std::int64_t> places() const {
    std::vector<std::int64_t> at = engine_.positions();
    for (std::size_t n = 0; n < at.size(); ++n) at[n] += start_[n];
    return at;
  }
  void look() {
    at_ = places();
    std::uint32_t levels = 0;
    for (Switch& one : switches_) {
      const std::int64_t in = (at_[one.motor] - one.edge) * one.direction;
      const bool pressed = !one.broken && in >= 0 && in < one.width;
      if (pressed != one.pressed) one.changed = engine_.cycles();
      one.pressed = pressed;
      const std::uint64_t since = engine_.cycles() - one.changed;
      const bool bounces = since < one.bounce && one.changed != 0 && since / kSlice % 3 == 1;
      if (pressed != bounces) levels |= 1U << one.input;
    }
    if (levels == levels_ && looked_) return;
    engine_.set_inputs(levels);
    levels_ = levels;
    looked_ = true;
  }

 private:
  // Not beyond the nearest edge: no motor makes more than a pulse in kFastestPulse clocks.
  std::uint64_t slice() const {
    constexpr std::uint64_t kFastestPulse = 24;
    std::uint64_t nearest = 1000;
    for (const Switch& one : switches_) {
      for (const std::int64_t edge : {one.edge, one.edge + one.direction * one.width}) {
        const auto pulses = static_cast<std::uint64_t>(std::abs(at_[one.motor] - edge));
        nearest = std::min(nearest, pulses < 2 ? 0 : pulses - 2);
      }
      if (one.changed != 0 && engine_.cycles() - one.changed < one.bounce) nearest = 0;
    }
    return std::max(kSlice, nearest * kFastestPulse);
  }

  sim::Engine& engine_;
  std::vector<std::int64_t> start_;
  std::vector<Switch> switches_;
  std::vector<std::int64_t> at_;  // as of the last look
  std::uint32_t levels_ = 0;
  bool looked_ = false;
};

// Home switches at inputs 0 (X), 1 (Y) and 2 (Z), an index of X at 3; X also at 4 for a second motor.
machine::Machine homing_machine(const std::string& more = "") {
  machine::Machine machine = machine::default_machine();
  const auto set = [&](const std::string& text) { machine::apply_override(machine, text); };
  set("axis.x.min=0");
  set("axis.x.max=200");
  set("inputs.closed_level=1");
  set("inputs.x_home=0");
  set("inputs.y_home=1");
  set("inputs.z_home=2");
  set("inputs.x_index=3");
  set("homing.x={search_velocity=-40, latch_velocity=-2, offset=-1, final_position=5}");
  set("homing.y={search_velocity=-30, latch_velocity=2, search_distance=100, sequence=1}");
  set("homing.z={search_velocity=20, latch_velocity=1, search_distance=60, sequence=1}");
  for (std::size_t from = 0; from < more.size();) {
    const std::size_t end = std::min(more.find(';', from), more.size());
    set(more.substr(from, end - from));
    from = end + 1;
  }
  return machine;
}

class HomingTest : public testing::Test {
 protected:
  static constexpr std::int64_t kPerMm = 80;

  void begin(const machine::Machine& machine, std::vector<std::int64_t> start = {4000, 1600, -800, 0, 0}) {
    machine_ = machine;
    engine_ = sim::make_model_engine(sim::EngineOptions{5, kClock, false});
    bus_ = std::make_unique<BusWithSwitches>(*engine_, std::move(start));
    card_ = std::make_unique<driver::Card>(driver::Card::open(*bus_));
  }
  std::vector<HomedAxis> home(const std::vector<std::size_t>& axes) {
    bus_->look();
    configure(*card_, machine_);
    MachinePosition position(card_->read_snapshot(), machine_);
    keep_place(*card_, read_card_place(*card_), scales_of(machine_), motors_of(machine_));
    return run::home(*card_, machine_, position, axes);
  }
  // Where the machine believes to stand, mm.
  double coordinate(std::size_t axis) { return standing_at(machine_, read_card_place(*card_))[axis]; }
  std::string error_of(const std::vector<std::size_t>& axes) {
    try {
      home(axes);
    } catch (const HomingError& error) {
      return error.what();
    }
    return "";
  }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_;
  std::unique_ptr<BusWithSwitches> bus_;
  std::unique_ptr<driver::Card> card_;
};

TEST_F(HomingTest, OneAxisComesToItsFinalPosition) {
  begin(homing_machine());
  bus_->add({0, 0, 1000});  // pressed at 12.5 mm and below
  const std::vector<HomedAxis> homed = home({0});
  ASSERT_EQ(homed.size(), 1U);
  // The edge at pulse 1000 is at machine coordinate -1; the axis stands at 5, six mm from it.
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(coordinate(0), 5, 0.013);
  EXPECT_NEAR(homed[0].search_edge, homed[0].edge, 1.01 / kPerMm);
  EXPECT_EQ(card_->read_place().homed, 1);
  EXPECT_EQ(card_->read_faults(), 0U);
  EXPECT_EQ(bus_->places()[1], 1600) << "the others stand";
}

TEST_F(HomingTest, AxesHomeTogetherAndInSequence) {
  begin(homing_machine());
  bus_->add({0, 0, 1000});
  bus_->add({1, 1, -500});
  bus_->add({2, 2, 400, 1});
  home({0, 1, 2});
  EXPECT_EQ(card_->read_place().homed, 7);
  EXPECT_NEAR(coordinate(0), 5, 0.013);
  for (std::size_t axis : {1, 2}) EXPECT_NEAR(coordinate(axis), 0, 0.013);
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), -500, 1.01);
  EXPECT_NEAR(static_cast<double>(bus_->places()[2]), 400, 1.01);
}

TEST_F(HomingTest, APressedSwitchIsLeftFirst) {
  begin(homing_machine(), {200, 0, 0, 0, 0});
  bus_->add({0, 0, 1000});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
}

TEST_F(HomingTest, TheIndexBehindTheSwitchCounts) {
  begin(homing_machine("homing.x.use_index=true"));
  bus_->add({0, 0, 1000});
  bus_->add({3, 0, 930, -1, 40});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 930), 6 * kPerMm, 1);
}

TEST_F(HomingTest, AGantryIsSquared) {
  begin(homing_machine("axis.x.second_motor=true;inputs.x_second_home=4"));
  bus_->add({0, 0, 1000});
  bus_->add({4, 4, -3070});  // motor 4 starts at 0, and motor 0 at 4000: a skew of 70 pulses
  const std::vector<HomedAxis> homed = home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
  EXPECT_NEAR(static_cast<double>(bus_->places()[4] + 3070), 6 * kPerMm, 1);
  EXPECT_NEAR(std::abs(homed[0].squared_by), 70.0 / kPerMm, 1.5 / kPerMm);
  EXPECT_EQ(card_->read_place().homed, 17);
}

TEST_F(HomingTest, ALimitThatIsTheHomeSwitchIsIgnored) {
  begin(homing_machine("homing.x.ignore_limits=true;inputs.x_limit_minus={input=0, normally=\"open\"}"));
  bus_->add({0, 0, 1000});
  home({0});
  EXPECT_NEAR(coordinate(0), 5, 0.013);
  EXPECT_EQ(card_->read_role({driver::AxisRole::kLimitMinus, 0}), 1U) << "it is a limit again";
}

TEST_F(HomingTest, ASwitchThatNeverComesEndsTheSearch) {
  begin(homing_machine());
  bus_->add({1, 1, -500, -1, 1000, 0, true});
  EXPECT_THAT(error_of({1}), HasSubstr("Y: its home switch at input 1 did not become active within 100 mm at 30 mm/s"));
  EXPECT_NEAR(static_cast<double>(bus_->places()[1]), 1600 - 100 * kPerMm, 1);
  EXPECT_EQ(card_->read_place().homed, 0);
  EXPECT_FALSE(card_->busy());
}

TEST_F(HomingTest, AGantryThatIsTooSkewEndsAtItsBound) {
  begin(homing_machine("axis.x.second_motor=true;inputs.x_second_home=4;homing.x.squaring=3"));
  bus_->add({0, 0, 1000});
  bus_->add({4, 4, -3500});  // 500 pulses, 6.25 mm, later
  EXPECT_THAT(error_of({0}),
              HasSubstr("X, second motor: its home switch at input 4 did not become active within 3 mm"));
  EXPECT_EQ(card_->read_place().homed, 0);
}

TEST_F(HomingTest, ASharedSwitchMustBeFree) {
  begin(homing_machine("homing.x.shared=true"), {200, 0, 0, 0, 0});
  bus_->add({0, 0, 1000});
  EXPECT_THAT(error_of({0}), HasSubstr("is shared, and pressed before it moves"));
  EXPECT_EQ(bus_->places()[0], 200);
}

TEST_F(HomingTest, AStuckSwitchIsNamed) {
  begin(homing_machine("homing.x.search_distance=20"), {200, 0, 0, 0, 0});
  bus_->add({0, 0, 1'000'000});
  EXPECT_THAT(error_of({0}), HasSubstr("X: its home switch at input 0 did not become free within 20 mm at 40 mm/s"));
}

TEST_F(HomingTest, AStallIsLookedAtAtSpeed) {
  begin(homing_machine("homing.x={search_velocity=-40, latch_velocity=0, at_speed=true}"));
  bus_->add({0, 0, 3995, 1, 1000});  // reports while it speeds up
  bus_->add({0, 0, 1000});
  home({0});
  EXPECT_NEAR(static_cast<double>(bus_->places()[0] - 1000), 6 * kPerMm, 1);
}

// The same edge for any phase of the ramp, scale, speed, bounce and filter.
TEST_F(HomingTest, TheEdgeIsTheSameWithinAPulse) {
  std::mt19937 random(7);
  const auto draw = [&random](double from, double to) {
    return from + (to - from) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  const int machines = std::getenv("TRAMMEL_LONG") == nullptr ? 100 : 1000;
  for (int i = 0; i < machines; ++i) {
    const double scale = std::round(draw(20, 400));
    const double search = draw(5, 60);
    const double latch = draw(0.5, std::min(4.0, search));
    const double filter = draw(0, 5);
    begin(
        homing_machine(fmt::format("axis.x.steps_per_mm={};inputs.filter={:.3f};homing.x={{search_velocity=-{:.3f}, "
                                   "latch_velocity=-{:.3f}}}",
                                   scale, filter, search, latch)));
    const auto edge = static_cast<std::int64_t>(4000 - draw(0.5, 20) * scale);
    bus_->add({0, 0, edge, -1, 1'000'000, static_cast<std::uint64_t>(draw(0, filter * 500))});
    const std::vector<HomedAxis> homed = home({0});
    EXPECT_LE(std::abs(homed[0].search_edge - homed[0].edge) * scale, 1.01) << i;
    EXPECT_NEAR(static_cast<double>(bus_->places()[0] - edge), 6 * scale, 1.01) << i;
    EXPECT_EQ(card_->read_faults(), 0U);
  }
}

}  // namespace
}  // namespace trammel::run
