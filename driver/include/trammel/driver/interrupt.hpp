// Checks by the caller that end a waiting call early, made in the waiting thread: for Ctrl-C, a flag that a signal
// handler sets, or a deadline. Other threads use Card::request_stop() instead.
#pragma once

#include <chrono>
#include <functional>

namespace trammel::driver {

// During the lifetime of a scope, waiting calls of the thread that created it call `asked` about every 50 ms, until it
// returns true. Then a call that waits for motion stops the card on the path, as by Card::request_stop(), and throws
// StoppedError. A call that waits for an answer of a silent link, or for Card::stop(), throws InterruptedError. Every
// later waiting call during the lifetime of the scope does the same. Scopes nest, and every check is called; destroy
// them in reverse order. `asked` must not throw, and must not use the card.
class InterruptScope {
 public:
  explicit InterruptScope(std::function<bool()> asked);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  // A check that becomes true when `time` has passed on the host's clock, from now on.
  static std::function<bool()> after(std::chrono::nanoseconds time);

 private:
  friend bool interrupted();

  std::function<bool()> asked_;
  InterruptScope* outer_;
  bool ended_ = false;
};

// The following declarations are for code that waits.

// Waits on a silent link and long sleeps are split into slices of this length; the check is called between them.
constexpr std::chrono::milliseconds kInterruptSlice{50};

// Whether the waiting call shall end. False while the card is being stopped because of the interrupt.
bool interrupted();
// The same for a wait in which nothing has arrived for `silence`. Also true if the wait belongs to a stop because of
// the interrupt and has lasted a second.
bool interrupted_after(std::chrono::nanoseconds silence);

// Marks the time during which the card is being stopped because of an interrupt.
class StopForInterrupt {
 public:
  StopForInterrupt();
  ~StopForInterrupt();
  StopForInterrupt(const StopForInterrupt&) = delete;
  StopForInterrupt& operator=(const StopForInterrupt&) = delete;
};

}  // namespace trammel::driver
