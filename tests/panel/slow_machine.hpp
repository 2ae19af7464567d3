// A machine in memory with its own clock: time passes in moments of 5 ms, in which its axes move.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "trammel/gcode/reader.hpp"
#include "trammel/grbl/machine_side.hpp"

namespace trammel::panel {

using TimePoint = std::chrono::steady_clock::time_point;

inline machine::Machine small_machine() {
  machine::Machine machine;
  machine.clock_hz = 100'000'000;
  for (const char letter : {'X', 'Y', 'Z'}) {
    machine::MachineAxis axis;
    axis.letter = letter;
    axis.steps_per_mm = 100;
    axis.max_velocity = 50;
    axis.max_acceleration = 500;
    axis.step_length_ns = axis.step_space_ns = 2000;
    axis.min = -10;
    axis.max = 200;
    axis.homing = machine::AxisHoming{};
    machine.axes.push_back(axis);
  }
  return machine;
}

class SlowMachine final : public grbl::MachineSide {
 public:
  explicit SlowMachine(machine::Machine machine = small_machine()) : machine_(std::move(machine)) {}

  static constexpr std::chrono::milliseconds kMoment{5};
  static constexpr double kStep = 0.1;  // mm per moment: 20 mm/s

  TimePoint now{};
  std::function<void()> at_moments;  // called in each moment, before the session's work
  grbl::Live live;
  bool is_homed = true;
  grbl::End trouble_now;
  grbl::End homing_end;
  std::vector<std::string> lines;  // lines of motions, without the lines that set the state
  std::vector<TimePoint> stops;
  std::vector<bool> holds;
  unsigned homings = 0;

  const machine::Machine& machine() const override { return machine_; }
  planner::CardLimits limits() const override {
    planner::CardLimits card;
    card.clock_hz = machine_.clock_hz;
    return card;
  }
  void set_machine(const machine::Machine& machine) override { machine_ = machine; }
  grbl::Live look() override {
    live.any_sent = true;  // no wait for the next line by the host's clock
    return live;
  }
  bool probe_touches() override { return false; }
  void wait() override { moment(); }
  void set_meanwhile(std::function<void()> meanwhile) override { meanwhile_ = std::move(meanwhile); }
  void hold(bool hold) override {
    holds.push_back(hold);
    live.held = hold;
  }
  void stop() override {
    stops.push_back(now);
    stopping_ = moving_;
  }
  double override_feed(double percent) override { return std::min(percent, 150.0); }
  void override_rapids(double /*percent*/) override {}

  grbl::End run(gcode::LineSource& source, const grbl::Before& before) override {
    gcode::ReaderOptions options;
    options.parameters = before.parameters;
    gcode::Reader reader(source, machine_, before.place, options);
    grbl::End end;
    begin();
    for (gcode::Motion motion; !end.stopped && reader.next(motion);) {
      live.line = motion.line;
      end.stopped = !go(motion.target);
    }
    if (reader.error()) end.message = gcode::describe(*reader.error());
    moving_ = live.held = false;
    return end;
  }
  grbl::End home(const std::vector<std::size_t>& /*axes*/) override {
    ++homings;
    begin();
    grbl::End end = homing_end;
    end.stopped = !go({});
    is_homed = end.alarm == grbl::Alarm::kNone && !end.stopped;
    moving_ = false;
    return end;
  }
  bool can_home() const override { return machine_.axes[0].homing.has_value(); }
  bool homed() override { return is_homed; }
  bool has_probe() const override { return false; }
  grbl::End trouble() override { return trouble_now; }
  grbl::End unlock() override { return trouble_now; }

 private:
  void begin() {
    moving_ = true;
    stopping_ = false;
  }
  // Returns false if the motion was stopped.
  bool go(const gcode::Coordinates& target) {
    const gcode::Coordinates from = live.at;
    double way = 0;
    for (std::size_t n = 0; n < machine_.axes.size(); ++n) way = std::max(way, std::abs(target[n] - from[n]));
    for (double gone = 0; gone < way;) {
      moment();
      if (stopping_) return false;
      if (live.held) continue;
      gone = std::min(gone + kStep, way);
      for (std::size_t n = 0; n < from.size(); ++n) live.at[n] = from[n] + (target[n] - from[n]) * gone / way;
    }
    return true;
  }
  void moment() {
    now += kMoment;
    if (++moments_ > kMostMoments) throw std::logic_error("the test waits for ever");
    if (inside_) return;  // as on the card's bus, the hook is not called from within itself
    inside_ = true;
    const std::function<void()> step = at_moments;  // a copy, because the step may replace it
    if (step) step();
    if (meanwhile_) meanwhile_();
    inside_ = false;
  }

  static constexpr unsigned kMostMoments = 200'000;

  machine::Machine machine_;
  std::function<void()> meanwhile_;
  bool moving_ = false;
  bool stopping_ = false;
  bool inside_ = false;
  unsigned moments_ = 0;
};

}  // namespace trammel::panel
