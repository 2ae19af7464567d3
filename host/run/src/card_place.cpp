#include "trammel/run/card_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace trammel::run {

namespace {

using kinematics::Kinematics;
using kinematics::Pulses;

std::uint8_t bit(std::size_t axis) { return static_cast<std::uint8_t>(1U << axis); }

// FNV-1a.
std::uint32_t hash_of(const std::string& text) {
  std::uint32_t hash = 2'166'136'261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16'777'619U;
  return hash;
}

Pulses pulses_of(const CardPlace& place, std::size_t joints) {
  Pulses pulses{};
  const auto counted = place.pulses();
  std::copy(counted.begin(), counted.begin() + static_cast<std::ptrdiff_t>(joints), pulses.begin());
  return pulses;
}

[[noreturn]] void refuse_lost(const std::string& axes) {
  throw PlaceError(
      fmt::format("the place of {} was lost: the card stopped at once in a motion, or a drive had a fault; set it "
                  "anew by `trammel zero`, or give --trust-position if you know that no step was lost; `trammel "
                  "recover` tells more",
                  axes));
}

[[noreturn]] void refuse_other_scales() {
  throw PlaceError(
      "the card's place was counted in other scales than those of this machine file: give the machine file that it was "
      "set with, or set machine zero anew by `trammel zero` with all axes");
}

[[noreturn]] void refuse_not_homed(const std::string& axes) {
  throw PlaceError(
      fmt::format("not homed: {}, and the machine file has require_home: bring it to its reference and say so by "
                  "`trammel zero --homed`",
                  axes));
}

std::string card_axes(std::uint8_t axes) {
  std::string text;
  for (std::size_t n = 0; n < card_map::kMaxAxes; ++n) {
    if ((axes & bit(n)) != 0) text += fmt::format("{}{}", text.empty() ? "axis " : ", ", n);
  }
  return text;
}

// Removes the soft limits of the axes in `letters`. Returns the letters of those that had any, separated by blanks.
std::string drop_limits(machine::Machine& machine, const std::string& letters) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::string dropped;
  for (machine::MachineAxis& axis : machine.axes) {
    const bool limited = axis.min > -kNone || axis.max < kNone;
    if (!limited || letters.find(axis.letter) == std::string::npos) continue;
    dropped += fmt::format("{}{}", dropped.empty() ? "" : " ", axis.letter);
    axis.min = -kNone;
    axis.max = kNone;
  }
  return dropped;
}

}  // namespace

std::uint32_t scales_of(const machine::Machine& machine) {
  const Kinematics kinematics(machine);
  std::string text;
  for (const machine::MachineAxis& axis : machine.axes) text += axis.letter;
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    const kinematics::Joint& joint = kinematics.joint(n);
    text += fmt::format(";{}{}", joint.steps_per_mm, joint.inverted ? "-" : "+");
    for (std::size_t i = 0; i < joint.term_count; ++i)
      text += fmt::format(" {}*{}", joint.terms[i].axis, joint.terms[i].factor);
  }
  const std::uint32_t hash = hash_of(text);
  return hash > kScalesInPulses ? hash : hash + 2;
}

bool scales_fit(const CardPlace& place, const machine::Machine& machine) {
  return place.scales <= kScalesInPulses || place.scales == scales_of(machine);
}

gcode::Coordinates standing_at(const machine::Machine& machine, const CardPlace& place) {
  const Kinematics kinematics(machine);
  return kinematics.coordinates(pulses_of(place, kinematics.joints()));
}

std::string axes_without(const machine::Machine& machine, std::uint8_t motors) {
  const Kinematics kinematics(machine);
  unsigned without = 0;
  for (std::size_t n = 0; n < kinematics.joints(); ++n) without |= (motors & bit(n)) != 0 ? 0 : kinematics.axes_of(n);
  std::string text;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if ((without >> i & 1U) != 0) text += fmt::format("{}{}", text.empty() ? "" : " ", machine.axes[i].letter);
  }
  return text;
}

std::uint8_t motors_of(const machine::Machine& machine) {
  return static_cast<std::uint8_t>((1U << machine.motors()) - 1);
}

