// Errors that the driver throws. Each message says what is wrong with the value, and its unit. Plain values; safe to
// copy between threads.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/card_map.hpp"

namespace trammel::driver {

// Base of all errors of the driver.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The link to the card failed, or the device that answers is no longer a card. what() is the transport's own message,
// or names the words that the driver read. It is unknown which of the pending accesses were made.
class LinkError : public Error {
 public:
  using Error::Error;
};

// The device that answers is not a card that this driver understands.
class IdentificationError : public Error {
 public:
  using Error::Error;
};

// The card refused a command or an access. If the reason is a fault, the driver throws FaultError instead.
class RefusedError : public Error {
 public:
  // The fields of REFUSAL. A reason of 0 means that the card gave none. `context` names the refused operation; it
  // appears in the message only.
  RefusedError(std::uint8_t reason, std::uint8_t command_number, std::uint32_t address, const std::string& context);

  std::uint8_t reason() const { return reason_; }                  // value of card_map::Reason, or 0
  std::uint8_t command_number() const { return command_number_; }  // of the stream command, mod 256
  std::uint32_t address() const { return address_; }               // byte address of the access

 private:
  std::uint8_t reason_;
  std::uint8_t command_number_;
  std::uint32_t address_;
};

// The card has stopped with a latched fault.
class FaultError : public Error {
 public:
  // `faults`: the register FAULT. The message names its bits, and the axes of limits and drives from `limit_state`, the
  // register LIMIT_STATE (nullopt if it was not read). `context` as above; `axes` as of describe_faults().
  FaultError(std::uint32_t faults, const std::string& context, std::optional<std::uint32_t> limit_state = std::nullopt,
             const std::vector<std::string>& axes = {});

  std::uint32_t faults() const { return faults_; }
  std::uint32_t limit_state() const { return limit_state_; }

 private:
  std::uint32_t faults_;
  std::uint32_t limit_state_;
};

// The call is not valid in the present state of the card or the stream. The message says what to do first.
class StateError : public Error {
 public:
  using Error::Error;
};

// A call that would wait for motion found the card already in a hold, so nothing would move. The message says who set
// the hold, if known. Nothing was done; Card::take_over() ends the hold.
class HeldError : public StateError {
 public:
  using StateError::StateError;
};

// A waiting call ended because of a request for a stop on the path (Card::request_stop(), or the check of an
// InterruptScope). The card is at rest, its queues are empty, and all pulses have been output.
class StoppedError : public StateError {
 public:
  // `geometry_begun`: commands begun from the geometry queue until the stop, since the stream was opened.
  StoppedError(std::uint32_t geometry_begun, const std::string& message)
      : StateError(message), geometry_begun_(geometry_begun) {}

  std::uint32_t geometry_begun() const { return geometry_begun_; }

 private:
  std::uint32_t geometry_begun_;
};

// A value is outside its range. Thrown before any access to the bus.
class ArgumentError : public Error {
 public:
  using Error::Error;
};

// The check of an InterruptScope ended a wait before the card could be stopped: a wait for an answer of a silent link
// (the fate of the request is then unknown), or for the end of Card::stop().
class InterruptedError : public Error {
 public:
  using Error::Error;
};

// The card did not reach the expected state in the time allowed. Nothing was aborted.
class TimeoutError : public Error {
 public:
  // `waited`: card clocks.
  TimeoutError(const std::string& context, std::uint64_t waited);

  std::uint64_t waited() const { return waited_; }

 private:
  std::uint64_t waited_;
};

}  // namespace trammel::driver
