// The card object of the Python module.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "module.hpp"
#include "trammel/bindings/simulated_machine.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::python {

using std::chrono::nanoseconds;

// PinStep: (cycle, axis, direction) of a leading edge at a pin. PathStep: (command, tick, axis, direction) of a step of
// the path.
using PinStep = std::tuple<std::uint64_t, unsigned, int>;
using PathStep = std::tuple<std::uint64_t, std::uint64_t, unsigned, int>;

class StepRecord final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& s) override { pins.emplace_back(s.cycle, s.axis, s.direction); }
  void path_step(const driver::PathStep& s) override { path.emplace_back(s.command, s.tick, s.axis, s.direction); }

  std::vector<PinStep> pins;
  std::vector<PathStep> path;
};

// A bus that can be closed while the card and its streams still exist: every later access then throws.
class ClosableBus final : public driver::Bus {
 public:
  explicit ClosableBus(std::shared_ptr<driver::Bus> way) : way_(std::move(way)) {}
  void close() { way_.reset(); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override { return way().transfer(accesses, count); }
  void sleep(nanoseconds time) override { way().sleep(time); }
  bool reports_refusals() const override { return way().reports_refusals(); }
  bool has_interrupt() const override { return way().has_interrupt(); }
  bool wait_for_interrupt(nanoseconds longest) override { return way().wait_for_interrupt(longest); }
  std::string hold_origin() const override { return way().hold_origin(); }

 private:
  driver::Bus& way() const {
    if (!way_) throw driver::StateError("the card is closed");
    return *way_;
  }

  std::shared_ptr<driver::Bus> way_;
};

// Card, bus and, for simulated cards, the record of steps, which outlives the bus.
class PythonCard {
 public:
  PythonCard(std::shared_ptr<driver::Bus> way, sim::Engine* simulated)
      : bus_(std::move(way)), engine_(simulated), simulated_(simulated != nullptr), card(driver::Card::open(bus_)) {}

  sim::Engine& engine() const {
    if (!simulated_) throw driver::StateError("this is for simulated cards alone");
    if (engine_ == nullptr) throw driver::StateError("the card is closed");
    return *engine_;
  }
  void record(bool on) { engine().set_sink(on ? &steps : nullptr); }
  void close() {
    engine_ = nullptr;
    bus_.close();
  }

  StepRecord steps;
  std::shared_ptr<bindings::CardInWorld> world;  // set if the card has a machine behind its pins

 private:
  ClosableBus bus_;
  sim::Engine* engine_;  // the simulated card; nullptr for other cards, and after closing
  bool simulated_;

 public:
  driver::Card card;
};

// Values by axis; missing values at the end are 0.
template <class T>
std::array<T, card_map::kMaxAxes> by_axis(const std::vector<T>& values, const char* what) {
  if (values.size() > card_map::kMaxAxes) {
    throw driver::ArgumentError(std::string(what) + ": a card has 8 axes at most");
  }
  std::array<T, card_map::kMaxAxes> out{};
  std::copy(values.begin(), values.end(), out.begin());
  return out;
}

using Axes = std::vector<unsigned>;  // numbers of axes

// A mask of the axes; bit n: axis n. Throws ArgumentError for an axis that the card lacks.
inline std::uint8_t mask_of(const PythonCard& of, const Axes& axes) {
  const unsigned present = of.card.identification().axes;
  unsigned mask = 0;
  for (const unsigned axis : axes) {
    if (axis >= present) {
      throw driver::ArgumentError("axis " + std::to_string(axis) + ": the card has " + std::to_string(present) +
                                  " axes");
    }
    mask |= 1U << axis;
  }
  return static_cast<std::uint8_t>(mask);
}

inline std::vector<bool> bits_of(std::uint8_t mask, std::size_t axes) {
  std::vector<bool> bits(axes);
  for (std::size_t n = 0; n < axes; ++n) bits[n] = (mask >> n & 1U) != 0;
  return bits;
}

// Throws ArgumentError for an input that the card lacks.
inline void check_input(PythonCard& of, unsigned input) {
  const unsigned present = of.card.inputs_present();
  if (input < present) return;
  throw driver::ArgumentError("input " + std::to_string(input) + ": the card has " + std::to_string(present) +
                              " inputs");
}

}  // namespace trammel::python
