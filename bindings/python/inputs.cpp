// Inputs and outputs: polarity, filters, roles, and how inputs stop the card.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <vector>

#include "card.hpp"
#include "trammel/driver/roles.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

// The roles plus the number of the card's axes, which is the length of lists by axis.
struct PythonRoles {
  driver::ActiveRoles roles;
  std::size_t axes;
};
struct PythonLimits {
  driver::LimitState limits;
  std::size_t axes;
};

driver::Role role_of(driver::AxisRole kind, unsigned axis) {
  if (axis >= card_map::kMaxAxes) {
    throw driver::ArgumentError("axis " + std::to_string(axis) + ": a card has 8 axes at most");
  }
  return {kind, axis};
}

void bind_roles(nb::module_& m) {
  nb::enum_<driver::AxisRole>(m, "AxisRole", "What an input is for; each axis has one of these.")
      .value("LIMIT_MINUS", driver::AxisRole::kLimitMinus, "Limit switch at the negative end.")
      .value("LIMIT_PLUS", driver::AxisRole::kLimitPlus, "Limit switch at the positive end.")
      .value("HOME", driver::AxisRole::kHome, "Reference switch, for hosts.")
      .value("INDEX", driver::AxisRole::kIndex, "Index pulse, for hosts.")
      .value("DRIVE_FAULT", driver::AxisRole::kDriveFault, "The drive reports a fault.")
      .value("IN_POSITION", driver::AxisRole::kInPosition, "The drive is in position, for hosts.");
  nb::enum_<driver::CardRole>(m, "CardRole", "What an input is for; the card has one of these.")
      .value("PROBE", driver::CardRole::kProbe, "The probe, outside probing.")
      .value("TOOL_SETTER", driver::CardRole::kToolSetter, "The tool setter.")
      .value("FEED_HOLD", driver::CardRole::kFeedHold, "The feed hold button.")
      .value("CYCLE_START", driver::CardRole::kCycleStart, "The cycle start button.")
      .value("SPINDLE_AT_SPEED", driver::CardRole::kSpindleAtSpeed, "The spindle is at speed, for hosts.");
  nb::class_<driver::Role>(m, "Role", "A role of inputs: one of an axis, or one of the card.")
      .def(
          "__init__",
          [](driver::Role* place, driver::AxisRole kind, unsigned axis) {
            new (place) driver::Role(role_of(kind, axis));
          },
          "kind"_a, "axis"_a, "The role of an axis.")
      .def(nb::init_implicit<driver::CardRole>(), "kind"_a, "The role of the card; a CardRole will do in its place.")
      .def_prop_ro("number", &driver::Role::number, "As the card numbers it, 0 to 63.")
      .def_prop_ro("name", driver::role_name, "'limit minus of axis 0', 'feed hold'.");
}

void bind_states(nb::module_& m) {
  const auto mask = [](auto member) {
    return [member](const PythonRoles& of) { return bits_of(of.roles.*member, of.axes); };
  };
  const auto flag = [](auto member) { return [member](const PythonRoles& of) { return of.roles.*member; }; };
  using driver::ActiveRoles;
  nb::class_<PythonRoles>(m, "ActiveRoles", "Roles that are active now; lists are by axis of the card.")
      .def_prop_ro("limit_minus", mask(&ActiveRoles::limit_minus), "Limits at the negative ends.")
      .def_prop_ro("limit_plus", mask(&ActiveRoles::limit_plus), "Limits at the positive ends.")
      .def_prop_ro("drive_fault", mask(&ActiveRoles::drive_fault), "Drives that report a fault.")
      .def_prop_ro("feed_hold", flag(&ActiveRoles::feed_hold),
                   "The feed hold button is pressed; whether it holds: Status.button_hold.")
      .def_prop_ro("cycle_start", flag(&ActiveRoles::cycle_start), "The cycle start button is pressed.")
      .def_prop_ro("tool_setter", flag(&ActiveRoles::tool_setter), "The tool setter touches.")
      .def_prop_ro("probe", flag(&ActiveRoles::probe), "The probe touches.");
  const auto side = [](auto member) {
    return [member](const PythonLimits& of) { return bits_of(of.limits.*member, of.axes); };
  };
  using driver::LimitState;
  nb::class_<PythonLimits>(m, "LimitState",
                           "Limits and drives that brought the fault that stands; lists are by axis of the card.")
      .def_prop_ro("minus", side(&LimitState::minus), "Limits at the negative ends.")
      .def_prop_ro("plus", side(&LimitState::plus), "Limits at the positive ends.")
      .def_prop_ro("drive_fault", side(&LimitState::drive_fault), "Drives.")
      .def_prop_ro(
          "soft_axis", [](const PythonLimits& of) { return of.limits.soft_axis; },
          "With Fault.SOFT_LIMIT: the number of the axis that brought it.")
      .def_prop_ro(
          "soft_plus", [](const PythonLimits& of) { return of.limits.soft_plus; },
          "With Fault.SOFT_LIMIT: whether at its positive end.");
}

