// The driver's errors as exceptions of Python.
#include "errors.hpp"

#include <nanobind/stl/string.h>

#include <exception>
#include <string>
#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/homing.hpp"

namespace trammel::python {
namespace {

// Creates an exception class of the module, with one or two bases.
nb::handle make_error(nb::module_& m, const char* name, const char* doc, nb::handle base, nb::handle second = {}) {
  const std::string full = std::string("trammel.") + name;
  const nb::tuple bases = second ? nb::make_tuple(base, second) : nb::make_tuple(base);
  PyObject* const type = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (type == nullptr) throw nb::python_error();
  m.attr(name) = nb::handle(type);
  return type;
}

// Raises `type`; `fields` are set on the exception.
template <class... Fields>
void raise(nb::handle type, const std::exception& error, std::pair<const char*, Fields>... fields) {
  nb::object exception = type(error.what());
  (nb::setattr(exception, fields.first, nb::cast(fields.second)), ...);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

// Catches the driver's classes; derived classes come before their bases.
void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const driver::ArgumentError& e) {
    raise(error_types.argument, e);
  } catch (const std::invalid_argument& e) {  // thrown by arcs, interpolators and simulated cards
    raise(error_types.argument, e);
  } catch (const driver::StoppedError& e) {
    raise(error_types.stopped, e, std::pair{"geometry_begun", e.geometry_begun()});
  } catch (const driver::HeldError& e) {
    raise(error_types.held, e);
  } catch (const driver::StateError& e) {
    raise(error_types.state, e);
  } catch (const driver::InterruptedError& e) {
    raise(error_types.interrupted, e);
  } catch (const driver::TimeoutError& e) {
    raise(error_types.timeout, e, std::pair{"waited", e.waited()});
  } catch (const driver::RefusedError& e) {
    raise(error_types.refused, e, std::pair{"reason", e.reason()}, std::pair{"command_number", e.command_number()},
          std::pair{"address", e.address()});
  } catch (const driver::FaultError& e) {
    raise(error_types.fault, e, std::pair{"faults", e.faults()});
  } catch (const driver::LinkError& e) {
    raise(error_types.link, e);
  } catch (const driver::IdentificationError& e) {
    raise(error_types.identification, e);
  } catch (const run::HomingError& e) {
    raise(error_types.homing, e);
  } catch (const run::PlaceError& e) {
    raise(error_types.state, e);
  }
}

}  // namespace

void bind_errors(nb::module_& m) {
  ErrorTypes& t = error_types;
  t.error = make_error(m, "Error", "Base of the module's errors.", PyExc_RuntimeError);
  t.link = make_error(m, "LinkError", "The link to the card failed, or the device that answers is no card.", t.error);
  t.identification = make_error(m, "IdentificationError", "The card is none that this driver understands.", t.error);
  t.refused = make_error(m, "RefusedError", "The card refused a command or an access: reason, command_number, address.",
                         t.error);
  t.fault = make_error(m, "FaultError", "The card stopped with a latched fault: faults.", t.error);
  t.state = make_error(m, "StateError", "The call makes no sense in the state of the card or the stream.", t.error);
  t.held = make_error(m, "HeldError", "The card stands in a hold from before: take_over() or set_hold(False) ends it.",
                      t.state);
  t.stopped = make_error(m, "StoppedError", "A stop was asked for, and the card is at rest: geometry_begun.", t.state);
  t.interrupted = make_error(m, "InterruptedError", "The wait was ended before the card could be stopped.", t.error);
  t.argument =
      make_error(m, "ArgumentError", "A value is out of range; the card was not accessed.", t.error, PyExc_ValueError);
  t.timeout = make_error(m, "TimeoutError", "The card did not reach the state in the time allowed: waited.", t.error,
                         PyExc_TimeoutError);
  t.homing =
      make_error(m, "HomingError", "An axis was not homed: its message names axis, input and distance.", t.error);
  nb::register_exception_translator(translate);
}

}  // namespace trammel::python