std::vector<std::string> names_of_card_axes(const machine::Machine& machine) {
  std::vector<std::string> names;
  for (const machine::MachineAxis& axis : machine.axes) names.emplace_back(1, axis.letter);
  for (const std::size_t axis : machine.second_motors()) names.push_back("second motor of " + names[axis]);
  return names;
}

Start start_at(const machine::Machine& machine, const CardPlace& place, bool trust) {
  if (!scales_fit(place, machine)) refuse_other_scales();
  const std::string lost = place.was_set() ? axes_without(machine, place.bits.valid) : "";
  if (!lost.empty() && !trust) refuse_lost(lost);
  const std::string not_homed = axes_without(machine, place.bits.homed);
  if (machine.require_home && !not_homed.empty()) refuse_not_homed(not_homed);
  Start start{standing_at(machine, place), machine, {}};
  start.limits_off = drop_limits(start.machine, not_homed);
  return start;
}

void check_line(const machine::Machine& machine, const CardPlace& place, std::uint8_t moved, bool trust) {
  const auto lost = static_cast<std::uint8_t>(place.was_set() ? moved & ~place.bits.valid : 0);
  if (lost != 0 && !trust) refuse_lost(card_axes(lost));
  const auto not_homed = static_cast<std::uint8_t>(moved & ~place.bits.homed);
  if (machine.require_home && not_homed != 0) refuse_not_homed(card_axes(not_homed));
}

std::string check_line_end(const machine::Machine& machine, const CardPlace& place,
                           const std::vector<std::int64_t>& pulses) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Kinematics kinematics(machine);
  const std::string not_homed = axes_without(machine, place.bits.homed);
  const gcode::Coordinates from = standing_at(machine, place);
  Pulses end = pulses_of(place, kinematics.joints());
  for (std::size_t n = 0; n < std::min(pulses.size(), kinematics.joints()); ++n) end[n] += pulses[n];
  const gcode::Coordinates to = kinematics.coordinates(end);
  std::string off;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const machine::MachineAxis& axis = machine.axes[i];
    if (axis.min == -kNone && axis.max == kNone) continue;
    if (!scales_fit(place, machine) || not_homed.find(axis.letter) != std::string::npos) {
      off += fmt::format("{}{}", off.empty() ? "" : " ", axis.letter);
    } else if (to[i] > std::max(axis.max, from[i]) || to[i] < std::min(axis.min, from[i])) {
      const bool above = to[i] > axis.max;
      throw PlaceError(fmt::format("the line ends at {}{:g}, beyond the axis's {} of {:g} (machine coordinates)",
                                   axis.letter, to[i], above ? "max" : "min", above ? axis.max : axis.min));
    }
  }
  return off;
}

namespace {

constexpr std::uint32_t kFarthest = 0x7FFFFFFF;  // largest distance in pulses that the card can represent

// The range of a motor that moves one axis only; none if the axis has no limits.
std::optional<driver::SoftRange> soft_range(const machine::Machine& machine, const Kinematics& kinematics,
                                            std::size_t motor, std::int32_t zero) {
  const kinematics::Joint& joint = kinematics.joint(motor);
  if (joint.term_count != 1) return std::nullopt;
  const machine::MachineAxis& axis = machine.axes[joint.terms[0].axis];
  const bool has_min = std::isfinite(axis.min);
  const bool has_max = std::isfinite(axis.max);
  if (!has_min && !has_max) return std::nullopt;
  const auto position = [&](double coordinate) {
    gcode::Coordinates at{};
    at[joint.terms[0].axis] = coordinate;
    return static_cast<std::uint32_t>(zero) + static_cast<std::uint32_t>(kinematics.pulses(motor, at));
  };
  const std::uint32_t minus = has_min ? position(axis.min) : position(axis.max) - kFarthest;
  const std::uint32_t plus = has_max ? position(axis.max) : minus + kFarthest;
  return driver::SoftRange{static_cast<std::int32_t>(minus), static_cast<std::int32_t>(plus)};
}

}  // namespace

