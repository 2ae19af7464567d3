// Moves axes until the edges of their switches have occurred. Internal to homing.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/machine_position.hpp"

namespace trammel::run {

// An edge to search for.
struct WantedEdge {
  std::size_t axis = 0;   // axis of the machine
  unsigned motor = 0;     // axis of the card that the switch belongs to
  unsigned input = 0;     // input of the card
  const char* name = "";  // name of its role, "home" or "index"
  double velocity = 0;    // mm/s of the axis, signed
  double distance = 0;    // mm, > 0, within which the edge must occur
  double bound = 0;       // initial value of `distance`, mm, for messages
  double squaring = 0;    // mm, bound for the other motors of the axis after this edge; 0: no bound of their own
  bool to_active = true;
  bool at_speed = false;  // ignored until the axis has its speed
};
struct FoundEdge {
  WantedEdge wanted;
  planner::Pulses at{};  // motor positions at the edge, pulses as in MachinePosition
};

// The position must equal the card's, and nothing else may move the card. Not thread-safe.
class SwitchSearch {
 public:
  // `machine`: without soft limits. All three must outlive the search.
  SwitchSearch(driver::Card& card, const machine::Machine& machine, MachinePosition& position)
      : card_(card), machine_(machine), position_(position) {}

  // All axes move on one path, each at its velocity. The first edge ramps all axes to a stop; those whose edge has not
  // occurred then go on. At an edge into a switch the card ramps (by the role of the probe outside probing); at any
  // other edge this program stops the motion when it sees the edge. Throws HomingError if an edge does not occur within
  // its distance, or if a switch already has the level; otherwise throws as run::Jog.
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
