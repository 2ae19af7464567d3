#include "trammel/driver/card.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clocks.hpp"
#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

const map::Register& entry(std::uint32_t address) { return *map::find_register(address).entry; }

std::uint32_t bits(std::uint32_t value, std::uint32_t mask, std::uint32_t shift) { return (value & mask) >> shift; }

// Throws unless the register takes the value: no bits without meaning, within the limits of its field.
void check_setting(std::uint32_t address, std::uint64_t value, const std::string& what) {
  const map::Register& setting = entry(address);
  const std::uint64_t most = setting.limited != 0 ? setting.maximum : setting.mask;
  const std::uint64_t least = setting.limited != 0 ? setting.minimum : 0;
  if (value < least || value > most) {
    throw ArgumentError(fmt::format("{} is outside {} .. {} ({})", what, least, most, setting.name));
  }
}

std::uint32_t longest_command(bool map::Command::*queue, const Identification& card) {
  std::uint32_t result = 0;
  for (const map::Command& command : map::kCommands) {
    if (!map::has_engine(card.engines, command.engine)) {
      continue;
    }
    const auto mask = static_cast<std::uint8_t>(command.axis_halfwords != 0 ? (1U << card.axes) - 1 : 0);
    result = std::max(result, command.*queue ? map::queue_halfwords(command, mask) : 0);
  }
  return result;
}

void check_depth(const char* queue, std::uint32_t depth, std::uint32_t needed) {
  if (depth < needed) {
    throw IdentificationError(
        fmt::format("card: its {} queue holds {} halfwords, the longest command needs {}", queue, depth, needed));
  }
}

void check_versions(const Identification& card) {
  const std::uint32_t major = bits(map::kMapVersionValue, field::kMapVersionMajor, field::kMapVersionMajorShift);
  if (card.map_major != major) {
    throw IdentificationError(fmt::format("card: register map version {}.{}, this driver knows version {}",
                                          card.map_major, card.map_minor, major));
  }
  if (card.commands_version != map::kCommandsVersionValue) {
    throw IdentificationError(fmt::format("card: command layouts of version {}, this driver knows version {}",
                                          card.commands_version, map::kCommandsVersionValue));
  }
}

void check_build(const Identification& card) {
  if (card.axes < 1 || card.axes > card_map::kMaxAxes) {
    throw IdentificationError(fmt::format("card: {} axes, this driver knows 1 to {}", card.axes, card_map::kMaxAxes));
  }
  if (card.clock_hz == 0) {
    throw IdentificationError("card: a clock of 0 Hz; its clock strap is not set");
  }
  const std::uint32_t unknown = card.engines & ~entry(reg::kEngines).mask;
  if (unknown != 0) {
    throw IdentificationError(
        fmt::format("card: engines 0x{:X}, of which this driver does not know 0x{:X}", card.engines, unknown));
  }
  if (!map::has_engine(card.engines, map::engine::kLines)) {
    throw IdentificationError(fmt::format("card: engines 0x{:X} without lines", card.engines));
  }
  check_depth("geometry", card.geometry_depth, longest_command(&map::Command::to_geometry, card));
  check_depth("feed", card.feed_depth, longest_command(&map::Command::to_feed, card));
}

Status status_of(std::uint32_t value) {
  Status status;
  status.busy = (value & field::kStatusBusy) != 0;
  status.direct = (value & field::kStatusDirect) != 0;
  status.path_active = (value & field::kStatusPathActive) != 0;
  status.feed_active = (value & field::kStatusFeedActive) != 0;
  status.held = (value & field::kStatusHeld) != 0;
  status.ended = (value & field::kStatusEnded) != 0;
  status.faulted = (value & field::kStatusFaulted) != 0;
  status.refused = (value & field::kStatusRefused) != 0;
  status.snapshot = (value & field::kStatusSnapshot) != 0;
  status.incomplete = (value & field::kStatusIncomplete) != 0;
  status.stopping = (value & field::kStatusStopping) != 0;
  return status;
}

}  // namespace

