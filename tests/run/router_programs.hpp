// Random programs for a machine with long stops, and a bus with a high latency.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "random.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {

constexpr std::uint32_t kRouterClock = 1'000'000;
constexpr double kRouterStepsPerMm = 20;
constexpr double kRouterAcceleration = 300;  // mm/s^2

// A stop from full speed takes 2 s.
inline machine::Machine router() {
  machine::Machine machine = machine::default_machine();
  machine.motion.junction_deviation = 0.01;
  for (machine::MachineAxis& axis : machine.axes) {
    axis.steps_per_mm = kRouterStepsPerMm;
    axis.max_velocity = 300;
    axis.max_acceleration = kRouterAcceleration;
  }
  return machine;
}

// Lines, arcs, chords of a curve, rapids and dwells, with lengths over four decades and speeds over two.
class RouterProgram {
 public:
  explicit RouterProgram(std::uint64_t seed) : random_(seed) {
    text_ = fmt::format("G64 F{:.0f}\n", random_.logarithmic(600, 18'000));
    for (std::size_t parts = 2 + random_.below(8); parts != 0; --parts) part();
    text_ += "M2\n";
  }
  const std::string& text() const { return text_; }

 private:
  void part() {
    switch (random_.below(8)) {
      case 0:
        return rapid();
      case 1:
        return chords();
      case 2:
      case 3:
        return arcs();
      case 4:
        return dwell();
      default:
        return lines();
    }
  }
  void new_feed() {
    if (random_.below(2) == 0) text_ += fmt::format("F{:.0f}\n", random_.logarithmic(600, 18'000));
  }
  void rapid() {
    x_ = thousandths(random_.uniform(20, 180));
    y_ = thousandths(random_.uniform(20, 180));
    text_ += fmt::format("G0 X{:.3f} Y{:.3f}\n", x_, y_);
  }
  void dwell() {
    if (random_.below(3) == 0) text_ += fmt::format("G4 P{:.3f}\n", random_.logarithmic(0.001, 0.1));
    text_ += random_.below(2) == 0 ? "G61.1\n" : "G64\n";
  }
  void lines() {
    const double length = random_.logarithmic(0.02, 50);
    for (std::size_t i = 1 + random_.below(12); i != 0; --i) {
      new_feed();
      line(length * random_.logarithmic(0.3, 3), random_.uniform(0, kTurn));
    }
  }
  void arcs() {
    const double radius = random_.logarithmic(0.1, 20);
    for (std::size_t i = 1 + random_.below(10); i != 0; --i) {
      new_feed();
      const double angle = random_.uniform(0, kTurn);
      const double i_word = thousandths(radius * std::cos(angle));
      const double j_word = thousandths(radius * std::sin(angle));
      if (!inside(x_ + i_word, y_ + j_word)) continue;
      const bool half = random_.below(2) == 0;
      if (half) move(2 * i_word, 2 * j_word);
      text_ += fmt::format("G{} X{:.3f} Y{:.3f} I{:.3f} J{:.3f}\n", 2 + random_.below(2), x_, y_, i_word, j_word);
    }
  }
  void chords() {
    const double length = random_.logarithmic(0.03, 0.5);
    const double bend = random_.uniform(-0.1, 0.1);
    double angle = random_.uniform(0, kTurn);
    new_feed();
    for (std::size_t i = 20 + random_.below(280); i != 0; --i) line(length, angle += bend);
  }
  void line(double length, double angle) {
    move(length * std::cos(angle), length * std::sin(angle));
    text_ += fmt::format("G1 X{:.3f} Y{:.3f}\n", x_, y_);
  }
  static double thousandths(double value) { return std::round(value * 1000) / 1000; }
  static bool inside(double x, double y) { return x > 0 && x < 200 && y > 0 && y < 200; }
  void move(double x, double y) {
    if (!inside(x_ + x, y_ + y)) return;
    x_ = thousandths(x_ + x);
    y_ = thousandths(y_ + y);
  }

  static constexpr double kTurn = 6.283185307179586;
  test::Random random_;
  std::string text_;
  double x_ = 0;
  double y_ = 0;
};

// A bus of 1 MB/s with an additional latency of 1 ms per transfer. It fails after `last_cycle`.
class DistantBus final : public driver::Bus {
 public:
  explicit DistantBus(sim::Engine& engine, std::uint64_t last_cycle = ~std::uint64_t{0})
      : engine_(engine), bus_(engine, kRouterClock, 1e6), last_cycle_(last_cycle) {}
  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    bus_.sleep(std::chrono::milliseconds(1));
    if (engine_.cycles() > last_cycle_) throw driver::LinkError("the cable is out");
    return bus_.transfer(accesses, count);
  }
  void sleep(std::chrono::nanoseconds time) override { bus_.sleep(time); }
  bool reports_refusals() const override { return bus_.reports_refusals(); }

 private:
  sim::Engine& engine_;
  sim::TimedBus bus_;
  std::uint64_t last_cycle_;
};

}  // namespace trammel::run
