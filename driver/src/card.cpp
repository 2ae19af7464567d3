#include "trammel/driver/card.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "patience.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/interrupt.hpp"

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
    if (!map::is_known(command, card.engines)) {
      continue;
    }
    const auto mask = static_cast<std::uint8_t>(command.axis_halfwords != 0 ? (1U << card.axes) - 1 : 0);
    result = std::max(result, command.*queue ? map::queue_halfwords(command, mask) : 0);
  }
  return result;
}

// Throws unless a register of the identification reads what a card may have there.
void check_field(std::uint32_t address, std::uint32_t value, std::uint32_t least, std::uint32_t most,
                 const char* unit) {
  if (value >= least && value <= most) return;
  throw IdentificationError(
      fmt::format("card: {}: {} {}, this driver takes {} to {}", entry(address).name, value, unit, least, most));
}

// What to update where the card has another version than the driver.
const char* update(std::uint32_t on_card, std::uint32_t here) {
  return on_card > here ? "update the driver" : "update the card's bitstream";
}

void check_versions(const Identification& card) {
  const std::uint32_t major = bits(map::kMapVersionValue, field::kMapVersionMajor, field::kMapVersionMajorShift);
  if (card.map_major != major) {
    throw IdentificationError(fmt::format("card: MAP_VERSION: {}.{}, this driver takes version {}: {}", card.map_major,
                                          card.map_minor, major, update(card.map_major, major)));
  }
  if (card.commands_version != map::kCommandsVersionValue) {
    throw IdentificationError(fmt::format("card: COMMANDS_VERSION: {}, this driver takes version {}: {}",
                                          card.commands_version, map::kCommandsVersionValue,
                                          update(card.commands_version, map::kCommandsVersionValue)));
  }
}

void check_build(const Identification& card) {
  constexpr std::uint32_t kDeepest = 32768;  // halfwords; larger ones the RTL refuses to build
  check_field(reg::kClockHz, card.clock_hz, 1, entry(reg::kClockHz).mask, "Hz (its clock strap)");
  check_field(reg::kGeometryDepth, card.geometry_depth, longest_command(&map::Command::to_geometry, card), kDeepest,
              "halfwords");
  check_field(reg::kFeedDepth, card.feed_depth, longest_command(&map::Command::to_feed, card), kDeepest, "halfwords");
}

// Reads of the step times of all axes, and room for one more access.
struct StepTimes {
  explicit StepTimes(unsigned axes) {
    for (unsigned axis = 0; axis < axes; ++axis) {
      accesses[count++] = read_of(reg::step_length(axis));
      accesses[count++] = read_of(reg::step_space(axis));
    }
  }
  std::uint32_t period(unsigned axis) const {
    Card::check_read(accesses[2 * axis]);
    Card::check_read(accesses[2 * axis + 1]);
    return shortest_pulse_period(accesses[2 * axis].data, accesses[2 * axis + 1].data);
  }
  std::array<Access, 2 * map::kMaxAxes + 1> accesses{};
  std::size_t count = 0;
};

// By PieceClass.
constexpr std::array<std::uint32_t, kPieceClasses> kRatios{reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};

Status status_from(std::uint32_t value) {
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
  status.geometry_low = (value & field::kStatusGeometryLow) != 0;
  status.feed_low = (value & field::kStatusFeedLow) != 0;
  status.probed = (value & field::kStatusProbed) != 0;
  status.probe_missed = (value & field::kStatusProbeMissed) != 0;
  status.waiting = (value & field::kStatusWaiting) != 0;
  return status;
}

// Reads of what cannot be refused by a card that this driver knows.
void read_identity(Bus& bus, Access* accesses, std::size_t count) {
  const std::size_t made = bus.transfer(accesses, count);
  if (made < count) {
    throw IdentificationError(
        fmt::format("card: no Trammel card answers: the read of 0x{:03X} was refused", accesses[made].address));
  }
}

}  // namespace

