#include "trammel/run/jog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "clocks.hpp"
#include "dying_bus.hpp"
#include "steps.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

class JogTest : public testing::Test {
 protected:
  JogTest() {
    machine::apply_override(machine_, "axis.x.max=40");
    machine::apply_override(machine_, "axis.x.min=-10.004");  // between two pulses
    machine::apply_override(machine_, "axis.y.max=30");
    configure(card_, machine_);
    engine_->set_sink(&steps_);
  }
  // Lets time pass, and polls the jog every 20 ms.
  void pass(double seconds) {
    const std::uint64_t end = engine_->cycles() + static_cast<std::uint64_t>(seconds * kClock);
    while (engine_->cycles() < end) {
      jog_.moving();
      const std::uint64_t now = std::min(engine_->cycles(), end);
      bus_.sleep(std::chrono::microseconds(std::min<std::uint64_t>(20'000, end - now)));
    }
  }
  double seconds() const { return static_cast<double>(engine_->cycles()) / kClock; }
  // Mean speed of an axis over the last `window` seconds, mm/s.
  double speed(unsigned axis, double window = 0.02) const {
    const std::uint64_t now = engine_->cycles();
    int pulses = 0;
    for (const driver::PinStep& step : steps_.pins) {
      if (step.axis == axis && step.cycle + static_cast<std::uint64_t>(window * kClock) > now) pulses += step.direction;
    }
    return pulses / 80.0 / window;
  }
  // Largest acceleration of an axis between windows of 20 ms, mm/s^2.
  double largest_acceleration(unsigned axis) const {
    constexpr std::uint64_t kWindow = kClock / 50;
    std::vector<double> counts(engine_->cycles() / kWindow + 2);
    for (const driver::PinStep& step : steps_.pins) {
      if (step.axis == axis) counts[step.cycle / kWindow] += step.direction;
    }
    double largest = 0;
    for (std::size_t i = 1; i < counts.size(); ++i) {
      // Each count may be off by one pulse.
      largest = std::max(largest, std::abs(counts[i] - counts[i - 1]) - 2);
    }
    return largest / 80 * 50 * 50;
  }

  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  sim::TimedBus bus_{*engine_, kClock, 8000};
  driver::Card card_ = driver::Card::open(bus_);
  test::Steps steps_;
  MachinePosition position_{card_.read_snapshot(), machine_};
  Jog jog_{card_, machine_, position_};
};

TEST_F(JogTest, SeveralAxesByADistance) {
  jog_.start({3, -4}, 20);
  EXPECT_TRUE(jog_.moving());
  EXPECT_FALSE(card_.in_position());
  jog_.wait();
  EXPECT_TRUE(card_.in_position());
  const double took = static_cast<double>(steps_.pins.back().cycle - steps_.pins.front().cycle) / kClock;
  // 5 mm at 20 mm/s with ramps of 1,250 mm/s^2 (1,000 for Y). The first and the last pulse of Y come half a pulse from
  // rest, so the time of that distance is subtracted twice. Y makes 320 pulses.
  EXPECT_NEAR(took, 0.25 + 0.016 - 2 * std::sqrt(5.0 / 320 / 1250), 0.002);
  EXPECT_EQ(position_.pulses(), (planner::Pulses{240, -320}));
  EXPECT_LT(largest_acceleration(1), 1100);
  jog_.start({-3, 4}, 20);
  jog_.wait();
  EXPECT_EQ(position_.pulses(), planner::Pulses{});
}

TEST_F(JogTest, StopsBeforeTheFirstSoftLimit) {
  jog_.start({30, 10});  // X reaches its limit of 40 mm when Y is at 13.3
  jog_.wait();
  EXPECT_EQ(position_.pulses()[0], 3200);
  EXPECT_NEAR(static_cast<double>(position_.pulses()[1]), 1066.7, 1);
  EXPECT_LT(largest_acceleration(0), 1100);
  EXPECT_THROW(jog_.start({1, 0}), driver::ArgumentError) << "it stands there";
  jog_.start({-500, 0}, 60);
  jog_.wait();
  EXPECT_EQ(position_.pulses()[0], -800) << "not beyond -10.004 mm";
  jog_.start({0, 0, 1}, 5);
  jog_.wait();
  EXPECT_EQ(position_.pulses()[2], 80) << "without limits";
}

TEST_F(JogTest, RunsUntilItIsStoppedAndRampsDown) {
  machine::apply_override(machine_, "axis.x.max=1e4");
  jog_.start({30, 0});
  pass(1);
  EXPECT_NEAR(speed(0), 30, 1);
  const std::size_t before = steps_.pins.size();
  jog_.stop();
  jog_.wait();
  // A stop from 30 mm/s at half of 1000 mm/s^2 takes 60 ms and 0.9 mm.
  EXPECT_NEAR(static_cast<double>(steps_.pins.size() - before), 0.9 * 80, 4);
  EXPECT_LT(largest_acceleration(0), 600);
  const std::int64_t stood = position_.pulses()[0];
  EXPECT_EQ(stood, static_cast<std::int64_t>(steps_.pins.size()));
  pass(1);
  EXPECT_EQ(static_cast<std::int64_t>(steps_.pins.size()), stood) << "nothing comes after it";
}

TEST_F(JogTest, ItsSpeedIsChangedWithinLimits) {
  machine::apply_override(machine_, "axis.x.max=1e4");
  jog_.start({30, 0});
  pass(0.5);
  EXPECT_NEAR(jog_.set_speed(80), 80, 0.01);
  pass(0.5);
  EXPECT_NEAR(speed(0), 80, 1);
  EXPECT_DOUBLE_EQ(jog_.set_speed(1000), 150) << "max_velocity";
  pass(0.5);
  EXPECT_NEAR(speed(0), 150, 2);
  jog_.set_speed(5);
  pass(0.5);
  EXPECT_NEAR(speed(0, 0.2), 5, 0.2);
  EXPECT_LT(largest_acceleration(0), 600);
  jog_.stop();
  EXPECT_EQ(jog_.set_speed(50), 0) << "it stops";
  jog_.wait();
}

// The ratio is read 10 ms after each call, on a bus of 8 kB/s.
TEST_F(JogTest, ReactsWithinTenMilliseconds) {
  machine::apply_override(machine_, "axis.x.max=1e4");
  const auto ratio_after = [&](double begun) {
    pass(std::max(0.0, begun + 0.01 - seconds()));
    return engine_->read(card_map::reg::kStatus), card_.read_snapshot().ratio;
  };
  double begun = seconds();
  jog_.start({75, 0});
  pass(0.5);
  EXPECT_GT(steps_.pins.front().cycle, begun * kClock);
  std::uint32_t ratio = card_.read_snapshot().ratio;
  EXPECT_NEAR(ratio, 0x8000, 2);
  begun = seconds();
  jog_.set_speed(140);
  EXPECT_LE(seconds() - begun, 0.002);
  EXPECT_GT(ratio_after(begun), ratio + 1000) << "faster";
  pass(0.5);
  ratio = card_.read_snapshot().ratio;
  begun = seconds();
  jog_.stop();
  EXPECT_LT(ratio_after(begun), ratio - 1000) << "slower";
  jog_.wait();
  // A start opens the stream and writes three commands, about 40 words. It is measured on a bus of 100 kB/s.
  sim::TimedBus fast(*engine_, kClock, 100'000);
  driver::Card card = driver::Card::open(fast);
  MachinePosition position(card.read_snapshot(), machine_);
  Jog jog(card, machine_, position);
  begun = seconds();
  const std::size_t made = steps_.pins.size();
  jog.start({75, 0});
  fast.sleep(std::chrono::milliseconds(10));
  EXPECT_GT(steps_.pins.size(), made);
  EXPECT_LT(static_cast<double>(steps_.pins[made].cycle) / kClock - begun, 0.01);
  jog.stop();
  jog.wait();
}

// The host's bus fails. The card then ramps to rest within the commands that were sent ahead, far from the soft limit,
// and the next program finds the position. Cases: one axis, three axes, and a jog by a distance.
TEST_F(JogTest, AHostThatDiesLeavesARampedStop) {
  machine::apply_override(machine_, "axis.x.max=1e4");
  const double speed = 100;  // mm/s along the path
  for (const int kind : {0, 1, 2}) {
    SCOPED_TRACE(kind);
    const gcode::Coordinates direction = kind == 0 ? gcode::Coordinates{1, 0, 0} : gcode::Coordinates{0.8, 0, -0.6};
    const std::uint64_t dies = engine_->cycles() + kClock;
    DyingBus bus(*engine_, dies);
    driver::Card card = driver::Card::open(bus);
    const std::uint32_t under_runs = card.parts().registers.read(card_map::reg::kUnderruns);
    MachinePosition position(card.read_snapshot(), machine_);
    Jog jog(card, machine_, position);
    const auto times = [&direction](double factor) {
      return gcode::Coordinates{direction[0] * factor, 0, direction[2] * factor};
    };
    kind == 2 ? jog.start(times(5000), speed) : jog.start(times(speed));
    EXPECT_THROW(
        for (;;) {
          jog.moving();
          bus.sleep(std::chrono::milliseconds(20));
        },
        driver::LinkError);
    const std::size_t before = steps_.pins.size();
    const std::uint64_t dead = engine_->cycles();
    engine_->wait(std::uint64_t{5} * kClock);
    const std::vector<driver::PinStep>& steps = steps_.pins;
    ASSERT_GT(steps.size(), before);
    // Sent ahead: 2.2 stops of a full-speed jog at the jog's ratio, plus 0.1 s and some lines.
    const double stop = static_cast<double>(steps.back().cycle - dead) / kClock;
    EXPECT_GT(stop, 0.1);
    EXPECT_LT(stop, 1.0);
    // A ramp: X slows down continuously, and its last pulses are far apart.
    std::vector<std::uint64_t> x;
    for (std::size_t i = before; i < steps.size(); ++i) {
      if (steps[i].axis == 0) x.push_back(steps[i].cycle);
    }
    const std::size_t n = x.size();
    ASSERT_GT(n, 500U);
    EXPECT_GT(x[n - 1] - x[n - 11], 8 * (x[11] - x[1]));
    EXPECT_LT(largest_acceleration(0), 1100);
    EXPECT_EQ(engine_->read(card_map::reg::kFault), 0U);
    EXPECT_EQ(engine_->read(card_map::reg::kUnderruns), under_runs + 1);
    EXPECT_NE(engine_->read(card_map::reg::kStatus) & card_map::field::kStatusUnderrun, 0U);
    // The next program.
    const std::size_t stood = steps.size();
    driver::Card next = driver::Card::open(*engine_);
    next.stop();
    EXPECT_EQ(steps.size(), stood);
    std::vector<std::int64_t> counted(4);
    for (const driver::PinStep& step : steps) counted[step.axis] += step.direction;
    EXPECT_EQ(engine_->positions(), counted);
    configure(next, machine_);
    next.set_ratio(driver::Card::kFullRatio);
  }
}

// Without polls the jog stops. It continues when it is polled again.
TEST_F(JogTest, GoesOnWhenItIsLookedAtAgain) {
  machine::apply_override(machine_, "axis.x.max=1e4");
  jog_.start({30, 0});
  pass(0.5);
  EXPECT_NEAR(speed(0), 30, 1);
  bus_.sleep(std::chrono::seconds(3));
  EXPECT_EQ(speed(0), 0);
  EXPECT_EQ(engine_->read(card_map::reg::kUnderruns), 1U);
  pass(1);
  EXPECT_NEAR(speed(0), 30, 1);
  jog_.stop();
  jog_.wait();
  EXPECT_EQ(position_.pulses()[0], static_cast<std::int64_t>(steps_.pins.size()));
}

TEST_F(JogTest, GivesTheTimeBaseBackAndProgramsGoOnFromThere) {
  card_.set_ratio(0x6000);
  const std::uint32_t slew = card_.parts().registers.read(card_map::reg::kSlew);
  position_.set(0, 25);
  jog_.start({0, 30});
  pass(0.2);
  jog_.stop();
  jog_.wait();
  EXPECT_EQ(card_.parts().registers.read(card_map::reg::kRatioFeed), 0x6000U);
  EXPECT_EQ(card_.parts().registers.read(card_map::reg::kSlew), slew);
  EXPECT_EQ(card_.parts().registers.read(card_map::reg::kHold), 0U);
  RunSettings there;
  there.start = position_.millimetres();
  Runner runner([] { return std::make_unique<gcode::TextLines>("G0 X24\nG1 Y0 F900\n", "p.ngc"); }, machine_,
                planner::limits_of(card_.identification()), there);
  runner.plan();
  EXPECT_EQ(runner.run(card_).final_position[0], 24 * 80);
  position_.look(card_.read_snapshot());
  EXPECT_EQ(position_.pulses(), (planner::Pulses{24 * 80, 0}));
}

TEST_F(JogTest, RefusesWhatIsNoJog) {
  EXPECT_THROW(jog_.start({0, 0}), driver::ArgumentError);
  EXPECT_THROW(jog_.start({NAN, 0}), driver::ArgumentError);
  EXPECT_THROW(jog_.start({1, 0}, 0), driver::ArgumentError);
  EXPECT_THROW(jog_.start({0.001, 0}, 10), driver::ArgumentError) << "less than a pulse";
  EXPECT_FALSE(jog_.moving());
  jog_.start({1, 0});
  EXPECT_THROW(jog_.start({1, 0}), driver::StateError);
  jog_.stop();
  jog_.wait();
  driver::Stream stream(card_);
  stream.send(driver::DwellCommand{kClock});
  EXPECT_THROW(jog_.start({1, 0}), driver::StateError) << "the card is busy";
}

}  // namespace
}  // namespace trammel::run
