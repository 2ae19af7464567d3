#include "trammel/driver/card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "card_identity.hpp"
#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

CardParts::CardParts(Bus& bus, Identification card, const CardTiming& times)
    : identification(std::move(card)),
      timing(times),
      registers(bus),
      time_base(registers, identification),
      snapshots(registers, identification),
      ports(registers, identification),
      interrupt(registers, identification),
      watchdog(registers, identification) {}

Card::Card(std::unique_ptr<CardParts> parts) : parts_(std::move(parts)) {}
Card::~Card() = default;
Card::Card(Card&&) noexcept = default;
Card& Card::operator=(Card&&) noexcept = default;

Card Card::open(Bus& bus) {
  Identification card = read_identification(bus);
  const CardTiming timing = read_timing(bus, card);
  return Card(std::make_unique<CardParts>(bus, std::move(card), timing));
}

const Identification& Card::identification() const { return parts_->identification; }
const CardTiming& Card::timing() const { return parts_->timing; }
Bus& Card::bus() const { return parts_->registers.bus(); }
Build Card::read_build() { return driver::read_build(parts_->registers); }

void Card::configure_axis(unsigned axis, const AxisSettings& settings) {
  if (axis >= identification().axes) {
    throw ArgumentError(fmt::format("axis {}: the card has {} axes", axis, identification().axes));
  }
  const auto setting = [&](std::uint32_t address, std::chrono::nanoseconds time) {
    const std::string what = fmt::format("axis {}: {}", axis, register_at(address).name);
    return write_of(address, step_time_clocks(time, timing().clock_hz, what.c_str()));
  };
  const auto mode = static_cast<std::uint32_t>(settings.mode);
  check_setting(reg::mode(axis), mode, fmt::format("axis {}: mode {}", axis, mode));
  std::array<Access, 6> accesses{
      setting(reg::step_length(axis), settings.step_length), setting(reg::step_space(axis), settings.step_space),
      setting(reg::dir_setup(axis), settings.direction_setup), setting(reg::dir_hold(axis), settings.direction_hold),
      write_of(reg::mode(axis), mode << field::kModeModeShift | (settings.invert_first ? field::kModeInvertFirst : 0) |
                                    (settings.invert_second ? field::kModeInvertSecond : 0))};
  parts_->registers.transfer(accesses.data(), accesses.size() - 1, fmt::format("axis {}: settings", axis));
  parts_->timing.pulse_period[axis] = shortest_pulse_period(accesses[0].data, accesses[1].data);
}

std::uint32_t Card::ratio_of(double percent, double max_percent) {
  // Written so that NaN is refused, too.
  if (!(max_percent > 0 && percent >= 0 && percent <= max_percent)) {
    throw ArgumentError(fmt::format("override of {} %: 0 to {} % are possible", percent, max_percent));
  }
  return static_cast<std::uint32_t>(percent / max_percent * kFullRatio + 0.5);
}

void Card::set_longest_step_wait(std::chrono::nanoseconds longest) {
  const std::uint64_t value = clocks_of(longest, timing().clock_hz, "longest step wait");
  check_setting(reg::kHoldLimit, value, fmt::format("longest step wait: {} ns, {} clocks,", longest.count(), value));
  parts_->registers.write(reg::kHoldLimit, static_cast<std::uint32_t>(value), "longest step wait");
}

void Card::set_ratio(PieceClass piece_class, std::uint32_t ratio) { parts_->time_base.set_ratio(piece_class, ratio); }
std::uint32_t Card::ratio(PieceClass piece_class) const { return parts_->time_base.ratio(piece_class); }
void Card::set_slew_time(std::chrono::nanoseconds full_scale) { parts_->time_base.set_slew_time(full_scale); }
void Card::set_hold(bool hold) { parts_->time_base.set_hold(hold); }

void Card::request_hold(bool hold) noexcept { parts_->requests.hold(hold); }
void Card::request_abort() noexcept { parts_->requests.abort(); }
void Card::request_stop() noexcept { parts_->requests.stop(); }
void Card::request_ratio(PieceClass piece_class, std::uint32_t ratio) noexcept {
  parts_->requests.ratio(piece_class, ratio);
}

Status Card::read_status() { return parts_->registers.read_status(); }
Snapshot Card::read_snapshot() { return parts_->snapshots.take(); }
Snapshot Card::read_stop_snapshot() { return parts_->snapshots.stop(); }
Snapshot Card::read_mark_snapshot() { return parts_->snapshots.mark(); }
Snapshot Card::read_probe_snapshot() { return parts_->snapshots.probe(); }
Rest Card::read_rest() { return parts_->snapshots.rest(); }
std::uint32_t Card::read_marks() { return parts_->snapshots.marks(); }
void Card::clear_probe() { parts_->snapshots.clear_probe(); }

std::uint32_t Card::read_inputs() { return parts_->ports.inputs(); }
std::uint16_t Card::read_outputs() { return parts_->ports.outputs(); }
unsigned Card::inputs_present() { return parts_->ports.inputs_present(); }
unsigned Card::outputs_present() { return parts_->ports.outputs_present(); }
void Card::set_input_polarity(std::uint32_t inverted) { parts_->ports.set_input_polarity(inverted); }
void Card::set_output_safe(std::uint16_t levels, std::uint16_t change) {
  parts_->ports.set_output_safe(levels, change);
}

void Card::set_output_safe_cause(std::uint16_t levels, std::uint16_t change) {
  parts_->ports.set_output_safe_cause(levels, change);
}

std::uint32_t Card::read_faults() { return parts_->registers.read_faults(); }
void Card::set_watchdog(std::chrono::nanoseconds time) { parts_->watchdog.set(time); }

std::optional<Refusal> Card::refusal() { return parts_->registers.refusal(); }
void Card::clear_refusal() { parts_->registers.clear_refusal(); }

void Card::abort() { parts_->registers.write(reg::kControl, field::kControlAbort, "abort"); }

}  // namespace trammel::driver