Card Card::open(Bus& bus) {
  Access magic = read_of(reg::kMagic);
  read_identity(bus, &magic, 1);
  if (magic.data != map::kMagicValue) {
    throw IdentificationError(
        fmt::format("card: no Trammel card answers: MAGIC reads 0x{:08X}, not 0x{:08X}", magic.data, map::kMagicValue));
  }
  std::array<Access, 6> who{read_of(reg::kMapVersion), read_of(reg::kCommandsVersion), read_of(reg::kAxes),
                            read_of(reg::kClockHz),    read_of(reg::kGeometryDepth),   read_of(reg::kFeedDepth)};
  read_identity(bus, who.data(), who.size());
  Card card(bus);
  Identification& identification = card.identification_;
  identification.map_major =
      static_cast<std::uint16_t>(bits(who[0].data, field::kMapVersionMajor, field::kMapVersionMajorShift));
  identification.map_minor =
      static_cast<std::uint16_t>(bits(who[0].data, field::kMapVersionMinor, field::kMapVersionMinorShift));
  identification.commands_version = who[1].data;
  check_versions(identification);
  identification.axes = who[2].data;
  identification.clock_hz = who[3].data;
  identification.geometry_depth = who[4].data;
  identification.feed_depth = who[5].data;
  check_field(reg::kAxes, identification.axes, 1, map::kMaxAxes, "axes");
  identification.units = UnitTable::read(bus, identification.axes);
  identification.engines = identification.units.engines();
  check_build(identification);
  card.timing_.clock_hz = identification.clock_hz;
  card.timing_.axes = identification.axes;
  StepTimes times(identification.axes);
  read_identity(bus, times.accesses.data(), times.count);
  for (unsigned axis = 0; axis < identification.axes; ++axis) card.timing_.pulse_period[axis] = times.period(axis);
  return card;
}

void Card::check_identity() {
  StepTimes times(identification_.axes);
  times.accesses[times.count] = read_of(reg::kMagic);
  const Access& magic = times.accesses[times.count];
  if (checked_transfer(times.accesses.data(), times.count + 1) <= times.count || magic.data != map::kMagicValue) {
    throw LinkError(fmt::format("card: it does not answer any more: MAGIC reads 0x{:08X}", magic.data));
  }
  for (unsigned axis = 0; axis < identification_.axes; ++axis) {
    if (times.period(axis) != timing_.pulse_period[axis]) {
      throw StateError(
          fmt::format("card: axis {} has other step times than it was given: the card was reset since, or is used by "
                      "another program",
                      axis));
    }
  }
}

void Card::configure_axis(unsigned axis, const AxisSettings& settings) {
  if (axis >= identification_.axes) {
    throw ArgumentError(fmt::format("axis {}: the card has {} axes", axis, identification_.axes));
  }
  const auto setting = [&](std::uint32_t address, std::chrono::nanoseconds time) {
    const std::string what = fmt::format("axis {}: {}", axis, entry(address).name);
    return write_of(address, step_time_clocks(time, identification_.clock_hz, what.c_str()));
  };
  const auto mode = static_cast<std::uint32_t>(settings.mode);
  check_setting(reg::mode(axis), mode, fmt::format("axis {}: mode {}", axis, mode));
  std::array<Access, 6> accesses{
      setting(reg::step_length(axis), settings.step_length), setting(reg::step_space(axis), settings.step_space),
      setting(reg::dir_setup(axis), settings.direction_setup), setting(reg::dir_hold(axis), settings.direction_hold),
      write_of(reg::mode(axis), mode << field::kModeModeShift | (settings.invert_first ? field::kModeInvertFirst : 0) |
                                    (settings.invert_second ? field::kModeInvertSecond : 0))};
  transfer(accesses.data(), accesses.size() - 1, fmt::format("axis {}: settings", axis));
  timing_.pulse_period[axis] = shortest_pulse_period(accesses[0].data, accesses[1].data);
}

void Card::set_ratio(PieceClass piece_class, std::uint32_t ratio) {
  const auto index = static_cast<std::size_t>(piece_class);
  if (index >= kPieceClasses) throw ArgumentError(fmt::format("time base: class {}", index));
  if (piece_class != PieceClass::kFeed && !has_engine(map::engine::kClasses)) {
    throw ArgumentError(fmt::format("time base: a ratio for class {} needs {}, which the card does not have", index,
                                    map::kEngineNames[map::engine::kClasses]));
  }
  check_setting(kRatios[index], ratio, fmt::format("time base: ratio {} / 65536", ratio));
  write(kRatios[index], ratio, "time base: ratio");
  ratios_[index] = ratio;
}

std::uint32_t Card::ratio_of(double percent, double most_percent) {
  // Written so that no NaN gets through.
  if (!(most_percent > 0 && percent >= 0 && percent <= most_percent)) {
    throw ArgumentError(fmt::format("override of {} %: 0 to {} % are possible", percent, most_percent));
  }
  return static_cast<std::uint32_t>(percent / most_percent * kFullRatio + 0.5);
}

