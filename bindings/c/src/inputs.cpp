// Machine inputs: filters, roles, and how they stop the card.
#include <array>

#include "handle.hpp"
#include "trammel/driver/roles.hpp"

namespace trammel::c {

static_assert(TRAMMEL_ROLE_IN_POSITION == static_cast<int>(driver::AxisRole::kInPosition));
static_assert(TRAMMEL_ROLE_IN_POSITION + 1 == driver::kAxisRoles);
static_assert(TRAMMEL_ROLE_PROBE == static_cast<int>(driver::CardRole::kProbe));
static_assert(TRAMMEL_ROLE_SPINDLE_AT_SPEED == static_cast<int>(driver::CardRole::kSpindleAtSpeed));

namespace {

driver::Role role_of(std::int32_t role, unsigned axis) {
  const bool of_an_axis = role >= TRAMMEL_ROLE_LIMIT_MINUS && role <= TRAMMEL_ROLE_IN_POSITION;
  const bool of_the_card = role >= TRAMMEL_ROLE_PROBE && role <= TRAMMEL_ROLE_SPINDLE_AT_SPEED;
  if (!of_an_axis && !of_the_card) {
    throw driver::ArgumentError("role " + std::to_string(role) + " is none of trammel_role");
  }
  if (of_the_card && axis != 0) throw driver::ArgumentError("this role is the card's: its axis is 0");
  if (of_the_card) return driver::Role(static_cast<driver::CardRole>(role));
  if (axis >= TRAMMEL_MAX_AXES) {
    throw driver::ArgumentError("axis " + std::to_string(axis) + ": a card has 8 axes at most");
  }
  return {static_cast<driver::AxisRole>(role), axis};
}

driver::InputStops stops_of(const trammel_input_stops& stops) {
  return {stops.any_step,    stops.shared,           stops.probe,
          stops.tool_setter, stops.limit_ramps,      stops.drive_fault_ramps,
          stops.probe_ramps, stops.tool_setter_ramps};
}

}  // namespace

void check_input(driver::Card& card, unsigned input) {
  const unsigned present = card.inputs_present();
  if (input < present) return;
  throw driver::ArgumentError("input " + std::to_string(input) + ": the card has " + std::to_string(present) +
                              " inputs");
}

}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_count_ports(trammel_card* card, unsigned* inputs, unsigned* outputs) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    if (inputs != nullptr) *inputs = of.inputs_present();
    if (outputs != nullptr) *outputs = of.outputs_present();
  });
}

trammel_result trammel_read_raw_inputs(trammel_card* card, uint32_t* levels) {
  return guarded([=] { required(levels, "levels") = card_of(card).read_raw_inputs(); });
}

trammel_result trammel_set_input_filter(trammel_card* card, unsigned input, int64_t time_ns) {
  return guarded([=] { card_of(card).set_input_filter(input, std::chrono::nanoseconds(time_ns)); });
}

trammel_result trammel_read_input_filter(trammel_card* card, unsigned input, int64_t* time_ns) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    check_input(of, input);
    required(time_ns, "time_ns") = of.read_input_filter(input).count();
  });
}

trammel_result trammel_set_role(trammel_card* card, int32_t role, unsigned axis, uint32_t inputs) {
  return guarded([=] { card_of(card).set_role(role_of(role, axis), inputs); });
}

trammel_result trammel_read_role(trammel_card* card, int32_t role, unsigned axis, uint32_t* inputs) {
  return guarded([=] { required(inputs, "inputs") = card_of(card).read_role(role_of(role, axis)); });
}

trammel_result trammel_role_name(int32_t role, unsigned axis, char* text, size_t size) {
  return guarded([=] { give_text([=] { return driver::role_name(role_of(role, axis)); }, text, size); });
}

trammel_result trammel_read_roles(trammel_card* card, trammel_active_roles* roles) {
  return guarded([=] {
    const driver::ActiveRoles now = card_of(card).read_roles();
    required(roles, "roles") = {now.limit_minus, now.limit_plus,  now.drive_fault, now.feed_hold,
                                now.cycle_start, now.tool_setter, now.probe};
  });
}

trammel_result trammel_read_limit_state(trammel_card* card, trammel_limit_state* state) {
  return guarded([=] {
    const driver::LimitState now = card_of(card).read_limit_state();
    required(state, "state") = {now.minus, now.plus, now.drive_fault, now.soft_axis, now.soft_plus};
  });
}

trammel_result trammel_set_input_stops(trammel_card* card, const trammel_input_stops* stops) {
  return guarded([=] { card_of(card).set_input_stops(stops_of(required(stops, "stops"))); });
}

trammel_result trammel_set_overtravel(trammel_card* card, unsigned axis, uint32_t steps) {
  return guarded([=] { card_of(card).set_overtravel(axis, steps); });
}

trammel_result trammel_override_limits(trammel_card* card, uint8_t minus, uint8_t plus) {
  return guarded([=] { card_of(card).override_limits(minus, plus); });
}
