// Filters, roles and stops of the card's inputs: reads and writes of their registers.
#include <fmt/format.h>

#include <utility>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

constexpr unsigned kScanClocks = 64;
constexpr std::uint32_t kLongestFilter = 0xFFFF;  // scans

void require_machine_inputs(const Identification& card, std::string_view what) {
  if (card_map::has_engine(card.engines, card_map::engine::kMachineInputs)) return;
  throw ArgumentError(fmt::format("{}: needs {}, which the card does not have (engines 0x{:X})", what,
                                  card_map::kEngineNames[card_map::engine::kMachineInputs], card.engines));
}

std::uint8_t axes_in(std::uint32_t value, std::uint32_t shift) { return static_cast<std::uint8_t>(value >> shift); }

void check_present(std::uint64_t mask, unsigned present, const std::string& what, const char* of) {
  if (mask >> present == 0) return;
  throw ArgumentError(fmt::format("{}: 0x{:X}: the card has {} {}", what, mask, present, of));
}

std::uint32_t reaction_of(const InputStops& stops) {
  return (stops.limit_ramps ? field::kStopReactionLimit : 0) |
         (stops.drive_fault_ramps ? field::kStopReactionDriveFault : 0) |
         (stops.probe_ramps ? field::kStopReactionProbe : 0) |
         (stops.tool_setter_ramps ? field::kStopReactionToolSetter : 0);
}

constexpr std::uint32_t kReactions = field::kStopReactionLimit | field::kStopReactionDriveFault |
                                     field::kStopReactionProbe | field::kStopReactionToolSetter;

}  // namespace

std::string role_name(Role role) {
  constexpr const char* kOfAxes[] = {"limit minus", "limit plus", "home", "index", "drive fault", "in position"};
  constexpr const char* kOfCard[] = {"probe", "tool setter", "feed hold", "cycle start", "spindle at speed"};
  if (role.of_an_axis()) return fmt::format("{} of axis {}", kOfAxes[role.number() / 8], role.axis());
  const unsigned number = role.number() - static_cast<unsigned>(CardRole::kProbe);
  return number < std::size(kOfCard) ? kOfCard[number] : fmt::format("role {}", role.number());
}

std::uint32_t Card::read_raw_inputs() {
  require_machine_inputs(identification(), "inputs before their filters");
  return parts_->registers.read(reg::kRawInputs);
}

std::uint32_t Card::filter_scans(std::chrono::nanoseconds time, std::uint32_t clock_hz) {
  const std::uint64_t clocks = clocks_of(time, clock_hz, "input filter");
  const std::uint64_t scans = clocks / kScanClocks + (clocks % kScanClocks != 0 ? 1 : 0);
  if (scans > kLongestFilter) {
    throw ArgumentError(fmt::format("input filter: {} ns are {} scans of {} clocks at {} Hz; at most {}", time.count(),
                                    scans, kScanClocks, clock_hz, kLongestFilter));
  }
  return static_cast<std::uint32_t>(scans);
}

void Card::set_input_filter(unsigned input, std::chrono::nanoseconds time) {
  require_machine_inputs(identification(), "input filter");
  const std::uint32_t scans = filter_scans(time, identification().clock_hz);
  const unsigned present = inputs_present();
  if (input >= present) {
    throw ArgumentError(fmt::format("filter of input {}: the card has {} inputs", input, present));
  }
  parts_->registers.write(reg::input_filter(input), scans, "input filter");
}

std::chrono::nanoseconds Card::read_input_filter(unsigned input) {
  require_machine_inputs(identification(), "input filter");
  if (input >= 32) throw ArgumentError(fmt::format("filter of input {}: there are 32", input));
  const std::uint32_t scans = parts_->registers.read(reg::input_filter(input));
  Registers::check_read({reg::input_filter(input), scans});
  return time_of(std::uint64_t{scans} * kScanClocks, identification().clock_hz);
}