void Card::set_slew_time(std::chrono::nanoseconds full_scale) {
  // The ratio moves by `slew` * 2^-28 every 4 clocks, so slew = 4 * 2^28 / clocks.
  const std::uint64_t time = std::max<std::uint64_t>(clocks(full_scale, "time base: slew time"), 1);
  const std::uint64_t slew = std::min<std::uint64_t>(kSlowestSlew / time, entry(reg::kSlew).maximum);
  check_setting(reg::kSlew, slew,
                fmt::format("time base: slew of {} ns, {} clocks, which gives {} and", full_scale.count(), time, slew));
  write(reg::kSlew, static_cast<std::uint32_t>(slew), "time base: slew");
}

void Card::set_hold(bool hold) {
  write(reg::kHold, hold ? 1 : 0, "time base: hold");
  own_hold_ = hold;
}

void Card::throw_if_held(std::string_view context) {
  if (read(reg::kHold) == 0) return;
  const std::string origin = own_hold_.value_or(false) ? "set by this program"
                             : own_hold_               ? std::string()
                                                       : bus_->hold_origin();
  throw HeldError(fmt::format("{}: the card holds{}{}: take it over, or end the hold", context,
                              origin.empty() ? "" : ": ", origin));
}

std::optional<Snapshot> Card::take_over() {
  const Status now = status();
  const bool holds = read(reg::kHold) != 0;
  if (now.busy && !now.held && !holds) {
    throw StateError("the card is moving, and not by this program: wait until it is idle, or hold it");
  }
  if (now.busy) return stop();
  set_hold(false);
  return std::nullopt;
}

void Card::set_longest_step_wait(std::chrono::nanoseconds longest) {
  const std::uint64_t value = clocks(longest, "longest step wait");
  check_setting(reg::kHoldLimit, value, fmt::format("longest step wait: {} ns, {} clocks,", longest.count(), value));
  write(reg::kHoldLimit, static_cast<std::uint32_t>(value), "longest step wait");
}

Snapshot Card::snapshot() {
  write(reg::kControl, field::kControlSnapshot, "snapshot");
  return read_area(map::Area::Snap);
}

Snapshot Card::stop_snapshot() { return read_area(map::Area::Stop); }

void Card::require_path_commands(std::string_view what) const {
  if (map::has_engine(identification_.engines, map::engine::kPathCommands)) return;
  throw ArgumentError(fmt::format("{}: needs {}, which the card does not have (engines 0x{:X})", what,
                                  map::kEngineNames[map::engine::kPathCommands], identification_.engines));
}

std::uint16_t Card::inputs() {
  require_path_commands("inputs");
  return static_cast<std::uint16_t>(read(reg::kInputs));
}

std::uint16_t Card::outputs() {
  require_path_commands("outputs");
  return static_cast<std::uint16_t>(read(reg::kOutputs));
}

Build Card::build() {
  std::array<Access, 3> accesses{read_of(reg::kBuildId), read_of(reg::kBuildFlags), read_of(reg::kBoardId)};
  transfer(accesses.data(), accesses.size(), "build");
  check_read(accesses[1]);
  return {accesses[0].data, (accesses[1].data & field::kBuildFlagsDirty) != 0, accesses[2].data};
}

unsigned Card::inputs_present() {
  require_path_commands("inputs");
  return pins_present(field::kPortsInputs, field::kPortsInputsShift, "inputs");
}

unsigned Card::outputs_present() {
  require_path_commands("outputs");
  return pins_present(field::kPortsOutputs, field::kPortsOutputsShift, "outputs");
}

unsigned Card::pins_present(std::uint32_t mask, std::uint32_t shift, const char* pins) {
  constexpr std::uint32_t kMostPins = 16;  // the bits of INPUTS and OUTPUTS
  const std::uint32_t ports = read(reg::kPorts);
  check_read({reg::kPorts, ports});
  const std::uint32_t count = bits(ports, mask, shift);
  check_field(reg::kPorts, count, 1, kMostPins, pins);
  return count;
}

void Card::set_input_polarity(std::uint16_t inverted) {
  require_path_commands("input polarity");
  write(reg::kInputPolarity, inverted, "input polarity");
}