Card Card::open(Bus& bus) {
  const std::uint32_t magic = bus.read(reg::kMagic);
  if (magic != map::kMagicValue) {
    throw IdentificationError(
        fmt::format("card: no Trammel card answers: MAGIC reads 0x{:08X}, not 0x{:08X}", magic, map::kMagicValue));
  }
  Card card(bus);
  Identification& identification = card.identification_;
  const std::uint32_t version = bus.read(reg::kMapVersion);
  identification.map_major =
      static_cast<std::uint16_t>(bits(version, field::kMapVersionMajor, field::kMapVersionMajorShift));
  identification.map_minor =
      static_cast<std::uint16_t>(bits(version, field::kMapVersionMinor, field::kMapVersionMinorShift));
  identification.commands_version = bus.read(reg::kCommandsVersion);
  check_versions(identification);
  identification.axes = bus.read(reg::kAxes);
  identification.clock_hz = bus.read(reg::kClockHz);
  identification.engines = bus.read(reg::kEngines);
  identification.geometry_depth = bus.read(reg::kGeometryDepth);
  identification.feed_depth = bus.read(reg::kFeedDepth);
  check_build(identification);
  card.timing_.clock_hz = identification.clock_hz;
  card.timing_.axes = identification.axes;
  for (unsigned axis = 0; axis < identification.axes; ++axis) {
    const std::uint32_t step_length = bus.read(reg::step_length(axis));
    card.timing_.pulse_period[axis] = shortest_pulse_period(step_length, bus.read(reg::step_space(axis)));
  }
  return card;
}

void Card::configure_axis(unsigned axis, const AxisSettings& settings) {
  static_assert(reg::mode(0) == reg::step_length(0) + 16 && reg::step_space(0) == reg::step_length(0) + 4 &&
                reg::dir_setup(0) == reg::step_length(0) + 8 && reg::dir_hold(0) == reg::step_length(0) + 12);
  if (axis >= identification_.axes) {
    throw ArgumentError(fmt::format("axis {}: the card has {} axes", axis, identification_.axes));
  }
  const auto setting = [&](std::uint32_t address, std::chrono::nanoseconds time) {
    const std::uint64_t value = clocks(time, entry(address).name.data());
    check_setting(
        address, value,
        fmt::format("axis {}: {} ns, {} clocks at {} Hz,", axis, time.count(), value, identification_.clock_hz));
    return static_cast<std::uint32_t>(value);
  };
  const auto mode = static_cast<std::uint32_t>(settings.mode);
  check_setting(reg::mode(axis), mode, fmt::format("axis {}: mode {}", axis, mode));
  const std::array<std::uint32_t, 5> words{
      setting(reg::step_length(0), settings.step_length), setting(reg::step_space(0), settings.step_space),
      setting(reg::dir_setup(0), settings.direction_setup), setting(reg::dir_hold(0), settings.direction_hold),
      mode << field::kModeModeShift | (settings.invert_first ? field::kModeInvertFirst : 0) |
          (settings.invert_second ? field::kModeInvertSecond : 0)};
  try {
    bus_->write_block(reg::step_length(axis), words.data(), words.size(), Addressing::kIncrementing);
  } catch (const BusError& error) {
    throw_refusal(error, fmt::format("axis {}: settings", axis));
  }
  timing_.pulse_period[axis] = shortest_pulse_period(words[0], words[1]);
}

void Card::set_ratio(std::uint32_t ratio) {
  check_setting(reg::kRatioFeed, ratio, fmt::format("time base: ratio {} / 65536", ratio));
  write(reg::kRatioFeed, ratio, "time base: ratio");
}

void Card::set_slew_time(std::chrono::nanoseconds full_scale) {
  // The ratio moves by `slew` * 2^-28 every 4 clocks, so slew = 4 * 2^28 / clocks.
  constexpr std::uint64_t kFullScale = std::uint64_t{map::constant::kSlewClocks} << map::constant::kSlewFractionBits;
  const std::uint64_t time = std::max<std::uint64_t>(clocks(full_scale, "time base: slew time"), 1);
  const std::uint64_t slew = std::min<std::uint64_t>(kFullScale / time, entry(reg::kSlew).maximum);
  check_setting(reg::kSlew, slew,
                fmt::format("time base: slew of {} ns, {} clocks, which gives {} and", full_scale.count(), time, slew));
  write(reg::kSlew, static_cast<std::uint32_t>(slew), "time base: slew");
}

void Card::set_hold(bool hold) { write(reg::kHold, hold ? 1 : 0, "time base: hold"); }

void Card::set_hold_limit(std::chrono::nanoseconds limit) {
  const std::uint64_t value = clocks(limit, "hold limit");
  check_setting(reg::kHoldLimit, value, fmt::format("hold limit: {} ns, {} clocks,", limit.count(), value));
  write(reg::kHoldLimit, static_cast<std::uint32_t>(value), "hold limit");
}

Snapshot Card::snapshot() {
  write(reg::kControl, field::kControlSnapshot, "snapshot");
  return read_area(map::Area::Snap);
}

