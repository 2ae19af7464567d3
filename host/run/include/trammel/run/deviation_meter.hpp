// Measures how far the executed path deviates from the commanded one, from path steps and commands. The command of an
// arc in chords does not give its centre; the meter takes it from the planner's block. A helix is measured in its
// plane. All steps of a tick are applied before positions are compared.
// The deviation of a line is the perpendicular distance from the straight line between its integer end points, in the
// space of its moving axes. The deviation of an arc is the distance outside the annulus between the radii of its
// integer start and end. The deviation of an ellipse (a circle on axes of unequal steps/mm) is measured in the same way
// from the ellipse that the card is given, to first order. Unit: pulses. Not thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/planner/block.hpp"

namespace trammel::run {

class DeviationMeter {
 public:
  // Announces the block to which the following commands belong.
  void sending(const planner::Block& block);

  // Announces a command in stream order; `number` is its unwrapped number. Only path commands are kept.
  void command(std::uint64_t number, const driver::Command& command);

  // One step of the path: command number, tick within the path, axis, direction (+1 or -1).
  void step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction);

  // Call once after the last step.
  void finish();

  // Where the largest deviation occurred: program line, and machine coordinates in pulses.
  struct Place {
    std::size_t line = 0;  // 0: no deviation
    planner::Pulses position{};
  };
  double largest_line() const { return largest_line_; }
  double largest_arc() const { return largest_arc_; }
  const Place& line_place() const { return line_place_; }
  const Place& arc_place() const { return arc_place_; }

 private:
  struct Path {
    std::uint64_t number = 0;
    std::size_t line = 0;  // line of the program
    bool arc = false;
    std::array<unsigned, card_map::kMaxAxes> axes{};  // indices of the moving axes
    unsigned axis_count = 0;
    bool of_machine = false;                          // the centre is still in machine coordinates
    std::array<double, card_map::kMaxAxes> target{};  // line: displacement; arc: centre relative to the start (x, y)
    double inner = 0;                                 // arc: radii of the annulus
    double outer = 0;
    double length = 0;  // line: length of the displacement
    double semi_x = 0;  // semi-axis of an ellipse; 0: a circle
    double semi_y = 0;
    // For an arc: a point's distance from the centre, or from the ellipse.
    double level(double x, double y) const;
  };
  void measure();
  void look(double deviation, double& largest, Place& place) const;
  void enter(std::uint64_t command);
  Path arc_in_chords() const;

  std::deque<Path> paths_;
  std::array<std::int64_t, card_map::kMaxAxes> position_{};  // relative to the current path's start
  std::optional<planner::Pulses> machine_;                   // the position in machine coordinates; set at the first
                                                             // block
  planner::Block block_;                                     // block that is being sent
  std::optional<std::uint64_t> tick_;
  double largest_line_ = 0;
  double largest_arc_ = 0;
  Place line_place_;
  Place arc_place_;
};

}  // namespace trammel::run
