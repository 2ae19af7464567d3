// Drives, the emergency stop, and soft limits in the card.
#include "trammel/driver/drives.hpp"

#include <optional>
#include <vector>

#include "handle.hpp"
#include "trammel/driver/roles.hpp"

namespace trammel::c {

static_assert(TRAMMEL_FAULT_STEPS == card_map::field::kFaultStep);
static_assert(TRAMMEL_FAULT_TICK_MISMATCH == card_map::field::kFaultTickMismatch);
static_assert(TRAMMEL_FAULT_PATH_INCOMPLETE == card_map::field::kFaultPathIncomplete);
static_assert(TRAMMEL_FAULT_MISSING_PERIOD == card_map::field::kFaultMissingPeriod);
static_assert(TRAMMEL_FAULT_LIMIT == card_map::field::kFaultLimit);
static_assert(TRAMMEL_FAULT_EMERGENCY_STOP == card_map::field::kFaultEmergencyStop);
static_assert(TRAMMEL_FAULT_DRIVE_FAULT == card_map::field::kFaultDriveFault);
static_assert(TRAMMEL_FAULT_WATCHDOG == card_map::field::kFaultWatchdog);
static_assert(TRAMMEL_FAULT_LINK_LOSS == card_map::field::kFaultLinkLoss);
static_assert(TRAMMEL_FAULT_SOFT_LIMIT == card_map::field::kFaultSoftLimit);
static_assert(TRAMMEL_FAULT_PROBE == card_map::field::kFaultProbe);
static_assert(TRAMMEL_FAULT_TOOL_SETTER == card_map::field::kFaultToolSetter);

namespace {

using std::chrono::nanoseconds;

driver::EnableSequence sequence_of(const trammel_enable_sequence& sequence) {
  return {sequence.axes,
          sequence.manual,
          nanoseconds(sequence.brake_release_ns),
          nanoseconds(sequence.before_first_step_ns),
          nanoseconds(sequence.after_last_step_ns),
          nanoseconds(sequence.brake_set_ns),
          nanoseconds(sequence.idle_ns),
          sequence.disable_causes};
}

std::optional<driver::SoftRange> range_of(const trammel_soft_range& range) {
  if (!range.limited) return std::nullopt;
  return driver::SoftRange{range.minus, range.plus};
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_set_output_safe_cause(trammel_card* card, uint16_t levels, uint16_t change) {
  return guarded([=] { card_of(card).set_output_safe_cause(levels, change); });
}

trammel_result trammel_has_soft_limits(const trammel_card* card, bool* has) {
  return guarded([=] { required(has, "has") = required(card, "card").card.has_soft_limits(); });
}

trammel_result trammel_set_soft_limits(trammel_card* card, const trammel_soft_range* ranges, size_t count) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    if (count != 0) required(ranges, "ranges");
    if (count > TRAMMEL_MAX_AXES) {
      throw driver::ArgumentError("soft limits of " + std::to_string(count) + " axes: a card has 8 axes at most");
    }
    std::vector<std::optional<driver::SoftRange>> all;
    for (size_t n = 0; n < count; ++n) all.push_back(range_of(ranges[n]));
    of.set_soft_limits(all);
  });
}

trammel_result trammel_read_soft_limits(trammel_card* card, trammel_soft_range* ranges) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    required(ranges, "ranges");
    const std::vector<std::optional<driver::SoftRange>> now = of.read_soft_limits();
    for (size_t n = 0; n < TRAMMEL_MAX_AXES; ++n) {
      const bool limited = n < now.size() && now[n].has_value();
      ranges[n] = limited ? trammel_soft_range{true, now[n]->minus, now[n]->plus} : trammel_soft_range{false, 0, 0};
    }
  });
}

trammel_result trammel_set_soft_limit_ramps(trammel_card* card, bool ramp) {
  return guarded([=] { card_of(card).set_soft_limit_ramps(ramp); });
}

trammel_result trammel_set_output_roles(trammel_card* card, const trammel_output_roles* roles) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    const trammel_output_roles& is = required(roles, "roles");
    of.set_output_roles({is.enable, is.brake, is.charge_pump, is.healthy});
  });
}

trammel_result trammel_set_enable_sequence(trammel_card* card, const trammel_enable_sequence* sequence) {
  return guarded([=] { card_of(card).set_enable_sequence(sequence_of(required(sequence, "sequence"))); });
}

trammel_result trammel_enable(trammel_card* card, bool on) {
  return guarded([=] { card_of(card).enable(on); });
}

trammel_result trammel_set_health(trammel_card* card, const trammel_health* health) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    const trammel_health& is = required(health, "health");
    of.set_health({is.causes, is.needs_watchdog, std::chrono::nanoseconds(is.pump_half_period_ns)});
  });
}

trammel_result trammel_has_emergency_stop(const trammel_card* card, bool* has) {
  return guarded([=] { required(has, "has") = required(card, "card").card.has_emergency_stop(); });
}

trammel_result trammel_read_emergency_stop(trammel_card* card, bool* stopped) {
  return guarded([=] { required(stopped, "stopped") = card_of(card).read_emergency_stop(); });
}

trammel_result trammel_set_emergency_stop_ramps(trammel_card* card, bool ramp) {
  return guarded([=] { card_of(card).set_emergency_stop_ramps(ramp); });
}