Snapshot Card::stop_snapshot() { return read_area(map::Area::Stop); }

Snapshot Card::read_area(map::Area area) {
  constexpr std::uint64_t kPause = 16;    // clocks; a snapshot is a few dozen register words
  constexpr std::uint64_t kLimit = 4096;  // clocks
  std::uint64_t waited = 0;
  while (status().snapshot) {
    if (waited >= kLimit) {
      throw TimeoutError("snapshot", waited);
    }
    bus_->wait(kPause);
    waited += kPause;
  }
  Snapshot result;
  const std::uint64_t time_low = bus_->read(reg::time_lo(area));
  result.time = time_low | std::uint64_t{bus_->read(reg::time_hi(area))} << 32;
  result.status = status_of(bus_->read(reg::status(area)));
  result.faults = bus_->read(reg::fault(area));
  result.rate = bus_->read(reg::rate(area));
  result.ratio = bus_->read(reg::ratio(area));
  result.geometry_begun = bus_->read(reg::geometry_begun(area));
  result.feed_begun = bus_->read(reg::feed_begun(area));
  for (unsigned axis = 0; axis < identification_.axes; ++axis) {
    result.position[axis] = static_cast<std::int32_t>(bus_->read(reg::position(area, axis)));
  }
  return result;
}

Status Card::status() { return status_of(bus_->read(reg::kStatus)); }

void Card::wait_until_idle(std::chrono::nanoseconds timeout) {
  const std::uint64_t limit = clocks(timeout, "timeout");
  std::uint64_t waited = 0;
  for (;;) {
    const Status now = status();
    throw_if_faulted(now, "waiting for the end of motion");
    if (!now.busy) {
      return;
    }
    if (waited >= limit) {
      throw TimeoutError("waiting for the end of motion", waited);
    }
    const std::uint64_t pause = std::min(poll_interval(), limit - waited);
    bus_->wait(pause);
    waited += pause;
  }
}

std::uint32_t Card::faults() { return bus_->read(reg::kFault); }

void Card::clear_faults() { write(reg::kFault, entry(reg::kFault).mask, "clearing faults"); }

std::optional<Refusal> Card::refusal() {
  const std::uint32_t value = bus_->read(reg::kRefusal);
  Refusal result;
  result.reason = static_cast<std::uint8_t>(bits(value, field::kRefusalReason, field::kRefusalReasonShift));
  result.command_number = static_cast<std::uint8_t>(bits(value, field::kRefusalCommand, field::kRefusalCommandShift));
  result.address = bits(value, field::kRefusalAddress, field::kRefusalAddressShift);
  if (result.reason == 0) {
    return std::nullopt;
  }
  return result;
}

void Card::clear_refusal() { write(reg::kRefusal, entry(reg::kRefusal).mask, "clearing the refusal"); }

void Card::abort() { write(reg::kControl, field::kControlAbort, "abort"); }

void Card::throw_if_faulted(const Status& status, const std::string& context) {
  if (status.faulted) {
    throw FaultError(faults(), context);
  }
}

std::optional<Refusal> Card::refusal_after_failure() {
  try {
    return refusal();
  } catch (const BusError&) {
    return std::nullopt;
  }
}

void Card::throw_refusal(const BusError& error, const std::string& context) {
  const std::optional<Refusal> latched = refusal_after_failure();
  if (!latched.has_value()) {
    throw;
  }
  const Refusal& refusal = latched.value();
  if (refusal.address == error.address()) {
    throw RefusedError(refusal.reason, refusal.command_number, refusal.address, context);
  }
  throw BusError(error.address(), error.direction(),
                 fmt::format("{}; REFUSAL holds an earlier one, of address 0x{:03X}: {}", context, refusal.address,
                             describe_reason(refusal.reason)));
}

std::uint64_t Card::clocks(std::chrono::nanoseconds time, const char* what) const {
  return clocks_of(time, identification_.clock_hz, what);
}

std::uint64_t Card::poll_interval() const {
  constexpr std::uint32_t kPollsPerSecond = 20'000;
  constexpr std::uint32_t kFewestClocks = 64;
  return std::max(identification_.clock_hz / kPollsPerSecond, kFewestClocks);
}

void Card::write(std::uint32_t address, std::uint32_t value, const std::string& context) {
  try {
    bus_->write(address, value);
  } catch (const BusError& error) {
    throw_refusal(error, context);
  }
}

}  // namespace trammel::driver