void Card::set_role(Role role, std::uint32_t inputs) {
  require_machine_inputs(identification(), "roles of inputs");
  if (role.of_an_axis() && role.axis() >= identification().axes) {
    throw ArgumentError(fmt::format("{}: the card has {} axes", role_name(role), identification().axes));
  }
  if (inputs != 0) check_present(inputs, inputs_present(), fmt::format("inputs of {}", role_name(role)), "inputs");
  parts_->registers.write(reg::role(role.number()), inputs, "role of inputs");
}

std::uint32_t Card::read_role(Role role) {
  require_machine_inputs(identification(), "roles of inputs");
  return parts_->registers.read(reg::role(role.number()));
}

ActiveRoles Card::read_roles() {
  require_machine_inputs(identification(), "roles of inputs");
  const std::uint32_t now = parts_->registers.read(reg::kRoles);
  Registers::check_read({reg::kRoles, now});
  return {axes_in(now, field::kRolesLimitMinusShift),
          axes_in(now, field::kRolesLimitPlusShift),
          axes_in(now, field::kRolesDriveFaultShift),
          (now & field::kRolesFeedHold) != 0,
          (now & field::kRolesCycleStart) != 0,
          (now & field::kRolesToolSetter) != 0,
          (now & field::kRolesProbe) != 0};
}

LimitState Card::read_limit_state() {
  require_machine_inputs(identification(), "limit state");
  const std::uint32_t state = parts_->registers.read(reg::kLimitState);
  Registers::check_read({reg::kLimitState, state});
  return {axes_in(state, field::kLimitStateMinusShift), axes_in(state, field::kLimitStatePlusShift),
          axes_in(state, field::kLimitStateDriveFaultShift),
          static_cast<std::uint8_t>((state & field::kLimitStateSoftAxis) >> field::kLimitStateSoftAxisShift),
          (state & field::kLimitStateSoftPlus) != 0};
}

void Card::name_axes(std::vector<std::string> names) { parts_->registers.name_axes(std::move(names)); }

std::string Card::read_fault_text() {
  const bool has_inputs = card_map::has_engine(identification().engines, card_map::engine::kMachineInputs);
  const std::uint32_t limits = has_inputs ? parts_->registers.read(reg::kLimitState) : 0;
  return describe_faults(read_faults(), limits, parts_->registers.axis_names());
}

void Card::set_input_stops(const InputStops& stops) {
  require_machine_inputs(identification(), "stops by inputs");
  const unsigned axes = identification().axes;
  check_present(stops.any_step | stops.shared, axes, "stops by inputs: axes", "axes");
  const std::uint32_t causes = std::uint32_t{stops.any_step} << field::kStopCausesAnyStepShift |
                               std::uint32_t{stops.shared} << field::kStopCausesSharedShift |
                               (stops.probe ? field::kStopCausesProbe : 0) |
                               (stops.tool_setter ? field::kStopCausesToolSetter : 0);
  set_reactions(parts_->registers, kReactions, reaction_of(stops), "reactions to inputs");
  parts_->registers.write(reg::kStopCauses, causes, "stops by inputs");
}

void Card::set_overtravel(unsigned axis, std::uint32_t steps) {
  require_machine_inputs(identification(), "overtravel");
  if (axis >= identification().axes) {
    throw ArgumentError(fmt::format("overtravel of axis {}: the card has {} axes", axis, identification().axes));
  }
  check_setting(reg::overtravel(axis), steps, fmt::format("overtravel of axis {}: {} steps", axis, steps));
  parts_->registers.write(reg::overtravel(axis), steps, "overtravel");
}

void Card::override_limits(std::uint8_t minus, std::uint8_t plus) {
  require_machine_inputs(identification(), "override of limits");
  check_present(minus | plus, identification().axes, "override of limits: axes", "axes");
  parts_->registers.write(reg::kLimitOverride, minus | std::uint32_t{plus} << field::kLimitOverridePlusShift,
                          "override of limits");
}

}  // namespace trammel::driver
