// Handles Ctrl-C, a termination or a hang-up while a card moves: the first signal stops the card on the path; the next
// one ends the process at once, as it would without this class.
#pragma once

#include <stdexcept>
#include <string>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {

// While an object exists, the first such signal requests a stop of `card`, which must outlive it. One object at a time.
class StopAtSignals {
 public:
  explicit StopAtSignals(driver::Card& card);
  ~StopAtSignals();
  StopAtSignals(const StopAtSignals&) = delete;
  StopAtSignals& operator=(const StopAtSignals&) = delete;

  // Throws EndedBySignal, with the card's position `where`.
  [[noreturn]] void end(const std::string& where) const;
};

// A signal has ended the command; the card is at rest.
class EndedBySignal : public std::runtime_error {
 public:
  EndedBySignal(int signal, const std::string& message) : std::runtime_error(message), signal_(signal) {}
  // Ends the process by the signal, as its parent expects; earlier output is flushed.
  [[noreturn]] void end_process() const;

 private:
  int signal_;
};

// Calls Runner::run() or stream(); throws EndedBySignal with the line and the positions of the axes.
run::Outcome run_until_signal(run::Runner& runner, driver::Card& card, const machine::Machine& machine, bool stream);

}  // namespace trammel::app
