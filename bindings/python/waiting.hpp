// Waiting calls: they run without Python's lock, and an exception that a signal handler raises ends them.
#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "errors.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"

namespace trammel::python {

// The exception that a signal handler raised during the wait of the thread's innermost call, if any.
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

// Makes the call without Python's lock. Signals are checked while it waits. An exception that a handler raises (Ctrl-C:
// KeyboardInterrupt) ends the call, which first stops the card on the path. That exception is then raised, with the
// driver's error as its cause.
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
  } catch (const nb::python_error&) {  // thrown by a callback in which a nested call was ended
    if (!raised) throw;
  }
  throw std::move(*raised);
}

// The function in the form that Python calls.
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
