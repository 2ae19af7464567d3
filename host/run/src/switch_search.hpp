// Axes that move until the edges of their switches have come. Internal to homing.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/machine_position.hpp"

namespace trammel::run {

// An edge that is looked for.
struct WantedEdge {
  std::size_t axis = 0;   // of the machine
  unsigned motor = 0;     // axis of the card that the switch belongs to
  unsigned input = 0;     // of the card
  const char* name = "";  // of its role, "home", "index"
  double velocity = 0;    // mm/s of the axis, signed
  double distance = 0;    // mm, > 0, in which it must come
  double bound = 0;       // of these, for messages: as they were at first
  double squaring = 0;    // mm, that the others of the same axis may come later; 0: they have no bound of their own
  bool to_active = true;
  bool at_speed = false;  // not looked at before the axis has its speed
};
struct FoundEdge {
  WantedEdge wanted;
  planner::Pulses at{};  // where the motors stood, pulses as the MachinePosition counts them
};

// The position must be the card's, and nobody else moves the card. Not thread-safe.
class SwitchSearch {
 public:
  // `machine`: without soft limits. All must outlive the search.
  SwitchSearch(driver::Card& card, const machine::Machine& machine, MachinePosition& position)
      : card_(card), machine_(machine), position_(position) {}

  // All axes move on one path, each at its velocity; the first edge ramps all of them to a stop, and those whose edge
  // has not come go on. An edge into a switch ramps in the card (by the role of the probe outside probing), any other
  // when this program sees it. Throws HomingError where an edge does not come in its distance, and where a switch has
  // the level already; else as run::Jog.
  std::vector<FoundEdge> find(std::vector<WantedEdge> wanted);

 private:
  void arm(const std::vector<WantedEdge>& wanted);
  void disarm(std::size_t units);
  void check_levels(const std::vector<WantedEdge>& wanted);
  void move(const std::vector<WantedEdge>& wanted);
  double move_to_speed(const std::vector<WantedEdge>& wanted) const;
  void stop_behind_the_edge();
  bool any_captured(std::size_t units);
  void wait_for_filters(std::size_t units);
  std::vector<FoundEdge> take(std::vector<WantedEdge>& wanted);
  void shorten(std::vector<WantedEdge>& wanted, const gcode::Coordinates& from,
               const std::vector<FoundEdge>& found) const;
  [[noreturn]] void fail(const WantedEdge& missing) const;
  void sleep(double seconds);

  driver::Card& card_;
  const machine::Machine& machine_;
  MachinePosition& position_;
};

}  // namespace trammel::run
