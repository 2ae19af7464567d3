#include "trammel/driver/low_level/registers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

std::optional<Refusal> refusal_from(std::uint32_t value) {
  Refusal result;
  result.reason = static_cast<std::uint8_t>((value & field::kRefusalReason) >> field::kRefusalReasonShift);
  result.command_number = static_cast<std::uint8_t>((value & field::kRefusalCommand) >> field::kRefusalCommandShift);
  result.address = (value & field::kRefusalAddress) >> field::kRefusalAddressShift;
  if (result.reason == 0) {
    return std::nullopt;
  }
  return result;
}

}  // namespace

void Registers::check_read(const Access& access) {
  const map::Slot slot = map::find_register(access.address);
  if ((access.data & ~slot.entry->mask) != 0) {
    throw LinkError(fmt::format("card: {} reads 0x{:08X}, with bits that have no meaning: what answers is no card",
                                slot.entry->name, access.data));
  }
}

// Makes a transfer, and checks its result.
std::size_t Registers::try_transfer(Access* accesses, std::size_t count) {
  const std::size_t made = bus_->transfer(accesses, count);
  if (made > count || (made < count && !bus_->reports_refusals())) {
    throw LinkError(fmt::format("bus: its transport says that {} of {} accesses were made", made, count));
  }
  return made;
}

void Registers::transfer(Access* accesses, std::size_t count, std::string_view context) {
  const bool writes = std::any_of(accesses, accesses + count, [](const Access& access) { return access.write; });
  const bool confirm = writes && !bus_->reports_refusals();
  if (confirm) {
    // A refusal that is already latched would hide a new one.
    keep_earlier_refusal();
  }
  confirmed_transfer(accesses, count, confirm, context);
}

void Registers::transfer_stream(Access* accesses, std::size_t count) {
  confirmed_transfer(accesses, count, !bus_->reports_refusals(), "stream");
}

void Registers::confirmed_transfer(Access* accesses, std::size_t count, bool confirm, std::string_view context) {
  if (confirm) {
    accesses[count++] = read_of(reg::kRefusal);
  }
  const std::size_t made = try_transfer(accesses, count);
  if (made < count) {
    throw_refused_access(accesses[made], context);
  }
  if (confirm) {
    check_read(accesses[count - 1]);
    if (const auto refused = refusal_from(accesses[count - 1].data)) {
      throw_refused(*refused, context);
    }
  }
}

// Reads REFUSAL from the card.
std::optional<Refusal> Registers::latched_refusal() {
  Access access = read_of(reg::kRefusal);
  if (try_transfer(&access, 1) != 1) {
    throw LinkError("card: it refuses the read of REFUSAL: what answers is no card");
  }
  check_read(access);
  return refusal_from(access.data);
}

void Registers::forget_latched_refusal() {
  Access access = write_of(reg::kRefusal, map::find_register(reg::kRefusal).entry->mask);
  if (try_transfer(&access, 1) != 1) {
    throw LinkError("card: it refuses the write of REFUSAL: what answers is no card");
  }
}

void Registers::keep_earlier_refusal() {
  const std::optional<Refusal> latched = latched_refusal();
  if (!latched) {
    return;
  }
  if (!earlier_) {
    earlier_ = latched;
  }
  forget_latched_refusal();
}

// Throws for an access that the bus reports as refused.
void Registers::throw_refused_access(const Access& access, std::string_view context) {
  const std::optional<Refusal> latched = latched_refusal();
  if (latched && latched->address == access.address) {
    throw_refused(*latched, context);
  }
  Refusal unknown;
  unknown.address = access.address;
  if (latched) {
    keep_earlier_refusal();
  }
  throw_refused(unknown, context);
}

void Registers::throw_refused(const Refusal& refusal, std::string_view context) {
  // A refusal of the stream stays latched: the stream is closed until it is restarted.
  if (refusal.address != reg::kStream) {
    forget_latched_refusal();
  }
  if (refusal.reason == static_cast<std::uint8_t>(map::Reason::Faulted)) {
    const std::uint32_t now = read_faults();
    if (now != 0) throw_fault(now, context);
  }
  throw RefusedError(refusal.reason, refusal.command_number, refusal.address, std::string(context));
}

void Registers::clear_refusal() {
  earlier_.reset();
  forget_latched_refusal();
}

Status Registers::decode_status(std::uint32_t value) {
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
  status.underrun = (value & field::kStatusUnderrun) != 0;
  status.stale = (value & field::kStatusStale) != 0;
  status.button_hold = (value & field::kStatusButtonHold) != 0;
  status.enabled = (value & field::kStatusEnabled) != 0;
  status.enable_waits = (value & field::kStatusEnableWaits) != 0;
  status.settled = (value & field::kStatusSettled) != 0;
  return status;
}

Status Registers::read_status() {
  std::array<Access, 2> access{read_of(reg::kStatus)};
  transfer(access.data(), 1, "status");
  return status_of(access[0]);
}

Status Registers::status_of(const Access& access) const {
  check_read(access);
  Status status = decode_status(access.data);
  status.refused = status.refused || earlier_.has_value();
  return status;
}

void Registers::throw_fault(std::uint32_t faults, std::string_view context) {
  // Only a card with LIMIT_STATE sets these bits.
  constexpr std::uint32_t kNamed = field::kFaultLimit | field::kFaultDriveFault | field::kFaultSoftLimit;
  std::optional<std::uint32_t> state;
  if ((faults & kNamed) != 0) state = read(reg::kLimitState);
  throw FaultError(faults, std::string(context), state, axis_names_);
}

void Registers::throw_if_faulted(const Status& status, std::string_view context) {
  if (status.faulted) {
    throw_fault(read_faults(), context);
  }
}

std::uint32_t Registers::read(std::uint32_t address) {
  std::array<Access, 2> access{read_of(address)};
  transfer(access.data(), 1, "read");
  return access[0].data;
}

void Registers::write(std::uint32_t address, std::uint32_t value, std::string_view context) {
  std::array<Access, 2> access{write_of(address, value)};
  transfer(access.data(), 1, context);
}

}  // namespace trammel::driver
