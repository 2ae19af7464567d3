// A card for tests of homing, with switches at its inputs that follow the motors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/homing.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::run {

inline constexpr std::uint32_t kHomingClock = 1'000'000;  // clock of the card, Hz

// A switch that is pressed while its motor is at pulse `edge` or beyond it in `direction`, over `width` pulses. It
// bounces for `bounce` clocks after each change.
struct Switch {
  unsigned input = 0;
  unsigned motor = 0;
  std::int64_t edge = 0;  // first pulse at which the switch is pressed
  int direction = -1;
  std::int64_t width = 1'000'000;  // pulses over which it stays pressed; an index mark is short
  std::uint64_t bounce = 0;        // clocks
  bool broken = false;
  bool pressed = false;
  std::uint64_t changed = 0;
};

// An engine with switches at its inputs. Close to a switch the levels are updated every kSlice clocks. `start`: initial
// position, pulses. With crossed belts (CoreXY), motor 0 of a switch is the carriage along X and motor 1 the carriage
// along Y.
class BusWithSwitches final : public driver::Bus {
 public:
  static constexpr std::uint64_t kSlice = 8;

  BusWithSwitches(sim::Engine& engine, std::vector<std::int64_t> start, bool crossed_belts)
      : engine_(engine), start_(std::move(start)), crossed_belts_(crossed_belts) {}

  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    const std::size_t made = engine_.transfer(accesses, count);
    look();
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override {
    const std::uint64_t end = engine_.cycles() + driver::clocks_of(time, kHomingClock, "sleep");
    while (engine_.cycles() < end) {
      engine_.wait(std::min(slice(), end - engine_.cycles()));
      look();
    }
  }
  bool reports_refusals() const override { return true; }

  void add(const Switch& one) { switches_.push_back(one); }
  void move_switch(std::size_t n, std::int64_t edge) { switches_.at(n).edge = edge; }
  std::vector<std::int64_t> places() const {
    std::vector<std::int64_t> at = engine_.positions();
    if (crossed_belts_) {
      const std::int64_t a = at[0];
      at[0] = (a + at[1]) / 2;
      at[1] = (a - at[1]) / 2;
    }
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
  // Clocks until the next update. No motor reaches an edge before it: a pulse takes at least kFastestPulse clocks.
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
  bool crossed_belts_;
  std::vector<Switch> switches_;
  std::vector<std::int64_t> at_;  // positions at the last look()
  std::uint32_t levels_ = 0;
  bool looked_ = false;
};

// Home switches at inputs 0 (X), 1 (Y) and 2 (Z), and an index of X at 3. `more`: further entries, separated by ';'.
// Tests with a second motor of X use input 4 for its home switch.
inline machine::Machine homing_machine(const std::string& more = "") {
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

// A card of 5 axes whose switches follow its motors.
class HomingBench {
 public:
  static constexpr std::int64_t kPerMm = 80;

  void begin(const machine::Machine& machine, std::vector<std::int64_t> start, std::unique_ptr<sim::Engine> engine) {
    machine_ = machine;
    engine_ = std::move(engine);
    const bool crossed_belts = machine.kinematics.name == "corexy";
    bus_ = std::make_unique<BusWithSwitches>(*engine_, std::move(start), crossed_belts);
    card_ = std::make_unique<driver::Card>(driver::Card::open(*bus_));
  }
  std::vector<HomedAxis> home(const std::vector<std::size_t>& axes) {
    bus_->look();
    configure(*card_, machine_);
    MachinePosition position(card_->read_snapshot(), machine_);
    const CardPlace place = read_card_place(*card_);
    if (scales_fit(place, machine_)) {
      const gcode::Coordinates at = standing_at(machine_, place);
      for (std::size_t n = 0; n < machine_.axes.size(); ++n) position.set(n, at[n]);
    }
    keep_place(*card_, place, scales_of(machine_), motors_of(machine_));
    HomingOptions options;
    options.say = [this](const std::string& text) { said_ = text; };
    return run::home(*card_, machine_, position, axes, options);
  }
  // The last text that HomingOptions::say received.
  const std::string& said() const { return said_; }
  // Machine coordinate of an axis according to the place that the card keeps, mm.
  double coordinate(std::size_t axis) { return standing_at(machine_, read_card_place(*card_))[axis]; }
  std::string error_of(const std::vector<std::size_t>& axes) {
    try {
      home(axes);
    } catch (const HomingError& error) {
      return error.what();
    }
    return "";
  }

  sim::Engine& engine() { return *engine_; }
  BusWithSwitches& bus() { return *bus_; }
  driver::Card& card() { return *card_; }

 protected:
  machine::Machine machine_ = machine::default_machine();
  std::unique_ptr<sim::Engine> engine_;
  std::unique_ptr<BusWithSwitches> bus_;
  std::string said_;
  std::unique_ptr<driver::Card> card_;
};

}  // namespace trammel::run
