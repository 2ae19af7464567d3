// Runs a program on a card outside this process: no pin is seen here, so what is told is what the card says.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/card_choice.hpp"
#include "common/resume_file.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/planned_profile.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::app {

struct CardRunOptions {
  run::RunSettings settings;
  bool stream = false;         // the program is read once, while it runs
  double percent = 100;        // override, of the planned speed
  double rapid_percent = 100;  // of rapids
  double max_percent = 100;    // largest override
  CardChoice card;
  ResumeKey key;          // of this run; `settings` agrees with it
  bool resume = false;    // goes on with the run that was interrupted
  bool yes = false;       // the way to where the run begins is gone without a question
  bool progress = false;  // also where stderr is no terminal
  // When all is checked and nothing has moved yet; with `stream` of an empty plan.
  std::function<void(const run::Plan&)> planned;
};

struct CardRunResult {
  std::string card;  // its URL
  run::Plan plan;
  run::Outcome outcome;
  run::EndPosition end;
  std::uint32_t clock_hz = 0;
  double seconds = 0;  // of card time, from the first access to the end
  run::PlannedProfile profile;
  driver::FrameBus::Counts link;  // zeros where it does not go by frames
  std::uint64_t reconnections = 0;
};

// The program begins at the machine zero that the card keeps; a run that begins amid it goes to its begin first. What
// --resume needs is written before anything moves, and when the run ends. Throws UsageError for a card with too few
// axes and for a run that cannot be gone on with, run::PlaceError where it may not begin, and as run::Runner does.
CardRunResult run_on_card(const run::ProgramLines& lines, const machine::Machine& machine, driver::Card& card,
                          transport::Connection& connection, const CardRunOptions& options);

std::string summary(const CardRunResult& result);
std::string json_text(const CardRunResult& result);

}  // namespace trammel::app
