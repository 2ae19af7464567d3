// A card's registers. Every access to the card goes through this class, so no refusal is missed.
//
// A write is confirmed before it counts as made: if the bus does not report refusals, the class reads REFUSAL after it,
// in the same transfer. Errors: LinkError; RefusedError, or FaultError when the card refuses because of a fault. After
// an error the object stays usable. Thread-safety as of the bus: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/card_state.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {

class Registers {
 public:
  // `bus` must outlive the object.
  explicit Registers(Bus& bus) : bus_(&bus) {}

  Bus& bus() const { return *bus_; }

  // Makes the accesses in one transfer. Throws if one was refused. `accesses` must have room for count + 1. `context`
  // names the operation in messages.
  void transfer(Access* accesses, std::size_t count, std::string_view context);
  // The same for words of the stream. Also throws for an access that was refused earlier, since the stream was opened.
  void transfer_stream(Access* accesses, std::size_t count);
  // The same, but a refusal is not an error. Returns the number of accesses made before one was refused; `count` if the
  // bus does not report refusals.
  std::size_t try_transfer(Access* accesses, std::size_t count);

  // One access.
  std::uint32_t read(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t value, std::string_view context);

  // Throws LinkError if the value has bits that its register does not define: the device is not a card.
  static void check_read(const Access& access);

  // Decodes STATUS alone, without the refusal that this object has taken from the card and not reported yet.
  static Status decode_status(std::uint32_t value);
  Status read_status();
  // The status for a value read from STATUS.
  Status status_of(const Access& access) const;

  // As Card::name_axes().
  void name_axes(std::vector<std::string> names) { axis_names_ = std::move(names); }
  const std::vector<std::string>& axis_names() const { return axis_names_; }

  // FAULT, 0 if there is none.
  std::uint32_t read_faults() { return read(card_map::reg::kFault); }
  // Throws FaultError; reads LIMIT_STATE for the axes, which FAULT does not contain.
  [[noreturn]] void throw_fault(std::uint32_t faults, std::string_view context);
  // Throws FaultError if the card has a fault; reads FAULT only if `status` says so.
  void throw_if_faulted(const Status& status, std::string_view context);

  // As Card::refusal() and Card::clear_refusal().
  std::optional<Refusal> refusal() { return earlier_ ? earlier_ : latched_refusal(); }
  void clear_refusal();
  // Throws the error for a refusal: FaultError for the reason FAULTED, else RefusedError.
  [[noreturn]] void throw_refused(const Refusal& refusal, std::string_view context);

 private:
  void confirmed_transfer(Access* accesses, std::size_t count, bool confirm, std::string_view context);
  std::optional<Refusal> latched_refusal();
  void forget_latched_refusal();
  void keep_earlier_refusal();
  [[noreturn]] void throw_refused_access(const Access& access, std::string_view context);

  Bus* bus_;
  std::vector<std::string> axis_names_;
  std::optional<Refusal> earlier_;  // taken from the card and not reported yet
};

}  // namespace trammel::driver
