#include "home_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "common/card_choice.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/standard_streams.hpp"
#include "common/stop_at_signals.hpp"
#include "common/terminal.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/homing.hpp"

namespace trammel::app {
namespace {

struct HomeOptions {
  std::vector<std::string> words;
  MachineChoice machine;
  CardChoice card;
};

// "X", "x" and "XY" name axes; without words: all axes that have a [homing].
std::vector<std::size_t> axes_of(const std::vector<std::string>& words, const machine::Machine& machine) {
  std::vector<std::size_t> axes;
  for (const std::string& word : words) {
    for (const char c : word) {
      const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      const auto axis = machine.axis(letter);
      if (!axis) throw UsageError(fmt::format("home: the machine has no axis {}", letter));
      if (std::find(axes.begin(), axes.end(), *axis) == axes.end()) axes.push_back(*axis);
    }
  }
  for (std::size_t n = 0; words.empty() && n < machine.axes.size(); ++n) {
    if (machine.axes[n].homing) axes.push_back(n);
  }
  if (axes.empty()) {
    throw UsageError(
        "home: no axis of the machine file has a [homing]: give search_velocity in [homing.x], and x_home "
        "in [inputs] (docs/user/homing.md)");
  }
  return axes;
}

// A lost place does not matter for an axis that is homed; a place in other scales matters for the axes that are not
// homed.
void prepare(driver::Card& card, const machine::Machine& machine, const CardChoice& choice) {
  const run::CardPlace place = run::read_card_place(card);
  if (place.was_set() && !run::scales_fit(place, machine)) {
    throw UsageError(
        "home: the card's place was counted in other scales than those of this machine file: `trammel zero` with all "
        "axes where they stand, then home");
  }
  take_over(card, choice, machine);
  run::configure(card, machine);
  run::set_keeps_place(card, machine);
}

gcode::Coordinates standing(driver::Card& card, const machine::Machine& machine) {
  const run::CardPlace place = run::read_card_place(card);
  return run::scales_fit(place, machine) ? run::standing_at(machine, place) : gcode::Coordinates{};
}

void show(const machine::Machine& machine, const std::vector<run::HomedAxis>& homed, const gcode::Coordinates& at) {
  std::string text;
  for (const run::HomedAxis& axis : homed) {
    text += fmt::format(
        "{} homed: the edges of search and approach differ by {:.4f} {}{}\n", machine.axes[axis.axis].letter,
        std::abs(axis.search_edge - axis.edge), run::unit_of(machine.axes[axis.axis].letter),
        axis.squared_by == 0 ? "" : fmt::format("; second motor squared by {:.4f} mm", axis.squared_by));
  }
  to_standard_output(text + fmt::format("the machine stands at {}\n", run::place_text(at, machine)));
}

void home_on(driver::Card& card, transport::Connection& connection, const HomeOptions& options) {
  const machine::Machine machine = options.machine.load();
  match_axes(card, machine);
  limit_patience(connection, machine.motion);
  const std::vector<std::size_t> axes = axes_of(options.words, machine);
  prepare(card, machine, options.card);
  run::MachinePosition position(card.read_snapshot(), machine);
  const gcode::Coordinates at = standing(card, machine);
  for (std::size_t n = 0; n < machine.axes.size(); ++n) position.set(n, at[n]);
  const MotionWatchdog watchdog(card, machine.motion);
  const StopAtSignals signals(card);
  const run::HomingOptions told{[](const std::string& text) { tell("note", text); }};
  try {
    const std::vector<run::HomedAxis> homed = run::home(card, machine, position, axes, told);
    show(machine, homed, standing(card, machine));
  } catch (const driver::StoppedError&) {
    signals.end(run::place_text(position.millimetres(), machine));
  } catch (const driver::ArgumentError& error) {
    throw UsageError(error.what());
  } catch (const driver::Error&) {
    tell_of_stop(card, connection, machine);
    throw;
  }
}

void home(const HomeOptions& options) {
  const auto url = options.card.url();
  if (!url) throw UsageError("home: needs --card, because a card that this command simulates has no switches");
  with_card(*url, Purpose::kMove,
            [&](driver::Card& card, transport::Connection& connection) { home_on(card, connection, options); });
}

}  // namespace

void add_home_command(CLI::App& app) {
  auto options = std::make_shared<HomeOptions>();
  CLI::App* command =
      app.add_subcommand("home", "home axes of an external card: move each to its switch, and set machine zero by it");
  command->add_option("axes", options->words, "letters of the axes (default: all that the machine file can home)")
      ->type_name("AXIS");
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  command->callback([options] { home(*options); });
}

}  // namespace trammel::app
