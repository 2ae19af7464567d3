#include "trammel/bindings/homing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"

namespace trammel::bindings {
namespace {

std::vector<std::size_t> axes_of(const std::string& letters, const machine::Machine& machine) {
  std::vector<std::size_t> axes;
  for (const char c : letters) {
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto axis = machine.axis(letter);
    if (!axis) throw driver::ArgumentError(fmt::format("home: the machine has no axis {}", letter));
    if (std::find(axes.begin(), axes.end(), *axis) == axes.end()) axes.push_back(*axis);
  }
  for (std::size_t n = 0; letters.empty() && n < machine.axes.size(); ++n) {
    if (machine.axes[n].homing) axes.push_back(n);
  }
  if (axes.empty()) throw driver::ArgumentError("home: no axis of the machine file has a [homing]");
  return axes;
}

void require_motors(const driver::Card& card, const machine::Machine& machine) {
  const std::size_t motors = kinematics::Kinematics(machine).joints();
  const unsigned axes = card.identification().axes;
  if (motors <= axes) return;
  throw driver::ArgumentError(fmt::format("the machine has {} motors, and the card {} axes", motors, axes));
}

run::CardPlace place_in(driver::Card& card, const machine::Machine& machine) {
  run::CardPlace place = run::read_card_place(card);
  if (place.was_set() && !run::scales_fit(place, machine)) {
    throw driver::StateError("the card's place was counted in other scales than those of this machine file");
  }
  return place;
}

// Converts errors of machine:: to errors of the driver, which the callers know.
template <class Call>
auto as_argument(Call call) {
  try {
    return call();
  } catch (const machine::MachineError& error) {
    throw driver::ArgumentError(error.what());
  }
}

}  // namespace

machine::Machine load_machine(const std::string& file) {
  return as_argument(
      [&] { return file.empty() || file == "default" ? machine::default_machine() : machine::load_machine(file); });
}

void change_machine(machine::Machine& machine, const std::string& entry) {
  as_argument([&] { machine::apply_override(machine, entry); });
}

void configure(driver::Card& card, const machine::Machine& machine) {
  require_motors(card, machine);
  run::configure(card, machine);
  run::set_keeps_place(card, machine);
}

std::vector<run::HomedAxis> home(driver::Card& card, const machine::Machine& machine, const std::string& letters,
                                 const std::function<void(const std::string&)>& say) {
  const std::vector<std::size_t> axes = axes_of(letters, machine);
  require_motors(card, machine);
  const gcode::Coordinates at = run::standing_at(machine, place_in(card, machine));
  // Also refuses a card that is still slowing down to a hold: nothing would move, and the wait would not end.
  if (card.read_status().held || card.parts().time_base.hold()) {
    throw driver::HeldError("home: the card holds: take it over, or end the hold");
  }
  configure(card, machine);
  run::MachinePosition position(card.read_snapshot(), machine);
  for (std::size_t n = 0; n < machine.axes.size(); ++n) position.set(n, at[n]);
  return run::home(card, machine, position, axes, {say});
}

std::vector<double> read_coordinates(driver::Card& card, const machine::Machine& machine) {
  require_motors(card, machine);
  const gcode::Coordinates at = run::standing_at(machine, place_in(card, machine));
  return {at.begin(), at.begin() + static_cast<std::ptrdiff_t>(machine.axes.size())};
}

std::vector<std::int64_t> pulses_of(const machine::Machine& machine, const std::vector<double>& way) {
  if (way.size() > machine.axes.size()) {
    throw driver::ArgumentError(fmt::format("a way of {} axes: the machine has {}", way.size(), machine.axes.size()));
  }
  constexpr double kLongest = 1e6;  // mm, so that pulses fit
  kinematics::Coordinates at{};
  for (std::size_t n = 0; n < way.size(); ++n) {
    if (!(std::abs(way[n]) <= kLongest)) throw driver::ArgumentError(fmt::format("a way of {} mm", way[n]));
    at[n] = way[n];
  }
  const kinematics::Kinematics kinematics(machine);
  const kinematics::Pulses pulses = kinematics.pulses(at);
  return {pulses.begin(), pulses.begin() + static_cast<std::ptrdiff_t>(kinematics.joints())};
}

}  // namespace trammel::bindings
