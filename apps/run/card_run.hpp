// Runs a program on an external card. Its pins are not visible here, so all results come from the card's registers.
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
  double percent = 100;        // feed override, percent of the planned speed
  double rapid_percent = 100;  // override of rapids, percent
  double max_percent = 100;    // largest override, percent
  CardChoice card;
  ResumeKey key;          // key of this run; it must match `settings`
  bool resume = false;    // resume the interrupted run
  bool yes = false;       // move to the start of the run without a question
  bool progress = false;  // show progress even if stderr is not a terminal
  // Called after all checks, before any motion; with `stream` the plan is empty.
  std::function<void(const run::Plan&)> planned;
};

struct CardRunResult {
  std::string card;  // URL of the card
  run::Plan plan;
  run::Outcome outcome;
  run::EndPosition end;
  std::uint32_t clock_hz = 0;
  double seconds = 0;  // card time from the first access to the end, s
  run::PlannedProfile profile;
  driver::FrameBus::Counts link;  // zeros if the link does not use frames
  std::uint64_t reconnections = 0;
};

// Runs the program. It begins at the machine zero that the card keeps; a run that begins in the middle of the program
// first moves to its start. The data for --resume are written before any motion, and at the end of the run. Throws
// UsageError for a card with too few axes and for a run that cannot be continued, run::PlaceError if the program may
// not begin at the present place, and as run::Runner does.
CardRunResult run_on_card(const run::ProgramLines& lines, const machine::Machine& machine, driver::Card& card,
                          transport::Connection& connection, const CardRunOptions& options);

std::string summary(const CardRunResult& result);
std::string json_text(const CardRunResult& result);

}  // namespace trammel::app
