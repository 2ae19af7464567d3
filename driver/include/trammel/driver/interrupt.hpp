// A check of the caller's that ends a waiting call early, made in the thread that waits: for Ctrl-C, a flag that a
// signal handler sets, or a deadline. From another thread: Card::request_stop().
#pragma once

#include <chrono>
#include <functional>

namespace trammel::driver {

// While one lives, calls of the thread that made it ask `asked` every 50 ms or so while they wait, until it returns
// true. Then a call that waits for motion stops the card on the path, as by Card::request_stop(), and throws
// StoppedError; one that waits for an answer of a link that is silent, or for Card::stop(), throws InterruptedError. So
// does every later one that waits, as long as the scope lives. Scopes nest, and each is asked; the last one made is the
// first to end. `asked` must not throw, and must not use the card.
class InterruptScope {
 public:
  explicit InterruptScope(std::function<bool()> asked);
  ~InterruptScope();
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  // A deadline, in the host's time from now on.
  static std::function<bool()> after(std::chrono::nanoseconds time);

 private:
  friend bool interrupted();

  std::function<bool()> asked_;
  InterruptScope* outer_;
  bool ended_ = false;
};

// The rest is for code that waits.

// A silent link and a long sleep are waited for in pieces of this length, with a look at the check between them.
constexpr std::chrono::milliseconds kInterruptSlice{50};

// Whether the call that waits is to end. False while the card is being stopped for that reason.
bool interrupted();
// Likewise where nothing has come for so long: then it is true, too, when a stop has waited for a second.
bool interrupted_after(std::chrono::nanoseconds silence);

// While the card is stopped because of an interrupt.
class StopForInterrupt {
 public:
  StopForInterrupt();
  ~StopForInterrupt();
  StopForInterrupt(const StopForInterrupt&) = delete;
  StopForInterrupt& operator=(const StopForInterrupt&) = delete;
};

}  // namespace trammel::driver