void guard_soft_limits(driver::Card& card, const machine::Machine& machine, const CardPlace& place) {
  if (!card.has_soft_limits()) return;
  const Kinematics kinematics(machine);
  // A line can run on a card with fewer axes than the machine has motors.
  std::vector<std::optional<driver::SoftRange>> ranges(
      std::min<std::size_t>(kinematics.joints(), card.identification().axes));
  for (std::size_t n = 0; n < ranges.size(); ++n) {
    const bool known = (place.bits.valid & bit(n)) != 0 && scales_fit(place, machine);
    if (known) ranges[n] = soft_range(machine, kinematics, n, place.zero[n]);
  }
  card.set_soft_limit_ramps(machine.inputs.on_soft_limit == machine::OnInput::kRamp);
  card.set_soft_limits(ranges);
}

void guard_homed_axes(driver::Card& card, const machine::Machine& machine, const CardPlace& place) {
  machine::Machine homed = machine;
  drop_limits(homed, axes_without(machine, place.bits.homed));
  guard_soft_limits(card, homed, place);
}

namespace {

// Bit n: axis n of the machine.
unsigned named_axes(const machine::Machine& machine, const std::string& letters) {
  unsigned named = 0;
  for (const char letter : letters) {
    const auto axis = machine.axis(letter);
    if (!axis) throw PlaceError(fmt::format("zero: the machine has no axis {}", letter));
    named |= 1U << *axis;
  }
  return named;
}

unsigned all_axes(const machine::Machine& machine) { return (1U << machine.axes.size()) - 1; }

// The motors that move with a named axis.
std::uint8_t motors_with(const Kinematics& kinematics, unsigned named) {
  std::uint8_t motors = 0;
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    if ((kinematics.axes_of(n) & named) != 0) motors |= bit(n);
  }
  return motors;
}

// Refuses to name only some of the axes of a motor whose place was lost: its position then follows only from the
// coordinates of all of them.
void check_shared(const machine::Machine& machine, const Kinematics& kinematics, const CardPlace& place,
                  std::uint8_t motors, unsigned named) {
  if (!place.was_set()) return;
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    const bool lost = (motors & ~place.bits.valid & bit(n)) != 0;
    if (!lost || (kinematics.axes_of(n) & ~named) == 0) continue;
    throw PlaceError(fmt::format("zero: the place of {} was lost, and they share motors: name them together",
                                 axes_without(machine, static_cast<std::uint8_t>(~bit(n)))));
  }
}

// The new machine coordinates. If all axes are named, the previous ones have no effect.
gcode::Coordinates counted_at(const machine::Machine& machine, const CardPlace& place, unsigned named,
                              const gcode::Coordinates& wanted) {
  if (named == all_axes(machine)) return wanted;
  gcode::Coordinates at = standing_at(machine, place);
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if ((named >> i & 1U) != 0) at[i] = wanted[i];
  }
  return at;
}

}  // namespace

// The motors have no valid place until everything is written, so an interrupted call leaves a place that counts as
// lost.
void place_axes(driver::Card& card, const machine::Machine& machine, unsigned named, const gcode::Coordinates& at,
                std::uint8_t homed) {
  const Kinematics kinematics(machine);
  const CardPlace place = read_card_place(card);
  const std::uint8_t motors = motors_with(kinematics, named);
  if (!scales_fit(place, machine) && named != all_axes(machine)) refuse_other_scales();
  check_shared(machine, kinematics, place, motors, named);
  const gcode::Coordinates counted = counted_at(machine, place, named, at);
  if (!place.was_set()) keep_place(card, place, kScalesInPulses, 0);
  card.set_place(motors, false, false);
  if (card.has_soft_limits()) card.set_soft_limits({});  // they were relative to the previous machine zero
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    if ((motors & bit(n)) == 0) continue;
    const auto away = static_cast<std::uint32_t>(kinematics.pulses(n, counted));
    card.set_machine_zero(static_cast<unsigned>(n),
                          static_cast<std::int32_t>(static_cast<std::uint32_t>(place.now.position[n]) - away));
  }
  card.set_scales(scales_of(machine));
  const auto now_homed = static_cast<std::uint8_t>(motors & homed);
  const auto others = static_cast<std::uint8_t>(motors & ~homed);
  if (others != 0) card.set_place(others, true, false);
  if (now_homed != 0) card.set_place(now_homed, true, true);
}

void set_zero(driver::Card& card, const machine::Machine& machine, const std::string& letters, bool homed) {
  place_axes(card, machine, named_axes(machine, letters), {}, homed ? motors_of(machine) : 0);
}

}  // namespace trammel::run