void bind_ports(nb::class_<PythonCard>& card) {
  card.def_prop_ro("inputs_present", waiting([](PythonCard& of) { return of.card.inputs_present(); }),
                   "How many inputs the card has, 1 to 32.")
      .def_prop_ro("outputs_present", waiting([](PythonCard& of) { return of.card.outputs_present(); }),
                   "How many outputs the card has, 1 to 16.")
      .def("set_input_polarity",
           waiting([](PythonCard& of, std::uint32_t inverted) { of.card.set_input_polarity(inverted); }), "inverted"_a,
           "Which inputs are inverted, bit n: input n. Before roles: an input at a wrong polarity is active.")
      .def("set_output_safe", waiting([](PythonCard& of, std::uint16_t levels, std::uint16_t change) {
             of.card.set_output_safe(levels, change);
           }),
           "levels"_a, "change"_a, "Levels that the outputs in change take at an abort and at a fault: masks.")
      .def("read_raw_inputs", waiting([](PythonCard& of) { return of.card.read_raw_inputs(); }),
           "Levels of the inputs before their filters, bit n: input n.")
      .def("set_input_filter", waiting([](PythonCard& of, unsigned input, std::int64_t ns) {
             of.card.set_input_filter(input, nanoseconds(ns));
           }),
           "input"_a, "time_ns"_a,
           "A level that lasts at most time_ns (rounded up to 64 clocks of the card) does not pass; 0: no filter.")
      .def("read_input_filter", waiting([](PythonCard& of, unsigned input) {
             check_input(of, input);
             return of.card.read_input_filter(input).count();
           }),
           "input"_a, "Time of an input's filter as the card rounds it, ns.");
}

void bind_stops(nb::class_<PythonCard>& card) {
  card.def("set_role",
           waiting([](PythonCard& of, driver::Role role, std::uint32_t inputs) { of.card.set_role(role, inputs); }),
           "role"_a, "inputs"_a, nb::sig("def set_role(self, role: Role | CardRole, inputs: int) -> None"),
           "Which inputs have a role, bit n: input n; it is active while one of them is. 0: none has it.")
      .def("read_role", waiting([](PythonCard& of, driver::Role role) { return of.card.read_role(role); }), "role"_a,
           nb::sig("def read_role(self, role: Role | CardRole) -> int"), "Which inputs have a role, bit n: input n.")
      .def("read_roles", waiting([](PythonCard& of) {
             return PythonRoles{of.card.read_roles(), of.card.identification().axes};
           }),
           "Roles that are active now.")
      .def("read_limit_state", waiting([](PythonCard& of) {
             return PythonLimits{of.card.read_limit_state(), of.card.identification().axes};
           }),
           "Limits and drives that brought the fault that stands.")
      .def("set_input_stops",
           waiting([](PythonCard& of, const Axes& any_step, const Axes& shared, bool probe, bool tool_setter,
                      bool limit_ramps, bool drive_fault_ramps, bool probe_ramps, bool tool_setter_ramps) {
             of.card.set_input_stops({mask_of(of, any_step), mask_of(of, shared), probe, tool_setter, limit_ramps,
                                      drive_fault_ramps, probe_ramps, tool_setter_ramps});
           }),
           nb::kw_only(), "any_step"_a = Axes{}, "shared"_a = Axes{}, "probe"_a = false, "tool_setter"_a = false,
           "limit_ramps"_a = false, "drive_fault_ramps"_a = true, "probe_ramps"_a = true, "tool_setter_ramps"_a = true,
           "How inputs stop the card. Axes whose every step beside an active limit is one into it (CoreXY), axes with "
           "one switch for both ends; whether the probe outside probing and the tool setter stop it; what stops on a "
           "ramp, else at once.")
      .def("set_overtravel",
           waiting([](PythonCard& of, unsigned axis, std::uint32_t steps) { of.card.set_overtravel(axis, steps); }),
           "axis"_a, "steps"_a,
           "Steps into an active limit that the axis may make on a ramp; one more stops at once. 0 to 65535.")
      .def("override_limits", waiting([](PythonCard& of, const Axes& minus, const Axes& plus) {
             of.card.override_limits(mask_of(of, minus), mask_of(of, plus));
           }),
           "minus"_a = Axes{}, "plus"_a = Axes{},
           "Limits (axes) that are active now and stop nothing until they are released.");
}

}  // namespace

void bind_inputs(nb::module_& m, nb::class_<PythonCard>& card) {
  bind_roles(m);
  bind_states(m);
  bind_ports(card);
  bind_stops(card);
}

}  // namespace trammel::python
