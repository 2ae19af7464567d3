// --card: a card outside this process, for the subcommands that can do with one.
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
  // With --clear-faults, --trust-position and --resume-file, for a command that moves the card.
  void add_to_mover(CLI::App& command);
  // None for a simulated card of this process. Throws UsageError for what is no card's URL.
  std::optional<transport::CardUrl> url() const;
  // Of the card's interrupted run. Only where there is a url().
  ResumeFile resume() const;
};

enum class Purpose { kRead, kMove };

// Opens the card and lets `use` work with it. To move it, a token that the URL does not have is taken from
// TRAMMEL_TOKEN. What keeps it from being opened, or from being moved by this user, is a
// UsageError.
void with_card(const transport::CardUrl& url, Purpose purpose,
               const std::function<void(driver::Card&, transport::Connection&)>& use);

// A machine with more motors than the card has axes is a UsageError.
void require_axes(const driver::Card& card, const machine::Machine& machine);

// Makes it ready to be moved by this program, with a note where something of before is dropped. What the card knows of
// an interrupted run is kept in its file first. A card that moves, and one with a fault that shall not be cleared, is a
// UsageError. `resumes`: a run that goes on; the watchdog's fault is one that it clears.
void take_over(driver::Card& card, const CardChoice& choice, const machine::Machine& machine, bool resumes = false);

// The machine file's watchdog over a motion. A time that the card cannot count is a UsageError.
class MotionWatchdog {
 public:
  MotionWatchdog(driver::Card& card, const machine::MotionSettings& motion);

 private:
  std::optional<driver::WatchdogScope> scope_;
};

// After an error of the motion: where the card stands, how far on the path, and what to do about its fault, as a note;
// nothing without a fault. Waits for the end of the ramp. Never throws: the error before it is the one that counts.
void tell_of_fault(driver::Card& card, const machine::Machine& machine) noexcept;

// Refuses options of the simulated card, by its URL's or its own.
void refuse_with_card(const CardChoice& card, const char* option, bool given);

}  // namespace trammel::app
