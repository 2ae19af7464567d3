#include "switch_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/homing.hpp"
#include "trammel/run/jog.hpp"

namespace trammel::run {
namespace {

constexpr double kLook = 0.002;          // s, polling interval
constexpr double kFilterMargin = 0.002;  // s, added to the longest filter, for scans and snapshots

std::string letter_of(const machine::Machine& machine, const WantedEdge& edge) {
  const bool second = edge.motor >= machine.axes.size();
  return fmt::format("{}{}", machine.axes[edge.axis].letter, second ? ", second motor" : "");
}

std::string name_of(const machine::Machine& machine, const WantedEdge& edge) {
  return fmt::format("{}: its {} switch at input {}", letter_of(machine, edge), edge.name, edge.input);
}

}  // namespace

void SwitchSearch::sleep(double seconds) { card_.bus().sleep(std::chrono::nanoseconds(std::llround(seconds * 1e9))); }

// Refuses an edge whose level is already present, because it would never occur. An index mark is passed during the
// motion, so its level does not matter.
void SwitchSearch::check_levels(const std::vector<WantedEdge>& wanted) {
  const std::uint32_t levels = card_.read_inputs();
  for (const WantedEdge& edge : wanted) {
    if (std::string(edge.name) == "index" || edge.at_speed) continue;
    if (((levels >> edge.input & 1U) != 0) != edge.to_active) continue;
    throw HomingError(fmt::format("{} is {} before the axis moves: look at the switch, its wiring and `normally`",
                                  name_of(machine_, edge), edge.to_active ? "pressed" : "free"));
  }
}

void SwitchSearch::arm(const std::vector<WantedEdge>& wanted) {
  if (wanted.size() > card_.captures_present()) {
    throw HomingError(
        fmt::format("{} switches at once, and the card has {} capture units: give the axes different "
                    "numbers in `sequence`",
                    wanted.size(), card_.captures_present()));
  }
  std::uint32_t into = 0;
  for (unsigned unit = 0; unit < wanted.size(); ++unit) {
    driver::CaptureSelect select;
    select.input = wanted[unit].input;
    select.to_active = wanted[unit].to_active;
    select.to_inactive = !wanted[unit].to_active;
    card_.select_capture(unit, select);
    if (wanted[unit].to_active) into |= 1U << wanted[unit].input;
  }
  card_.set_role(driver::CardRole::kProbe, into);
}

void SwitchSearch::disarm(std::size_t units) {
  card_.set_role(driver::CardRole::kProbe, 0);
  for (unsigned unit = 0; unit < units; ++unit) card_.stop_capture(unit);
}

bool SwitchSearch::any_captured(std::size_t units) {
  const driver::CaptureStates states = card_.read_captures();
  return std::any_of(states.units.begin(), states.units.begin() + static_cast<std::ptrdiff_t>(units),
                     [](const driver::CaptureState& state) { return state.valid; });
}

// Seconds from rest until all axes have their speed, plus 10% for the rounding of the pieces.
double SwitchSearch::move_to_speed(const std::vector<WantedEdge>& wanted) const {
  double seconds = 0;
  for (const WantedEdge& edge : wanted)
    seconds = std::max(seconds, 1.1 * std::abs(edge.velocity) / machine_.axes[edge.axis].max_acceleration);
  return seconds;
}

// The card ramps to a stop by itself and is at rest before the fault is cleared.
void SwitchSearch::stop_behind_the_edge() {
  if (card_.read_faults() != card_map::field::kFaultProbe) return;
  card_.wait_until_stopped();
  card_.set_role(driver::CardRole::kProbe, 0);
  card_.clear_faults();
  position_.look(card_.read_snapshot());
}

void SwitchSearch::move(const std::vector<WantedEdge>& wanted) {
  double seconds = std::numeric_limits<double>::infinity();
  for (const WantedEdge& edge : wanted) seconds = std::min(seconds, edge.distance / std::abs(edge.velocity));
  gcode::Coordinates distance{};
  double square = 0;
  for (const WantedEdge& edge : wanted) distance[edge.axis] = edge.velocity * seconds;
  for (const double way : distance) square += way * way;
  const bool at_speed = std::any_of(wanted.begin(), wanted.end(), [](const auto& edge) { return edge.at_speed; });
  // At an edge into a switch the card ramps by itself; at an edge off a switch there is room for the later stop by this
  // program.
  const bool stops_here = !wanted.front().to_active;
  const std::uint32_t slew = card_.parts().registers.read(card_map::reg::kSlew);
  if (!at_speed) arm(wanted);
  Jog jog(card_, machine_, position_);
  jog.start(distance, std::sqrt(square) / seconds);
  try {
    if (at_speed) {
      for (double passed = 0; passed < move_to_speed(wanted) && jog.moving(); passed += kLook) sleep(kLook);
      arm(wanted);
    }
    while (jog.moving()) {
      if (stops_here && any_captured(wanted.size())) jog.stop();
      sleep(kLook);
    }
  } catch (const driver::FaultError&) {
    stop_behind_the_edge();
    if (card_.read_faults() != 0) throw;
    card_.parts().registers.write(card_map::reg::kSlew, slew, "homing");
  }
}

// Waits until no filter is still delaying an edge, which would be missed otherwise.
void SwitchSearch::wait_for_filters(std::size_t units) {
  double longest = machine_.inputs.filter;
  for (const machine::InputRole& role : machine_.inputs.roles) longest = std::max(longest, role.filter.value_or(0));
  for (double passed = 0; passed < longest / 1000 + kFilterMargin; passed += kLook) {
    const driver::CaptureStates states = card_.read_captures();
    const bool pending = std::any_of(states.units.begin(), states.units.begin() + static_cast<std::ptrdiff_t>(units),
                                     [](const driver::CaptureState& state) { return state.pending; });
    if (!pending) return;
    sleep(kLook);
  }
}

// Returns the captured edges and removes them from `wanted`.
std::vector<FoundEdge> SwitchSearch::take(std::vector<WantedEdge>& wanted) {
  std::vector<FoundEdge> found;
  std::vector<WantedEdge> left;
  for (unsigned unit = 0; unit < wanted.size(); ++unit) {
    const std::optional<driver::Capture> capture = card_.take_capture(unit);
    if (!capture) {
      left.push_back(wanted[unit]);
      continue;
    }
    MachinePosition at_edge = position_;
    at_edge.look(capture->at);
    found.push_back({wanted[unit], at_edge.pulses()});
  }
  wanted = left;
  return found;
}

// Reduces the distances by the motion made. After the edge of one motor of an axis, the other motor has its own bound.
void SwitchSearch::shorten(std::vector<WantedEdge>& wanted, const gcode::Coordinates& from,
                           const std::vector<FoundEdge>& found) const {
  const kinematics::Kinematics kinematics(machine_);
  const gcode::Coordinates to = position_.millimetres();
  for (WantedEdge& later : wanted) {
    later.distance -= std::abs(to[later.axis] - from[later.axis]);
    for (const FoundEdge& edge : found) {
      if (edge.wanted.axis != later.axis || edge.wanted.squaring == 0) continue;
      later.bound = edge.wanted.squaring;
      const double behind = std::abs(to[later.axis] - kinematics.coordinates(edge.at)[later.axis]);
      later.distance = std::min(later.distance, later.bound - behind);
    }
    if (later.distance <= 0) fail(later);
  }
}

void SwitchSearch::fail(const WantedEdge& missing) const {
  throw HomingError(fmt::format("{} did not become {} within {:.4g} mm at {:g} mm/s", name_of(machine_, missing),
                                missing.to_active ? "active" : "free", missing.bound, std::abs(missing.velocity)));
}

std::vector<FoundEdge> SwitchSearch::find(std::vector<WantedEdge> wanted) {
  std::vector<FoundEdge> all;
  for (WantedEdge& edge : wanted) edge.bound = edge.distance;
  while (!wanted.empty()) {
    check_levels(wanted);
    const std::size_t units = wanted.size();
    const gcode::Coordinates from = position_.millimetres();
    move(wanted);
    wait_for_filters(units);
    const std::vector<FoundEdge> found = take(wanted);
    disarm(units);
    if (found.empty()) {
      fail(*std::min_element(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) {
        return a.distance / std::abs(a.velocity) < b.distance / std::abs(b.velocity);
      }));
    }
    shorten(wanted, from, found);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace trammel::run
