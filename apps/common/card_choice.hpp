// The option --card for an external card, for the subcommands that support one.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "command_line.hpp"
#include "resume_file.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::app {

struct CardChoice {
  std::optional<std::string> text;
  bool clear_faults = false;
  bool trust_position = false;
  std::optional<std::string> resume_file;

  void add_to(CLI::App& command);
  // Adds also --clear-faults, --trust-position and --resume-file, for a command that moves the card.
  void add_to_mover(CLI::App& command);
  // None for a simulated card of this process. Throws UsageError for text that is not a card's URL.
  std::optional<transport::CardUrl> url() const;
  // The file of the card's interrupted run. Only if there is a url().
  ResumeFile resume() const;
};

enum class Purpose { kRead, kMove };

// Opens the card and calls `use` with it. To move a card whose URL has no token, the token is taken from TRAMMEL_TOKEN.
// Throws UsageError if the card cannot be opened, or may not be moved by this user.
void with_card(const transport::CardUrl& url, Purpose purpose,
               const std::function<void(driver::Card&, transport::Connection&)>& use);

// Names the card's axes as the machine file does. Throws UsageError if the machine has more motors than the card has
// axes.
void match_axes(driver::Card& card, const machine::Machine& machine);

// Prepares the card to be moved by this program, with a note if leftovers of an earlier program are dropped. The card's
// record of an interrupted run is first saved in its file. Throws UsageError for a card that moves, and for one with a
// fault that must not be cleared. `resumes`: the run continues an interrupted one; it also clears the watchdog's fault.
void take_over(driver::Card& card, const CardChoice& choice, const machine::Machine& machine, bool resumes = false);

// Enables the machine file's watchdog during a motion. Throws UsageError for a time that the card cannot count.
class MotionWatchdog {
 public:
  MotionWatchdog(driver::Card& card, const machine::MotionSettings& motion);

 private:
  std::optional<driver::WatchdogScope> scope_;
};

// A silent card counts as lost a second after the machine file's watchdog has expired: the card has stopped by then, so
// waiting longer is useless. Without a watchdog the wait is the URL's.
void limit_patience(transport::Connection& connection, const machine::MotionSettings& motion);

// After an error of the motion: prints a note. If the link is lost, it says when the card stops; if the card has a
// fault, its position, its place on the path, and the remedy, after the end of the ramp. Prints nothing otherwise.
// Never throws, because the earlier error is the one to report.
void tell_of_stop(driver::Card& card, const transport::Connection& connection,
                  const machine::Machine& machine) noexcept;

// Refuses `option` of the simulated card if it is `given` together with --card.
void refuse_with_card(const CardChoice& card, const char* option, bool given);

}  // namespace trammel::app