void Card::set_output_safe(std::uint16_t levels, std::uint16_t change) {
  require_path_commands("safe outputs");
  write(reg::kOutputSafe, levels | std::uint32_t{change} << field::kOutputSafeChangeShift, "safe outputs");
}

std::uint32_t Card::marks() {
  require_path_commands("marks");
  return read(reg::kMarks);
}

Snapshot Card::mark_snapshot() {
  require_path_commands("mark");
  return read_area(map::Area::Mark);
}

Snapshot Card::probe_snapshot() {
  require_path_commands("probe");
  return read_area(map::Area::Probe);
}

void Card::clear_probe() {
  require_path_commands("probe");
  write(reg::kControl, field::kControlProbeClear, "probe");
}

Snapshot Card::read_area(map::Area area) {
  constexpr std::uint64_t kPause = 16;    // clocks; a snapshot is a few dozen register words
  constexpr std::uint64_t kLimit = 4096;  // clocks
  std::uint64_t waited = 0;
  while (status().snapshot) {
    if (waited >= kLimit) {
      throw TimeoutError("snapshot", waited);
    }
    bus_->sleep(time_of(kPause, identification_.clock_hz));
    waited += kPause;
  }
  constexpr std::size_t kHead = 8;
  std::array<Access, kHead + map::kMaxAxes + 1> accesses{
      read_of(reg::time_lo(area)),        read_of(reg::time_hi(area)),   read_of(reg::status(area)),
      read_of(reg::fault(area)),          read_of(reg::rate(area)),      read_of(reg::ratio(area)),
      read_of(reg::geometry_begun(area)), read_of(reg::feed_begun(area))};
  for (unsigned axis = 0; axis < identification_.axes; ++axis) {
    accesses[kHead + axis] = read_of(reg::position(area, axis));
  }
  transfer(accesses.data(), kHead + identification_.axes, "snapshot");
  Snapshot result;
  result.time = accesses[0].data | std::uint64_t{accesses[1].data} << 32;
  result.status = status_from(accesses[2].data);
  result.faults = accesses[3].data;
  result.rate = accesses[4].data;
  result.ratio = accesses[5].data;
  result.geometry_begun = accesses[6].data;
  result.feed_begun = accesses[7].data;
  for (unsigned axis = 0; axis < identification_.axes; ++axis) {
    result.position[axis] = static_cast<std::int32_t>(accesses[kHead + axis].data);
  }
  return result;
}

Status Card::status() {
  std::array<Access, 2> access{read_of(reg::kStatus)};
  transfer(access.data(), 1, "status");
  return status_of(access[0]);
}

Status Card::status_of(const Access& access) const {
  check_read(access);
  Status status = status_from(access.data);
  status.refused = status.refused || earlier_.has_value();
  return status;
}

void Card::wait_until_idle(std::chrono::nanoseconds timeout) {
  constexpr const char* kContext = "waiting for the end of motion";
  Patience patience(*this, kContext, 0);
  // Whatever runs is at one of the ratios.
  PieceClass slowest = PieceClass::kFeed;
  for (const PieceClass other : {PieceClass::kRapid, PieceClass::kFixed}) {
    if (ratio(other) != 0 && (ratio(slowest) == 0 || ratio(other) < ratio(slowest))) slowest = other;
  }
  patience.allow(PlannedTime::of(clocks(timeout, "timeout"), slowest));
  for (bool first = true;; first = false) {
    const Status now = status();
    throw_if_faulted(now, kContext);
    if (!now.busy) {
      return check_identity();
    }
    if (first && now.held && !own_hold_.value_or(false)) throw_if_held(kContext);
    serve_requests();
    patience.pause(now, poll_interval(), Patience::kIdle);
  }
}

std::uint32_t Card::faults() { return read(reg::kFault); }

void Card::clear_faults() { write(reg::kFault, entry(reg::kFault).mask, "clearing faults"); }

void Card::abort() { write(reg::kControl, field::kControlAbort, "abort"); }

Snapshot Card::stop(std::chrono::nanoseconds patience) {
  set_hold(true);
  const std::uint64_t margin = clocks(patience, "stop: patience");
  wait_for_rest(kSlowestSlew / std::max<std::uint32_t>(read(reg::kSlew), 1) + margin, true);
  const Snapshot at_rest = snapshot();
  abort();
  wait_for_rest(margin, false);  // pulses that the shapers have accepted
  Snapshot end = snapshot();
  set_hold(false);
  end.geometry_begun = at_rest.geometry_begun;
  end.feed_begun = at_rest.feed_begun;
  return end;
}

