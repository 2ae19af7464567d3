// Drive enable, brake, charge pump, health and the emergency stop: accesses to their registers.
#include "trammel/driver/drives.hpp"

#include <fmt/format.h>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

constexpr std::uint64_t kDelayClocks = 4096;
constexpr std::uint64_t kIdleClocks = std::uint64_t{1} << 20;
constexpr std::uint64_t kMostUnits = 0xFFFF;

void require_enables(const Identification& card, const char* what) {
  if (!card_map::has_engine(card.engines, card_map::engine::kEnables)) {
    throw ArgumentError(fmt::format("{}: the card has no outputs for drives (engine enables)", what));
  }
}

// The time in units of `clocks` clocks, rounded up.
std::uint32_t units(std::chrono::nanoseconds time, std::uint64_t clocks, std::uint32_t clock_hz, const char* what) {
  const std::uint64_t whole = clocks_of(time, clock_hz, what);
  const std::uint64_t result = whole / clocks + (whole % clocks != 0 ? 1 : 0);
  if (result > kMostUnits) {
    const auto milliseconds = [](std::chrono::nanoseconds t) {
      return std::chrono::duration_cast<std::chrono::milliseconds>(t).count();
    };
    throw ArgumentError(fmt::format("{}: {} ms: this card takes up to {} ms", what, milliseconds(time),
                                    milliseconds(time_of(kMostUnits * clocks, clock_hz))));
  }
  return static_cast<std::uint32_t>(result);
}

void require_emergency_stop(const Card& card) {
  if (!card.has_emergency_stop()) throw ArgumentError("emergency stop: the card has none");
}

std::uint32_t halves(std::uint16_t low, std::uint16_t high) { return low | std::uint32_t{high} << 16; }

}  // namespace

void Card::set_output_roles(const OutputRoles& roles) {
  require_enables(identification(), "roles of outputs");
  const unsigned present = outputs_present();
  if (roles.all() >> present != 0) {
    throw ArgumentError(fmt::format("roles of outputs: 0x{:X}: the card has {} outputs", roles.all(), present));
  }
  const unsigned several = (unsigned{roles.enable} & roles.brake) | (unsigned{roles.charge_pump} & roles.healthy) |
                           ((unsigned{roles.enable} | roles.brake) & (unsigned{roles.charge_pump} | roles.healthy));
  if (several != 0) throw ArgumentError(fmt::format("roles of outputs: 0x{:X} have more than one", several));
  parts_->registers.write(reg::kOutputRoles, halves(roles.enable, roles.brake), "roles of outputs");
  parts_->registers.write(reg::kHealthRoles, halves(roles.charge_pump, roles.healthy), "roles of outputs");
}

// The axes are written last, so that a path that waits meanwhile finds the complete sequence.
void Card::set_enable_sequence(const EnableSequence& sequence) {
  require_enables(identification(), "enable");
  const unsigned axes = identification().axes;
  if (sequence.axes >> axes != 0) {
    throw ArgumentError(fmt::format("enable: axes 0x{:X}: the card has {} axes", sequence.axes, axes));
  }
  const std::uint32_t clock_hz = identification().clock_hz;
  const auto delay = [clock_hz](std::chrono::nanoseconds time, const char* what) {
    return units(time, kDelayClocks, clock_hz, what);
  };
  const std::uint32_t release = delay(sequence.brake_release, "delay of the brake's release");
  const std::uint32_t before = delay(sequence.before_first_step, "delay before the first step");
  const std::uint32_t after = delay(sequence.after_last_step, "delay after the last step");
  const std::uint32_t set = delay(sequence.brake_set, "delay behind the brake's setting");
  const std::uint32_t idle = units(sequence.idle, kIdleClocks, clock_hz, "idle time of the drives");
  Registers& registers = parts_->registers;
  registers.write(reg::kBrakeReleaseDelay, release, "enable");
  registers.write(reg::kEnableDelay, before, "enable");
  registers.write(reg::kStopDelay, after, "enable");
  registers.write(reg::kBrakeSetDelay, set, "enable");
  registers.write(reg::kEnableIdle, idle, "enable");
  registers.write(reg::kDisableCauses, sequence.disable_causes, "enable");
  const std::uint32_t on = registers.read(reg::kEnable) & field::kEnableOn;
  registers.write(reg::kEnable, on | (sequence.manual ? field::kEnableManual : 0), "enable");
  registers.write(reg::kEnableAxes, sequence.axes, "enable");
}

void Card::enable(bool on) {
  require_enables(identification(), "enable");
  const std::uint32_t manual = parts_->registers.read(reg::kEnable) & field::kEnableManual;
  parts_->registers.write(reg::kEnable, manual | (on ? field::kEnableOn : 0), "enable");
}

void Card::set_health(const Health& health) {
  require_enables(identification(), "health");
  const std::uint64_t half = clocks_of(health.pump_half_period, identification().clock_hz, "charge pump");
  if (half > kMostUnits) {
    throw ArgumentError(fmt::format("charge pump: half a period of {} ns is not up to {} clocks at {} Hz",
                                    health.pump_half_period.count(), kMostUnits, identification().clock_hz));
  }
  const std::uint32_t watchdog = health.needs_watchdog ? field::kHealthCausesNoWatchdog : 0;
  parts_->registers.write(reg::kHealthCauses, health.causes | watchdog, "health");
  parts_->registers.write(reg::kChargePump, static_cast<std::uint32_t>(half), "health");
}

bool Card::has_emergency_stop() const {
  return card_map::has_engine(identification().engines, card_map::engine::kEmergencyStop);
}

bool Card::read_emergency_stop() {
  require_emergency_stop(*this);
  return (read_faults() & field::kFaultEmergencyStop) != 0;
}

void Card::set_emergency_stop_ramps(bool ramp) {
  require_emergency_stop(*this);
  constexpr std::uint32_t kReaction = field::kStopReactionEmergencyStop;
  set_reactions(parts_->registers, kReaction, ramp ? kReaction : 0, "reaction to the emergency stop");
}

}  // namespace trammel::driver
