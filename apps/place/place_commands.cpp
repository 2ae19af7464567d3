#include "place_commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "common/card_choice.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/standard_streams.hpp"
#include "common/stop_text.hpp"
#include "common/terminal.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/end_position.hpp"

namespace trammel::app {
namespace {

struct PlaceOptions {
  CardChoice card;
  MachineChoice machine;
  std::vector<std::string> axes;  // for zero
  bool homed = false;             // for zero
};

transport::CardUrl card_of(const PlaceOptions& options, const char* command) {
  if (const auto url = options.card.url()) return *url;
  throw UsageError(
      fmt::format("{}: needs --card, because a card that this command simulates has no position yet", command));
}

// A line for each axis: its position, and whether that is valid, homed, and kept through immediate stops.
std::string table(const machine::Machine& machine, const run::CardPlace& place) {
  const gcode::Coordinates at = run::standing_at(machine, place);
  const std::string lost = run::axes_without(machine, place.bits.valid);
  const std::string not_homed = run::axes_without(machine, place.bits.homed);
  // An axis keeps its place only if all of its motors do.
  const std::string not_kept = run::axes_without(machine, place.keeps);
  std::string text;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const char letter = machine.axes[i].letter;
    const bool valid = lost.find(letter) == std::string::npos;
    const bool homed = not_homed.find(letter) == std::string::npos;
    const bool kept = not_kept.find(letter) == std::string::npos;
    text += fmt::format("{} {:12.4f} {:7}  {}, {}{}\n", letter, at[i], run::unit_of(letter),
                        valid ? "valid" : "place lost", homed ? "homed" : "not homed", kept ? ", keeps its place" : "");
  }
  return text;
}

constexpr const char* kNoPlace =
    "no position since the card's reset: the first command that moves the card sets machine zero to where it stands\n";
constexpr const char* kOtherScales =
    "the card's place was counted in other scales than those of this machine file (--machine)\n";

std::string place_text(const machine::Machine& machine, const run::CardPlace& place) {
  if (!place.was_set()) return kNoPlace;
  return run::scales_fit(place, machine) ? table(machine, place) : kOtherScales;
}

// A note for a card that moves: the printed numbers are those of one moment.
const char* motion_text(const driver::Status& status) {
  if (!status.busy) return "";
  return status.held ? "the card holds in a motion\n" : "the card moves\n";
}

void position(const PlaceOptions& options) {
  const machine::Machine machine = options.machine.load();
  with_card(card_of(options, "position"), Purpose::kRead, [&](driver::Card& card, transport::Connection&) {
    match_axes(card, machine);
    const run::CardPlace place = run::read_card_place(card);
    to_standard_output(place_text(machine, place) + motion_text(place.now.status));
  });
}

// "X", "x" and "XY" name axes.
std::string letters_of(const std::vector<std::string>& words) {
  std::string letters;
  for (const std::string& word : words) {
    for (const char c : word) letters += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return letters;
}

void zero(const PlaceOptions& options) {
  const machine::Machine machine = options.machine.load();
  with_card(card_of(options, "zero"), Purpose::kMove, [&](driver::Card& card, transport::Connection&) {
    match_axes(card, machine);
    const driver::Status status = card.read_status();
    if (status.busy) throw UsageError("zero: the card is moving, or holds in a motion. Set zero when it is at rest");
    run::set_zero(card, machine, letters_of(options.axes), options.homed);
    to_standard_output(place_text(machine, run::read_card_place(card)));
  });
}

// The cause of the card's stop, or that it moves. A server also holds an idle card when a client has disconnected; that
// did not stop anything.
std::string cause_of(driver::Card& card, const driver::Status& status) {
  if (status.faulted) return "by " + card.read_fault_text();
  if (status.busy && card.parts().time_base.hold()) {
    const std::string origin = card.bus().hold_origin();
    return origin.empty() ? "by a hold" : "by a hold: " + origin;
  }
  if (status.button_hold) return "by the feed hold button";
  if (status.busy && status.held) return "by an under-run, or an override of 0 %";
  return status.busy ? "by nothing: the card moves" : "by no fault";
}

// The user's actions for a fault, one line each.
std::string cures_of_a_fault(const machine::Machine& machine, const StoppedCard& stopped) {
  std::string text;
  for (const std::string& cure : fault_cures(machine, stopped)) text += fmt::format("next     {}\n", cure);
  return text;
}

// The user's other actions, one line each.
std::string cures_of_the_rest(const machine::Machine& machine, const run::CardPlace& place) {
  const driver::Status& status = place.now.status;
  std::string text;
  if (status.busy && status.held) text += "next     run a program: it drops the motion in which the card holds\n";
  if (status.busy && !status.held) text += "next     wait: the card moves\n";
  if (!place.was_set()) return text + "next     run a program, or `trammel zero` at the machine's zero\n";
  if (!run::scales_fit(place, machine))
    return text + "next     give the machine file with which the position was set (--machine)\n";
  const std::string lost = run::axes_without(machine, place.bits.valid);
  if (!lost.empty()) {
    text += fmt::format(
        "next     bring {} to a known position and run `trammel zero {}`; or give --trust-position, if you know that "
        "no step was lost\n",
        lost, lost);
  }
  const bool free = text.empty() && place.now.faults == 0;
  return free ? "next     run a program: it begins here\n" : text;
}

// How to resume a run that was interrupted on this card.
std::string how_to_resume(const CardChoice& card) {
  try {
    const std::optional<ResumeRecord> record = card.resume().read();
    if (!record || record->state == ResumeRecord::State::kDone || record->plan.empty()) return {};
    return fmt::format("next     `trammel run {} --resume`, with its other options, resumes the interrupted run\n",
                       record->key.program);
  } catch (const UsageError&) {
    return {};
  }
}

void recover(const PlaceOptions& options) {
  const machine::Machine machine = options.machine.load();
  with_card(card_of(options, "recover"), Purpose::kRead, [&](driver::Card& card, transport::Connection&) {
    match_axes(card, machine);
    const StoppedCard stopped = read_stopped(card);
    const run::CardPlace& place = stopped.place;
    to_standard_output(fmt::format("stopped  {}\n", cause_of(card, place.now.status)));
    to_standard_output(place_text(machine, place));
    if (stopped.rest) to_standard_output(fmt::format("path     {}\n", path_text(*stopped.rest, stopped.clock_hz)));
    to_standard_output(cures_of_a_fault(machine, stopped));
    const bool moves = place.now.status.busy && !place.now.status.held;
    if (!moves && place.was_set()) to_standard_output(how_to_resume(options.card));
    to_standard_output(cures_of_the_rest(machine, place));
  });
}

}  // namespace

void add_place_commands(CLI::App& app) {
  auto options = std::make_shared<PlaceOptions>();
  const auto add = [&](const char* name, const char* what, void (*run)(const PlaceOptions&)) {
    CLI::App* command = app.add_subcommand(name, what);
    options->machine.add_to(*command);
    options->card.add_to(*command);
    command->callback([options, run] { run(*options); });
    return command;
  };
  add("position", "show the position of each axis in machine coordinates, and whether it is valid and homed", position);
  CLI::App* zero_command = add("zero", "set machine zero of the named axes to where they stand", zero);
  zero_command->add_option("axes", options->axes, "letters of the axes")->required()->type_name("AXIS");
  zero_command->add_flag("--homed", options->homed,
                         "also mark the axes as homed. Use it if they stand at their reference");
  add("recover", "tell what stopped an external card, where the machine stands, and what to do next", recover);
}

}  // namespace trammel::app
