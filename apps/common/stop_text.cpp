#include "stop_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "trammel/card_map.hpp"
#include "trammel/run/end_position.hpp"

namespace trammel::app {
namespace {

namespace field = card_map::field;

constexpr std::uint16_t kMapMinorOfRest = 4;

bool has(std::uint8_t mask, std::size_t n) { return (std::uint32_t{mask} >> n & 1U) != 0; }

// The name of the card's axis n: limits and drives have the numbers of the machine's axes.
std::string name_of(const machine::Machine& machine, std::size_t n) {
  return n < machine.axes.size() ? std::string(1, machine.axes[n].letter) : fmt::format("axis {}", n);
}

// If the place was lost, the operator must confirm that the machine may be moved.
std::string jog_options(const machine::Machine& machine, const StoppedCard& card) {
  const bool lost = card.place.was_set() && !run::axes_without(machine, card.place.bits.valid).empty();
  return lost ? " --clear-faults --trust-position" : " --clear-faults";
}

std::string jog_away(const machine::Machine& machine, const StoppedCard& card, std::size_t n, bool from_plus,
                     const char* further) {
  constexpr int kAway = 5;
  const std::string jog = n < machine.axes.size() ? fmt::format(", for example with `trammel jog {}{}{}{}{}` ({} {})",
                                                                machine.axes[n].letter, from_plus ? "-" : "", kAway,
                                                                jog_options(machine, card), further, kAway,
                                                                run::unit_of(machine.axes[n].letter))
                                                  : "";
  return fmt::format("move it towards {}{}", from_plus ? "minus" : "plus", jog);
}

// Whether the axis is X or Y of CoreXY: while a limit of either is active, steps of both are barred.
bool shares_motors(const machine::Machine& machine, std::size_t n) {
  if (machine.kinematics.name != "corexy" || n >= machine.axes.size()) return false;
  return machine.axes[n].letter == 'X' || machine.axes[n].letter == 'Y';
}

std::string limit_cure(const machine::Machine& machine, const StoppedCard& card, std::size_t n) {
  const bool plus = has(card.limits.plus, n);
  const std::string axis = name_of(machine, n);
  if (plus && has(card.limits.minus, n)) {
    return fmt::format(
        "{} is at a limit switch, and the card does not know at which end, so both directions are barred. Look where "
        "the axis is, and move it away with `trammel jog`, --clear-faults and --override-limits",
        axis);
  }
  const std::string at = fmt::format("{} has stepped into its limit at the {} end: ", axis, plus ? "plus" : "minus");
  if (shares_motors(machine, n)) {
    return at + jog_away(machine, card, n, plus, " --override-limits") +
           "; without --override-limits every step of X and Y is barred, since both motors move each of them";
  }
  return at + jog_away(machine, card, n, plus, "") + "; only steps further into it are barred";
}

std::string drive_cure(const machine::Machine& machine, std::size_t n) {
  return fmt::format("the drive of {} reports a fault: clear it at the drive, then give --clear-faults",
                     name_of(machine, n));
}

// Whether the card is still at the recorded stop. After an abort in motion, the steps of the executed ticks and the
// pulses in the shapers may follow: seven and five per axis.
bool stands_there(const driver::Rest& rest, const driver::Snapshot& now) {
  const std::int32_t behind = rest.exact() ? 0 : 7 + 5;
  for (std::size_t n = 0; n < now.position.size(); ++n) {
    if (std::abs(driver::pulses_between(rest.position[n], now.position[n])) > behind) return false;
  }
  return true;
}

}  // namespace

StoppedCard read_stopped(driver::Card& card) {
  StoppedCard result;
  const driver::Identification& id = card.identification();
  result.place = run::read_card_place(card);
  result.clock_hz = id.clock_hz;
  result.axes = id.axes;
  const driver::Snapshot& now = result.place.now;
  constexpr std::uint32_t kNamed = field::kFaultLimit | field::kFaultDriveFault;  // causes that LIMIT_STATE details
  if ((now.faults & kNamed) != 0) result.limits = card.read_limit_state();
  if (id.map_minor < kMapMinorOfRest || now.status.busy || now.status.stopping) return result;
  const driver::Rest rest = card.read_rest();
  if (rest.time != 0 && stands_there(rest, now)) result.rest = rest;
  return result;
}

std::string standing_text(const machine::Machine& machine, const StoppedCard& card) {
  const auto* const first = card.place.now.position.begin();
  const std::string pulses = fmt::format("pulses {}", fmt::join(first, first + card.axes, ", "));
  if (!card.place.was_set() || !run::scales_fit(card.place, machine)) return pulses + " of its axes";
  return fmt::format("{} ({})", run::place_text(run::standing_at(machine, card.place), machine), pulses);
}

std::string path_text(const driver::Rest& rest, std::uint32_t clock_hz) {
  if (!rest.exact()) return "at an unknown place of its path, because it was stopped immediately while it moved";
  if (rest.status.direct && rest.ticks_left != 0) {
    return fmt::format("in a line of direct mode, {} clocks ({:.4f} s) before its end (exact)", rest.ticks_left,
                       static_cast<double>(rest.ticks_left) / clock_hz);
  }
  if (rest.ticks_left != 0) {
    return fmt::format("in command {} of the geometry queue, {} ticks before its end (exact)", rest.geometry_begun,
                       rest.ticks_left);
  }
  if (rest.geometry_begun == 0) return "before the first command of the geometry queue (exact)";
  return fmt::format("at the end of command {} of the geometry queue, or in its wait (exact)", rest.geometry_begun);
}

std::vector<std::string> fault_cures(const machine::Machine& machine, const StoppedCard& card) {
  std::vector<std::string> cures;
  for (std::size_t n = 0; n < card.axes; ++n) {
    if (has(card.limits.minus | card.limits.plus, n)) cures.push_back(limit_cure(machine, card, n));
    if (has(card.limits.drive_fault, n)) cures.push_back(drive_cure(machine, n));
  }
  if ((card.faults() & card_map::field::kFaultEmergencyStop) != 0) {
    cures.emplace_back(
        "release the button of the emergency stop, then clear the fault with --clear-faults to go on from there");
  }
  if (cures.empty() && card.faults() != 0) {
    cures.emplace_back("remove the cause, and clear the fault with --clear-faults to go on from there");
  }
  return cures;
}

std::string stop_text(const machine::Machine& machine, const StoppedCard& card) {
  const driver::Status& status = card.place.now.status;
  std::string text =
      fmt::format("the card {} {}", status.stopping || status.busy ? "is still stopping on a ramp, at" : "stands at",
                  standing_text(machine, card));
  if (card.rest) text += ", " + path_text(*card.rest, card.clock_hz);
  for (const std::string& cure : fault_cures(machine, card)) text += "; " + cure;
  return text;
}

}  // namespace trammel::app
