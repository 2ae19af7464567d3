// Ctrl-C, a termination or a hang-up while a card moves: the first one stops it on the path, in order; the next one
// ends the process at once, as it would without this.
#pragma once

#include <stdexcept>
#include <string>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {

// While one lives, the first such signal asks `card`, which must outlive it, for a stop. One at a time.
class StopAtSignals {
 public:
  explicit StopAtSignals(driver::Card& card);
  ~StopAtSignals();
  StopAtSignals(const StopAtSignals&) = delete;
  StopAtSignals& operator=(const StopAtSignals&) = delete;

  // Throws EndedBySignal, with `where` the card stands.
  [[noreturn]] void end(const std::string& where) const;
};

// A signal has ended the command, with the card at rest.
class EndedBySignal : public std::runtime_error {
 public:
  EndedBySignal(int signal, const std::string& message) : std::runtime_error(message), signal_(signal) {}
  // Ends the process by the signal, as whoever started it expects; what was written before is flushed.
  [[noreturn]] void end_process() const;

 private:
  int signal_;
};

// Runner::run() or stream(), or EndedBySignal with the line and where the axes stand.
run::Outcome run_until_signal(run::Runner& runner, driver::Card& card, const machine::Machine& machine, bool stream);

}  // namespace trammel::app
