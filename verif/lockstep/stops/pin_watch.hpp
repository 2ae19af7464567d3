// Counts steps at the STEP pins and checks every pulse against the times that docs/reference/behaviour.md promises.
// It sees only the pins.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "watched_card.hpp"

namespace trammel::test {

inline constexpr unsigned kWatchedAxes = 4;
using Place = std::array<std::int32_t, kWatchedAxes>;  // pulses

// Settings of an axis's pins: MODE, and the shortest times, clocks.
struct AxisPins {
  enum Mode : std::uint8_t { kStepDir, kUpDown, kQuadrature };
  Mode mode = kStepDir;
  bool inverted = false;  // both pins
  std::uint32_t length = 1;
  std::uint32_t space = 1;
  std::uint32_t setup = 0;
  std::uint32_t hold = 0;

  std::uint32_t shortest() const { return length > 1 ? length : 1; }
  // Minimum clocks from leading edge to leading edge; reversal(): from trailing to leading edge at a reversal.
  std::uint32_t turnover() const { return shortest() + space + (length == 0 ? 5 : 6); }
  std::uint32_t reversal() const { return space + hold + setup + 12; }
};

struct Pulse {
  std::uint64_t clock;  // clock of its leading edge
  unsigned axis;
  int direction;
};

struct OutputChange {
  std::uint64_t clock;
  std::uint32_t levels;  // levels from this clock on
};

class PinWatch {
 public:
  // The present levels of the pins must be their levels at rest.
  void begin(const std::array<AxisPins, kWatchedAxes>& axes, const StepPins& pins) {
    for (unsigned n = 0; n < kWatchedAxes; ++n) {
      states_[n] = {};
      states_[n].pins = axes[n];
      states_[n].before = levels(axes[n], pins, n);
    }
    watches_ = true;
  }
  // Ends the checks until begin(): a reset cuts pulses, and MODE changes levels.
  void end() { watches_ = false; }

  void clock(std::uint64_t now, const StepPins& pins) {
    now_ = now;
    if (pins.first != last_.first || pins.second != last_.second) last_change = now;
    if (pins.outputs != last_.outputs) output_changes.push_back({now, pins.outputs});
    last_ = pins;
    if (!watches_) return;
    for (unsigned n = 0; n < kWatchedAxes; ++n) {
      Axis& axis = states_[n];
      const unsigned now_at = levels(axis.pins, pins, n);
      if (now_at == axis.before) continue;
      axis.pins.mode == AxisPins::kQuadrature ? turn(n, axis, now_at) : change(n, axis, now_at);
      axis.before = now_at;
    }
  }

  // The first violation at a pin; empty: none.
  std::string error;
  std::vector<Pulse> pulses;  // since the first begin()
  Place place{};
  std::uint64_t last_change = 0;  // clock of the last change of any STEP pin
  std::vector<OutputChange> output_changes;
  // The position at a clock.
  Place place_at(std::uint64_t clock) const {
    Place at{};
    for (const Pulse& pulse : pulses) {
      if (pulse.clock <= clock) at[pulse.axis] += pulse.direction;
    }
    return at;
  }
  bool pulse_under_way() const {
    for (const Axis& axis : states_) {
      if (axis.pins.mode != AxisPins::kQuadrature && active(axis.pins, axis.before)) return true;
    }
    return false;
  }

 private:
  struct Axis {
    AxisPins pins;
    unsigned before = 0;  // levels without their inversion: [0] first pin, [1] second
    int direction = 0;    // direction of the last pulse; 0: none yet
    std::uint64_t leading = 0;
    std::uint64_t trailing = 0;
    std::uint64_t turned = 0;  // clock of the last change of DIR
  };

  static unsigned levels(const AxisPins& axis, const StepPins& pins, unsigned n) {
    const unsigned both = (pins.first >> n & 1U) | (pins.second >> n & 1U) << 1;
    return axis.inverted ? both ^ 3U : both;
  }
  static bool active(const AxisPins& axis, unsigned at) {
    return axis.mode == AxisPins::kStepDir ? (at & 1U) != 0 : at != 0;
  }

  void complain(unsigned axis, const std::string& what) {
    if (error.empty()) error = "axis " + std::to_string(axis) + ", clock " + std::to_string(now_) + ": " + what;
  }
  void require(unsigned axis, const char* what, std::uint64_t since, std::uint64_t least) {
    if (now_ - since < least)
      complain(axis, std::string(what) + " of " + std::to_string(now_ - since) + " clocks, " + std::to_string(least) +
                         " are promised");
  }

  void pulse(unsigned n, Axis& axis, int direction) {
    if (axis.direction == direction) require(n, "a pulse after another", axis.leading, axis.pins.turnover());
    if (axis.direction == -direction) require(n, "a reversal", axis.trailing, axis.pins.reversal());
    axis.direction = direction;
    axis.leading = now_;
    place[n] += direction;
    pulses.push_back({now_, n, direction});
  }
  // Modes step and direction, and up and down.
  void change(unsigned n, Axis& axis, unsigned at) {
    const bool was = active(axis.pins, axis.before);
    const bool is = active(axis.pins, at);
    const bool steps = axis.pins.mode == AxisPins::kStepDir;
    if (!steps && at == 3) complain(n, "up and down together");
    if (steps && ((at ^ axis.before) & 2U) != 0) {
      if (was || is) complain(n, "the direction changes beside a pulse");
      if (axis.direction != 0) require(n, "the direction's hold time", axis.trailing, axis.pins.hold);
      axis.turned = now_;
    }
    if (!was && is) {
      if (steps && axis.turned != 0) require(n, "the direction's setup time", axis.turned, axis.pins.setup);
      pulse(n, axis, steps ? ((at & 2U) != 0 ? -1 : 1) : (at == 1 ? 1 : -1));
    }
    if (was && is && !steps) complain(n, "a pulse changes its direction");
    if (was && !is) {
      require(n, "a pulse", axis.leading, axis.pins.shortest());
      axis.trailing = now_;
    }
  }
  // A leads in the positive direction: 00, 10, 11, 01 as AB. In quadrature a pulse has only one edge.
  void turn(unsigned n, Axis& axis, unsigned at) {
    static constexpr std::array<unsigned, 4> kPlace{0, 1, 3, 2};  // by levels {B, A}
    const unsigned moved = (kPlace[at] - kPlace[axis.before]) & 3U;
    if (moved == 2) complain(n, "A and B together");
    pulse(n, axis, moved == 1 ? 1 : -1);
    axis.trailing = now_ + axis.pins.shortest();
  }

  bool watches_ = false;
  std::uint64_t now_ = 0;
  StepPins last_;
  std::array<Axis, kWatchedAxes> states_;
};

}  // namespace trammel::test
