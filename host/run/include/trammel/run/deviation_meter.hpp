// Measures how far the executed path strays from the commanded one, from path steps and commands alone.
// Definitions (design of the JSON summary): positions are compared after all steps of a tick; a line's deviation is
// the perpendicular distance from the straight line between its integer end points, in the space of its moving axes;
// an arc's is the distance outside the annulus between the radii of its integer start and end. Unit: pulses.
// Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::run {

class DeviationMeter {
 public:
  // Announces a command in stream order; `number` is its unwrapped number. Only LINE and ARC are kept.
  void command(std::uint64_t number, const driver::Command& command);

  // One step of the path: command number, tick within the path, axis, direction (+1 or -1).
  void step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction);

  // Call once after the last step.
  void finish();

  double largest_line() const { return largest_line_; }
  double largest_arc() const { return largest_arc_; }

 private:
  struct Path {
    std::uint64_t number = 0;
    bool arc = false;
    std::array<unsigned, card_map::kMaxAxes> axes{};  // indices of the moving axes
    unsigned axis_count = 0;
    std::array<double, card_map::kMaxAxes> target{};  // line: displacement; arc: centre relative to the start (x, y)
    double inner = 0;                                 // arc: radii of the annulus
    double outer = 0;
    double length = 0;  // line: length of the displacement
  };
  void measure();
  void enter(std::uint64_t command);

  std::deque<Path> paths_;
  std::array<std::int64_t, card_map::kMaxAxes> position_{};  // relative to the current path's start
  std::optional<std::uint64_t> tick_;
  double largest_line_ = 0;
  double largest_arc_ = 0;
};

}  // namespace trammel::run
