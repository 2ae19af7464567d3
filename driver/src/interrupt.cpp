#include "trammel/driver/interrupt.hpp"

#include <utility>

namespace trammel::driver {
namespace {

using std::chrono::steady_clock;

// State of a thread.
struct Interrupts {
  InterruptScope* innermost = nullptr;
  steady_clock::time_point next_look{};
  bool stopping = false;
};

Interrupts& of_this_thread() {
  thread_local Interrupts interrupts;
  return interrupts;
}

}  // namespace

InterruptScope::InterruptScope(std::function<bool()> asked)
    : asked_(std::move(asked)), outer_(of_this_thread().innermost) {
  // A nested scope does not postpone the next check; otherwise a scope created in each poll of a wait would prevent
  // checks.
  if (outer_ == nullptr) of_this_thread().next_look = steady_clock::now() + kInterruptSlice;
  of_this_thread().innermost = this;
}

InterruptScope::~InterruptScope() { of_this_thread().innermost = outer_; }

std::function<bool()> InterruptScope::after(std::chrono::nanoseconds time) {
  return [until = steady_clock::now() + time] { return steady_clock::now() >= until; };
}

bool interrupted() {
  Interrupts& is = of_this_thread();
  if (is.innermost == nullptr || is.stopping) return false;
  const auto now = steady_clock::now();
  const bool look = now >= is.next_look;
  if (look) is.next_look = now + kInterruptSlice;
  bool ended = false;
  for (InterruptScope* scope = is.innermost; scope != nullptr; scope = scope->outer_) {
    if (look && !scope->ended_) scope->ended_ = scope->asked_();
    ended = ended || scope->ended_;
  }
  return ended;
}

bool interrupted_after(std::chrono::nanoseconds silence) {
  constexpr auto kStopMayTake = std::chrono::seconds(1);
  return of_this_thread().stopping ? silence >= kStopMayTake : interrupted();
}

StopForInterrupt::StopForInterrupt() { of_this_thread().stopping = true; }
StopForInterrupt::~StopForInterrupt() { of_this_thread().stopping = false; }

}  // namespace trammel::driver