// Until nothing runs any more, or, with `held_is_rest`, until the time base stands.
void Card::wait_for_rest(std::uint64_t limit, bool held_is_rest) {
  for (std::uint64_t waited = 0;; waited += poll_interval()) {
    const Status now = status();
    throw_if_faulted(now, "stop");
    if (!now.busy || (held_is_rest && now.held)) return;
    if (waited > limit) throw TimeoutError("stop on the path", waited);
    if (interrupted()) throw InterruptedError("stop on the path: interrupted; the card goes on to rest, and holds");
    bus_->sleep(time_of(poll_interval(), identification_.clock_hz));
  }
}

void Card::throw_if_faulted(const Status& status, std::string_view context) {
  if (status.faulted) {
    throw FaultError(faults(), std::string(context));
  }
}

void Card::serve_requests() {
  if (requests_->abort.exchange(false)) {
    requests_->hold.store(-1);
    requests_->stop.store(false);
    abort();
    throw StateError("card: aborted, as another thread has asked for");
  }
  if (requests_->stop.exchange(false)) stop_on_request("as another thread has asked for");
  if (interrupted()) {
    const StopForInterrupt stopping;
    stop_on_request("because the call was interrupted");
  }
  const int hold = requests_->hold.exchange(-1);
  if (hold >= 0) {
    set_hold(hold != 0);
  }
  for (std::size_t i = 0; i < kPieceClasses; ++i) {
    const std::uint32_t ratio = requests_->ratio[i].exchange(Requests::kNoRatio);
    const bool there = i == 0 || has_engine(map::engine::kClasses);
    if (ratio <= kFullRatio && there) set_ratio(static_cast<PieceClass>(i), ratio);
  }
}

void Card::stop_on_request(const char* why) {
  requests_->hold.store(-1);
  const Snapshot end = stop();
  throw StoppedError(end.geometry_begun, fmt::format("card: stopped on the path, {}", why));
}

std::uint64_t Card::clocks(std::chrono::nanoseconds time, const char* what) const {
  return clocks_of(time, identification_.clock_hz, what);
}

std::uint64_t Card::poll_interval() const {
  constexpr std::uint32_t kPollsPerSecond = 20'000;
  constexpr std::uint32_t kFewestClocks = 64;
  return std::max(identification_.clock_hz / kPollsPerSecond, kFewestClocks);
}

bool Card::pause(std::uint64_t clocks, std::uint32_t wake) {
  if (!bus_->has_interrupt()) {
    bus_->sleep(time_of(clocks, identification_.clock_hz));
    return false;
  }
  enable_interrupts(wake);
  return bus_->wait_for_interrupt(time_of(clocks, identification_.clock_hz));
}

// Fewer than depth - room + 1 are queued when there is that much room.
std::uint32_t Card::wake_at_room(std::uint32_t geometry, std::uint32_t feed) {
  std::uint32_t wake = 0;
  const auto mark = [&](std::uint32_t address, std::optional<std::uint32_t>& written, std::uint32_t value,
                        std::uint32_t bit) {
    if (written != value) {
      write(address, value, "watermarks");
      written = value;
    }
    wake |= bit;
  };
  if (geometry != 0) {
    mark(reg::kGeometryWatermark, geometry_watermark_, identification_.geometry_depth - geometry + 1,
         field::kStatusGeometryLow);
  }
  if (feed != 0) {
    mark(reg::kFeedWatermark, feed_watermark_, identification_.feed_depth - feed + 1, field::kStatusFeedLow);
  }
  return wake;
}

void Card::enable_interrupts(std::uint32_t wake) {
  const std::uint32_t wanted = field::kStatusFaulted | field::kStatusRefused | wake;
  if (irq_enable_ != wanted) {
    write(reg::kIrqEnable, wanted, "interrupts");
    irq_enable_ = wanted;
  }
}

std::uint32_t Card::read(std::uint32_t address) {
  std::array<Access, 2> access{read_of(address)};
  transfer(access.data(), 1, "read");
  return access[0].data;
}

void Card::write(std::uint32_t address, std::uint32_t value, std::string_view context) {
  std::array<Access, 2> access{write_of(address, value)};
  transfer(access.data(), 1, context);
}

}  // namespace trammel::driver
