// A card's registers: every access to the card goes through here, so that none is refused without notice.
//
// A write is confirmed before it counts as made: where the bus does not report refusals, REFUSAL is read behind it, in
// the same transfer. Errors: LinkError; RefusedError, or FaultError when the card refuses because of a fault; after an
// error the object stays usable. Thread-safety: as of the bus: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/card_state.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {

class Registers {
 public:
  // `bus` must outlive the object.
  explicit Registers(Bus& bus) : bus_(&bus) {}

  Bus& bus() const { return *bus_; }

  // Makes the accesses in one transfer. Throws if one was refused. `accesses` has room for count + 1. `context` names
  // the operation in messages.
  void transfer(Access* accesses, std::size_t count, std::string_view context);
  // Likewise for words of the stream: whatever was refused since the stream was opened counts.
  void transfer_stream(Access* accesses, std::size_t count);
  // Likewise, but a refusal is no error. Returns the number of accesses made before one was refused, by a bus that
  // reports refusals; by another bus `count`.
  std::size_t try_transfer(Access* accesses, std::size_t count);

  // One access.
  std::uint32_t read(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t value, std::string_view context);

  // Throws LinkError where a value has bits without meaning in that register: what answers is not the card.
  static void check_read(const Access& access);

  // STATUS alone, without what this object has taken from the card and not reported.
  static Status decode_status(std::uint32_t value);
  Status read_status();
  // Of a value read from STATUS.
  Status status_of(const Access& access) const;

  // FAULT, 0 if there is none.
  std::uint32_t read_faults() { return read(card_map::reg::kFault); }
  // Throws FaultError with the axes that FAULT does not name.
  [[noreturn]] void throw_fault(std::uint32_t faults, std::string_view context);
  // Throws FaultError if the card is faulted; reads FAULT only if `status` says so.
  void throw_if_faulted(const Status& status, std::string_view context);

  // As Card::refusal() and Card::clear_refusal().
  std::optional<Refusal> refusal() { return earlier_ ? earlier_ : latched_refusal(); }
  void clear_refusal();
  // Throws what a refusal means: FaultError for the reason FAULTED, else RefusedError.
  [[noreturn]] void throw_refused(const Refusal& refusal, std::string_view context);

 private:
  void confirmed_transfer(Access* accesses, std::size_t count, bool confirm, std::string_view context);
  std::optional<Refusal> latched_refusal();
  void forget_latched_refusal();
  void keep_earlier_refusal();
  [[noreturn]] void throw_refused_access(const Access& access, std::string_view context);

  Bus* bus_;
  std::optional<Refusal> earlier_;  // taken from the card and not reported yet
};

}  // namespace trammel::driver
