#include "stop_at_signals.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace trammel::app {
namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};

// Data of the signal handler.
std::atomic<driver::Card*> g_card{nullptr};
volatile sig_atomic_t g_signal = 0;
std::array<struct sigaction, kSignals.size()> g_before;
static_assert(std::atomic<driver::Card*>::is_always_lock_free);

void put_back() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &g_before[i], nullptr);
}

extern "C" void stop_the_card(int signal) {
  put_back();
  g_signal = signal;
  if (driver::Card* const card = g_card) card->request_stop();
}

}  // namespace

// Interrupted system calls are restarted; the driver checks for the stop request between them.
StopAtSignals::StopAtSignals(driver::Card& card) {
  g_signal = 0;
  g_card = &card;
  struct sigaction action {};
  action.sa_handler = stop_the_card;
  action.sa_flags = SA_RESTART;
  for (const int signal : kSignals) ::sigaddset(&action.sa_mask, signal);
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], nullptr, &g_before[i]);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (g_before[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &action, nullptr);
  }
}

StopAtSignals::~StopAtSignals() {
  put_back();
  g_card = nullptr;
}

void StopAtSignals::end(const std::string& where) const {
  const int signal = g_signal;
  const char* const name = ::sigabbrev_np(signal);
  throw EndedBySignal(signal, fmt::format("stopped by SIG{}: {}", name != nullptr ? name : "?", where));
}

void EndedBySignal::end_process() const {
  std::fflush(nullptr);
  ::signal(signal_, SIG_DFL);
  ::raise(signal_);
  std::abort();
}

run::Outcome run_until_signal(run::Runner& runner, driver::Card& card, const machine::Machine& machine, bool stream) {
  const StopAtSignals signals(card);
  try {
    return stream ? runner.stream(card) : runner.run(card);
  } catch (const run::StoppedOnPath& stopped) {
    std::string where = stopped.line() == 0 ? "before the first command" : fmt::format("line {}", stopped.line());
    const kinematics::Kinematics kinematics(machine);
    const kinematics::Coordinates at = kinematics.coordinates(stopped.position());
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      const std::string pulse = kinematics.joint_for_each_axis() ? fmt::format("pulse {} ", stopped.position()[a]) : "";
      where += fmt::format(", {} at {}({:.4f} mm)", machine.axes[a].letter, pulse, at[a]);
    }
    signals.end(where);
  }
}

}  // namespace trammel::app
