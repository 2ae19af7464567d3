#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "handle.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/homing.hpp"

namespace trammel::c {
namespace {

thread_local trammel_error last_error{};

// The text has a fixed size, so that an error can be reported even when memory has run out.
trammel_error& note(trammel_result result, const char* text) noexcept {
  last_error = {};
  last_error.result = result;
  const std::size_t length = std::min(std::strlen(text), sizeof(last_error.text) - 1);
  std::memcpy(last_error.text, text, length);
  return last_error;
}

struct InterruptCheck {
  bool (*asked)(void* context) = nullptr;
  void* context = nullptr;
};

thread_local InterruptCheck interrupt_check;

}  // namespace

CallInterrupts::CallInterrupts() {
  if (interrupt_check.asked == nullptr) return;
  scope_.emplace([check = interrupt_check] { return check.asked(check.context); });
}

// Catches the driver's classes; derived classes come before their bases.
trammel_result note_exception() noexcept {
  try {
    throw;
  } catch (const driver::ArgumentError& error) {
    note(TRAMMEL_ARGUMENT, error.what());
  } catch (const std::invalid_argument& error) {  // thrown by arcs and simulated cards
    note(TRAMMEL_ARGUMENT, error.what());
  } catch (const driver::StoppedError& error) {
    trammel_error& noted = note(TRAMMEL_STOPPED, error.what());
    noted.geometry_begun = error.geometry_begun();
  } catch (const driver::HeldError& error) {
    note(TRAMMEL_HELD, error.what());
  } catch (const driver::StateError& error) {
    note(TRAMMEL_STATE, error.what());
  } catch (const driver::TimeoutError& error) {
    trammel_error& noted = note(TRAMMEL_TIMEOUT, error.what());
    noted.waited = error.waited();
  } catch (const driver::RefusedError& error) {
    trammel_error& noted = note(TRAMMEL_REFUSED, error.what());
    noted.reason = error.reason();
    noted.command_number = error.command_number();
    noted.address = error.address();
  } catch (const driver::FaultError& error) {
    trammel_error& noted = note(TRAMMEL_FAULT, error.what());
    noted.faults = error.faults();
  } catch (const driver::LinkError& error) {
    note(TRAMMEL_LINK, error.what());
  } catch (const driver::IdentificationError& error) {
    note(TRAMMEL_IDENTIFICATION, error.what());
  } catch (const driver::InterruptedError& error) {
    note(TRAMMEL_CANCELLED, error.what());
  } catch (const run::HomingError& error) {
    note(TRAMMEL_HOMING, error.what());
  } catch (const run::PlaceError& error) {
    note(TRAMMEL_STATE, error.what());
  } catch (const Cancelled&) {
    note(TRAMMEL_CANCELLED, "the progress callback ended the call");
  } catch (const std::bad_alloc&) {
    note(TRAMMEL_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    note(TRAMMEL_INTERNAL, error.what());
  } catch (...) {
    note(TRAMMEL_INTERNAL, "an exception of an unknown type");
  }
  return last_error.result;
}

}  // namespace trammel::c

void trammel_set_interrupt(bool (*asked)(void*), void* context) { trammel::c::interrupt_check = {asked, context}; }

const trammel_error* trammel_last_error() { return &trammel::c::last_error; }

const char* trammel_version() { return TRAMMEL_VERSION; }

const char* trammel_result_name(int32_t result) {
  switch (result) {
    case TRAMMEL_OK:
      return "TRAMMEL_OK";
    case TRAMMEL_ARGUMENT:
      return "TRAMMEL_ARGUMENT";
    case TRAMMEL_STATE:
      return "TRAMMEL_STATE";
    case TRAMMEL_STOPPED:
      return "TRAMMEL_STOPPED";
    case TRAMMEL_TIMEOUT:
      return "TRAMMEL_TIMEOUT";
    case TRAMMEL_REFUSED:
      return "TRAMMEL_REFUSED";
    case TRAMMEL_FAULT:
      return "TRAMMEL_FAULT";
    case TRAMMEL_LINK:
      return "TRAMMEL_LINK";
    case TRAMMEL_IDENTIFICATION:
      return "TRAMMEL_IDENTIFICATION";
    case TRAMMEL_CANCELLED:
      return "TRAMMEL_CANCELLED";
    case TRAMMEL_MEMORY:
      return "TRAMMEL_MEMORY";
    case TRAMMEL_INTERNAL:
      return "TRAMMEL_INTERNAL";
    case TRAMMEL_HELD:
      return "TRAMMEL_HELD";
    case TRAMMEL_HOMING:
      return "TRAMMEL_HOMING";
  }
  return "unknown";
}
