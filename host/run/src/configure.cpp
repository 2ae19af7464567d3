#include "trammel/run/configure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/planner/card_limits.hpp"
#include "trammel/run/card_place.hpp"

namespace trammel::run {

namespace {

// Without this check, the card would silently ignore outputs that it lacks.
void check_outputs(driver::Card& card, std::uint16_t named) {
  if (named == 0 || !card_map::has_engine(card.identification().engines, card_map::engine::kPathCommands)) return;
  const unsigned outputs = card.outputs_present();
  if (named >> outputs == 0) return;
  unsigned highest = outputs;
  while (named >> highest > 1) ++highest;
  throw driver::ArgumentError(fmt::format("output {} of the machine file: the card has {} outputs", highest, outputs));
}

constexpr unsigned kMapMinorOfPlace = 3;  // map 3.3 introduced KEEPS_PLACE
void check_inputs(driver::Card& card, std::uint32_t used) {
  if (!card_map::has_engine(card.identification().engines, card_map::engine::kMachineInputs)) {
    throw driver::ArgumentError("inputs of the machine file: the card has no machine inputs (limits, buttons)");
  }
  const unsigned inputs = card.inputs_present();
  if (inputs >= 32 || used >> inputs == 0) return;
  unsigned highest = inputs;
  while (used >> highest > 1) ++highest;
  throw driver::ArgumentError(fmt::format("input {} of the machine file: the card has {} inputs", highest, inputs));
}

}  // namespace

driver::InputStops input_stops(const machine::Machine& machine) {
  using machine::OnInput;
  const machine::MachineInputs& inputs = machine.inputs;
  driver::InputStops stops;
  const auto x = machine.axis('X');
  const auto y = machine.axis('Y');
  if (machine.kinematics.name == "corexy" && x && y) stops.any_step = static_cast<std::uint8_t>(1U << *x | 1U << *y);
  for (unsigned n = 0; n < machine.axes.size(); ++n) {
    const std::uint32_t minus = inputs.roles[driver::Role(driver::AxisRole::kLimitMinus, n).number()].inputs;
    const std::uint32_t plus = inputs.roles[driver::Role(driver::AxisRole::kLimitPlus, n).number()].inputs;
    if ((minus & plus) != 0) stops.shared |= static_cast<std::uint8_t>(1U << n);
  }
  stops.probe = inputs.on_probe != OnInput::kNothing;
  stops.tool_setter = inputs.on_tool_setter != OnInput::kNothing;
  stops.limit_ramps = machine::limit_stop(machine).ramps;
  stops.drive_fault_ramps = inputs.on_drive_fault == OnInput::kRamp;
  stops.probe_ramps = inputs.on_probe == OnInput::kRamp;
  stops.tool_setter_ramps = inputs.on_tool_setter == OnInput::kRamp;
  return stops;
}

namespace {

template <class Each>
void for_all_roles(const driver::Card& card, const Each& each) {
  for (unsigned kind = 0; kind < driver::kAxisRoles; ++kind) {
    for (unsigned n = 0; n < card.identification().axes; ++n)
      each(driver::Role(static_cast<driver::AxisRole>(kind), n));
  }
  for (const driver::CardRole role :
       {driver::CardRole::kProbe, driver::CardRole::kToolSetter, driver::CardRole::kFeedHold,
        driver::CardRole::kCycleStart, driver::CardRole::kSpindleAtSpeed}) {
    each(driver::Role(role));
  }
}

// An input may seem active while the polarity changes. Therefore no input has a role at that time, and no filter
// retains its previous level.
void set_polarity(driver::Card& card, std::uint32_t inverted) {
  if (card.parts().registers.read(card_map::reg::kInputPolarity) == inverted) return;
  for_all_roles(card, [&](driver::Role role) { card.set_role(role, 0); });
  const unsigned present = card.inputs_present();
  for (unsigned n = 0; n < present; ++n) card.set_input_filter(n, std::chrono::nanoseconds(0));
  card.set_input_polarity(inverted);
  constexpr std::uint64_t kSettled = 256;  // clocks: more than two scans of the filters
  card.bus().sleep(driver::time_of(kSettled, card.identification().clock_hz));
}

}  // namespace

// Roles are written last: before the polarity is set, an input may seem active.
void configure_inputs(driver::Card& card, const machine::Machine& machine) {
  const machine::MachineInputs& inputs = machine.inputs;
  const std::uint32_t used = inputs.used();
  if (used == 0) return;
  check_inputs(card, used);
  set_polarity(card, inputs.inverted());
  const unsigned present = card.inputs_present();
  for (unsigned n = 0; n < present; ++n) {
    const double filter = (used >> n & 1) != 0 ? inputs.filter_of(n) : 0;
    card.set_input_filter(n, std::chrono::nanoseconds(std::llround(filter * 1e6)));
  }
  const machine::LimitStop stop = machine::limit_stop(machine);
  for (unsigned n = 0; n < machine.axes.size(); ++n) card.set_overtravel(n, stop.overtravel[n]);
  card.set_input_stops(input_stops(machine));
  // [probe] assigns the probe's input.
  const bool probe = machine.probe.input && machine.probe.touched_level;
  for_all_roles(card, [&](driver::Role role) {
    const std::uint32_t probes = probe ? std::uint32_t{1} << *machine.probe.input : 0;
    card.set_role(role, role == driver::CardRole::kProbe ? probes : inputs.roles[role.number()].inputs);
  });
}

namespace {

constexpr double kNanosecondsOfAMillisecond = 1e6;
std::chrono::nanoseconds milliseconds(double time) {
  return std::chrono::nanoseconds(std::llround(time * kNanosecondsOfAMillisecond));
}

// The motors that move with an axis of enable_axes; all motors if it is empty.
std::uint8_t motors_with_drives(const machine::Machine& machine) {
  const kinematics::Kinematics kinematics(machine);
  unsigned axes = 0;
  for (const char letter : machine.outputs.enable_axes) axes |= 1U << machine.axis(letter).value();
  unsigned motors = 0;
  for (std::size_t n = 0; n < kinematics.joints(); ++n) {
    if (axes == 0 || (kinematics.axes_of(n) & axes) != 0) motors |= 1U << n;
  }
  return static_cast<std::uint8_t>(motors);
}

}  // namespace

void configure_outputs(driver::Card& card, const machine::Machine& machine) {
  const machine::MachineOutputs& outputs = machine.outputs;
  if (outputs.safe_at_rest() != 0) card.set_output_safe(outputs.on_at_rest, outputs.safe_at_rest());
  if (outputs.safe_at_cause() != 0) card.set_output_safe_cause(outputs.on_at_cause, outputs.safe_at_cause());
  if (outputs.pwm != 0) {
    if (!card.has_pwm()) throw driver::ArgumentError("spindle of the machine file: the card has no PWM");
    driver::PwmChannels channels;
    channels[0] = {driver::pwm_period(outputs.pwm_hz, card.identification().clock_hz), outputs.pwm};
    card.set_pwm(channels);
  }
  if (outputs.emergency_stop_ramps) {
    if (!card.has_emergency_stop()) {
      throw driver::ArgumentError("outputs.on_emergency_stop of the machine file: the card has no emergency stop");
    }
    card.set_emergency_stop_ramps(*outputs.emergency_stop_ramps);
  }
  if (outputs.roles() == 0) return;
  if (!card_map::has_engine(card.identification().engines, card_map::engine::kEnables)) {
    throw driver::ArgumentError(
        "outputs of the machine file: the card has none for drives (enable, brake, charge pump)");
  }
  driver::Health health;
  // Does not require a running watchdog: between two commands there is no host, and the chain must not open then. A
  // watchdog fault does open it.
  health.causes = outputs.disable_on | card_map::field::kFaultWatchdog;
  if (outputs.charge_pump != 0) health.pump_half_period = milliseconds(500 / outputs.charge_pump_hz);
  card.set_health(health);
  card.set_output_roles({outputs.enable, outputs.brake, outputs.charge_pump, outputs.healthy});
  if ((outputs.enable | outputs.brake) == 0) return;
  driver::EnableSequence sequence;
  sequence.axes = motors_with_drives(machine);
  sequence.manual = outputs.enable_manual;
  sequence.brake_release = milliseconds(outputs.brake_release_ms);
  sequence.before_first_step = milliseconds(outputs.enable_delay_ms);
  sequence.after_last_step = milliseconds(outputs.stop_delay_ms);
  sequence.brake_set = milliseconds(outputs.brake_set_ms);
  sequence.idle = milliseconds(1000 * outputs.enable_idle_s);
  sequence.disable_causes = outputs.disable_on;
  card.set_enable_sequence(sequence);
}

void configure(driver::Card& card, const machine::Machine& machine) {
  card.name_axes(names_of_card_axes(machine));
  check_outputs(card, machine.outputs.all());
  const kinematics::Kinematics kinematics(machine);
  for (std::size_t i = 0; i < kinematics.joints(); ++i) {
    const kinematics::Joint& joint = kinematics.joint(i);
    driver::AxisSettings settings = planner::settings_of(machine.axes[joint.settings]);
    settings.invert_second = joint.inverted;
    card.configure_axis(static_cast<unsigned>(i), settings);
  }
  // A card after reset, such as a simulated one, needs no write if no axis keeps its place.
  if (std::any_of(machine.axes.begin(), machine.axes.end(), [](const auto& axis) { return axis.keeps_place; })) {
    set_keeps_place(card, machine);
  }
  constexpr double kNanoseconds = 1e9;
  const double slowest = driver::Card::kSlowestSlew * kNanoseconds / card.identification().clock_hz;
  const double hold = std::min(planner::hold_seconds(machine) * kNanoseconds, std::floor(slowest));
  card.set_slew_time(std::chrono::nanoseconds(static_cast<std::int64_t>(hold)));
  configure_inputs(card, machine);
  configure_outputs(card, machine);
}

void set_keeps_place(driver::Card& card, const machine::Machine& machine) {
  const kinematics::Kinematics kinematics(machine);
  unsigned motors = 0;
  unsigned keeping = 0;
  for (std::size_t i = 0; i < kinematics.joints(); ++i) {
    motors |= 1U << i;
    if (machine.axes[kinematics.joint(i).settings].keeps_place) keeping |= 1U << i;
  }
  const driver::Identification& id = card.identification();
  if (id.map_minor < kMapMinorOfPlace) {
    if (keeping == 0) return;
    throw driver::ArgumentError(
        fmt::format("keeps_place of the machine file: the card's map {}.{} keeps no place of the machine, which came "
                    "with {}.{}",
                    id.map_major, id.map_minor, id.map_major, kMapMinorOfPlace));
  }
  const unsigned before = card.read_keeps_place();
  const unsigned after = (before & ~motors) | keeping;
  if (after != before) card.set_keeps_place(static_cast<std::uint8_t>(after));
}

std::chrono::nanoseconds watchdog_time(const machine::MotionSettings& motion) {
  return std::chrono::nanoseconds(std::llround(motion.watchdog * 1e9));
}

}  // namespace trammel::run
