// Calls that wait: without Python's lock, and ended by what a signal's handler raises.
#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "errors.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"

namespace trammel::python {

// What a signal's handler has raised while the thread's innermost call waited, if anything.
class RaisedWhileWaiting : public std::optional<nb::python_error> {
 public:
  RaisedWhileWaiting() : outer_(innermost()) { innermost() = this; }
  ~RaisedWhileWaiting() { innermost() = outer_; }
  RaisedWhileWaiting(const RaisedWhileWaiting&) = delete;
  RaisedWhileWaiting& operator=(const RaisedWhileWaiting&) = delete;

  static RaisedWhileWaiting*& innermost() {
    thread_local RaisedWhileWaiting* raised = nullptr;
    return raised;
  }

 private:
  RaisedWhileWaiting* outer_;
};

// Makes the call without Python's lock. While it waits, signals are looked for: what a handler raises (Ctrl-C:
// KeyboardInterrupt) ends the call, which stops the card on the path before, and is raised with what the driver said of
// that as its cause.
template <class Call>
auto without_lock(Call call) {
  RaisedWhileWaiting raised;
  const auto locked_out = [&] {
    const nb::gil_scoped_release unlocked;
    const driver::InterruptScope scope([&raised] {
      if (raised) return true;
      const nb::gil_scoped_acquire locked;
      if (PyErr_CheckSignals() == 0) return false;
      raised.emplace();
      return true;
    });
    return call();
  };
  try {
    if constexpr (std::is_void_v<decltype(call())>) {
      locked_out();
      if (!raised) return;
    } else {
      auto result = locked_out();
      if (!raised) return result;
    }
  } catch (const driver::Error& error) {
    if (!raised) throw;
    PyException_SetCause(raised->value().ptr(), error_types.error(error.what()).release().ptr());
  } catch (const nb::python_error&) {  // of a callback, in which a call of its own was ended
    if (!raised) throw;
  }
  throw std::move(*raised);
}

// The function, as Python calls it.
template <class Result, class... Values>
auto waiting(Result (*function)(Values...)) {
  return [function](Values... values) -> Result {
    return without_lock([&]() -> Result { return function(std::forward<Values>(values)...); });
  };
}
template <class Result, class Object, class... Values>
auto waiting(Result (Object::*function)(Values...)) {
  return [function](Object& object, Values... values) -> Result {
    return without_lock([&]() -> Result { return (object.*function)(std::forward<Values>(values)...); });
  };
}
template <class Lambda>
auto waiting(Lambda lambda) {
  return waiting(+lambda);
}

}  // namespace trammel::python
