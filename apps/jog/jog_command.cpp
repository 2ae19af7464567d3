#include "jog_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/standard_streams.hpp"
#include "common/start_note.hpp"
#include "common/stop_at_signals.hpp"
#include "common/terminal.hpp"
#include "key_jog.hpp"
#include "key_terminal.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/requests.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/jog.hpp"

namespace trammel::app {
namespace {

constexpr std::chrono::milliseconds kLook(10);  // polling interval for keys and card while an axis moves
constexpr std::chrono::milliseconds kIdleLook(50);

struct JogArguments {
  std::vector<std::string> words;
  std::optional<double> speed;
  bool override_limits = false;
  MachineChoice machine;
  CardChoice card;
};

struct Distances {
  gcode::Coordinates by{};
  unsigned named = 0;  // bit n: axis n of the machine
};

// Parses "X10": the axis and its distance, mm or degrees.
void add_word(const std::string& word, const machine::Machine& machine, Distances& distances) {
  const auto wrong = [&](const char* why) { return UsageError(fmt::format("jog: {}: {}", word.substr(0, 40), why)); };
  const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(word.empty() ? ' ' : word.front())));
  const auto axis = machine.axis(letter);
  if (!axis) throw wrong("must be an axis of the machine and a distance in mm (degrees), such as X10 or Y-0.5");
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data() + 1, end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) throw wrong("the distance must be a number");
  if ((distances.named >> *axis & 1U) != 0) throw wrong("the axis is given twice");
  distances.named |= 1U << *axis;
  distances.by[*axis] = value;
}

gcode::Coordinates distance_of(const std::vector<std::string>& words, const machine::Machine& machine) {
  Distances distances;
  for (const std::string& word : words) add_word(word, machine, distances);
  return distances.by;
}

// Speed along the path: the slowest axis that moves determines it.
double default_speed(const machine::Machine& machine, const gcode::Coordinates& distance) {
  double speed = 0;
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const double quarter = machine.axes[axis].max_velocity / 4;
    if (distance[axis] != 0) speed = speed == 0 ? quarter : std::min(speed, quarter);
  }
  return speed;
}

void move_by(run::Jog& jog, const run::MachinePosition& position, const machine::Machine& machine,
             const JogArguments& options) {
  const gcode::Coordinates distance = distance_of(options.words, machine);
  const gcode::Coordinates from = position.millimetres();
  try {
    jog.start(distance, options.speed.value_or(default_speed(machine, distance)));
  } catch (const driver::ArgumentError& error) {
    throw UsageError(error.what());
  }
  jog.wait();
  const gcode::Coordinates at = position.millimetres();
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const double pulse = 1 / machine.axes[axis].steps_per_mm;
    if (std::abs(at[axis] - from[axis] - distance[axis]) <= pulse) continue;
    tell("note",
         fmt::format("{} moved by {:.4f} mm instead of {:.4f} mm, because a soft limit (min or max) is in the way",
                     machine.axes[axis].letter, at[axis] - from[axis], distance[axis]));
  }
}

void show(const KeyJog& jog, std::string& shown) {
  const std::string line = jog.line() + (jog.note().empty() ? "" : "   " + jog.note());
  if (line == shown) return;
  shown = line;
  to_standard_output(fmt::format("\r{}\x1b[K", line));
  finish_standard_streams();
}

void move_by_keys(driver::Card& card, KeyJog& jog) {
  using Clock = std::chrono::steady_clock;
  to_standard_output(
      "arrows: X and Y   page up, page down: Z   [ ]: the fourth axis   + -: speed\n"
      "1 2 3 4: by 0.01, 0.1, 1, 10   0: while the key is held   space: stop   q: end\n");
  const KeyTerminal terminal;
  std::string shown;
  bool moving = false;
  while (moving || !jog.ended()) {
    show(jog, shown);
    // The bus sleeps in card time.
    if (moving) card.bus().sleep(kLook);
    const auto bytes = terminal.read(moving ? std::chrono::milliseconds(0) : kIdleLook);
    if (!bytes) jog.keys({{JogKey::Kind::kEnd}}, Clock::now());
    if (bytes) jog.keys(jog_keys(*bytes), Clock::now());
    moving = jog.look(Clock::now());
    if (!moving) driver::serve_requests(card);
  }
  show(jog, shown);
  to_standard_output("\n");
}

// Reads the card's place and completes it.
run::Start begin_at_place(driver::Card& card, const machine::Machine& machine, const CardChoice& choice) {
  const run::CardPlace found = run::read_card_place(card);
  run::start_at(machine, found, choice.trust_position);  // a refusal leaves the card unchanged
  take_over(card, choice, machine);
  const run::CardPlace now = run::read_card_place(card);
  const run::Start start = run::start_at(machine, now, choice.trust_position);
  tell_of_start(start, now);
  run::configure(card, machine);
  run::set_keeps_place(card, machine);
  run::keep_place(card, now, run::scales_of(machine), run::motors_of(machine));
  run::guard_soft_limits(card, start.machine, run::read_card_place(card));
  return start;
}

// Refuses a jog further into an active limit, if the card knows its side.
void check_way(const machine::Machine& machine, const gcode::Coordinates& by, const driver::ActiveRoles& active) {
  for (std::size_t n = 0; n < machine.axes.size(); ++n) {
    const bool minus = (active.limit_minus >> n & 1U) != 0;
    const bool plus = (active.limit_plus >> n & 1U) != 0;
    if (minus == plus || by[n] == 0 || (by[n] > 0) != plus) continue;
    throw UsageError(fmt::format("--override-limits: {}{:g} goes further into the limit at the {} end",
                                 machine.axes[n].letter, by[n], plus ? "plus" : "minus"));
  }
}

// Requires that the card's roles are set.
void override_limits(driver::Card& card, const machine::Machine& machine, const JogArguments& options) {
  if (!options.override_limits) return;
  constexpr std::uint64_t kSettled = 256;  // clocks: longer than roles take to follow their inputs
  card.bus().sleep(driver::time_of(kSettled, card.identification().clock_hz));
  const driver::ActiveRoles active = card.read_roles();
  check_way(machine, distance_of(options.words, machine), active);
  if ((active.limit_minus | active.limit_plus) == 0) return tell("note", "--override-limits: no limit is active");
  card.override_limits(active.limit_minus, active.limit_plus);
  tell("note", "the limits that are active now stop nothing until they are released");
}

void jog_on(driver::Card& card, transport::Connection& connection, const JogArguments& options) {
  const machine::Machine file = options.machine.load();
  match_axes(card, file);
  limit_patience(connection, file.motion);
  distance_of(options.words, file);  // impossible distances are refused first
  const run::Start start = begin_at_place(card, file, options.card);
  const machine::Machine& machine = start.machine;
  override_limits(card, machine, options);
  run::MachinePosition position(card.read_snapshot(), machine);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) position.set(axis, start.at[axis]);
  const MotionWatchdog watchdog(card, machine.motion);
  const StopAtSignals signals(card);
  try {
    if (options.words.empty()) {
      KeyJog jog(card, machine, position, options.speed);
      move_by_keys(card, jog);
    } else {
      run::Jog jog(card, machine, position);
      move_by(jog, position, machine, options);
    }
  } catch (const driver::StoppedError&) {
    signals.end(run::place_text(position.millimetres(), machine));
  } catch (const driver::Error&) {
    tell_of_stop(card, connection, machine);
    throw;
  }
  to_standard_output(fmt::format("the machine stands at {}\n", run::place_text(position.millimetres(), machine)));
}

void jog(const JogArguments& options) {
  const auto url = options.card.url();
  if (!url) throw UsageError("jog: needs --card, because a card that this command simulates ends with the command");
  if (options.override_limits && options.words.empty()) {
    throw UsageError("--override-limits: name axes and distances that lead away from the limit, such as X-5");
  }
  if (options.words.empty() && (::isatty(STDIN_FILENO) == 0 || ::isatty(STDOUT_FILENO) == 0)) {
    throw UsageError("jog: name axes and distances, such as X10 Y-0.5; keys need a terminal");
  }
  with_card(*url, Purpose::kMove,
            [&](driver::Card& card, transport::Connection& connection) { jog_on(card, connection, options); });
}

}  // namespace

void add_jog_command(CLI::App& app) {
  auto options = std::make_shared<JogArguments>();
  CLI::App* command =
      app.add_subcommand("jog", "move axes of an external card by a distance, or with keys of the terminal");
  command
      ->add_option("distances", options->words,
                   "axes, each with its distance from where it stands, mm or degrees, such as X10 Y-0.5 (default: "
                   "none; keys of the terminal move the axes)")
      ->type_name("X10");
  command
      ->add_option("--speed", options->speed,
                   "speed along the path, or of each axis with keys, mm/s (default: a quarter of the slowest axis's "
                   "max_velocity; with keys, a quarter of each axis's own)")
      ->check(positive());
  command->add_flag("--override-limits", options->override_limits,
                    "ignore the limits that are active now until they are released. Needed to move away from a limit "
                    "if the card bars both directions (CoreXY, one switch for both ends)");
  options->machine.add_to(*command);
  options->card.add_to_mover(*command);
  command->callback([options] { jog(*options); });
}

}  // namespace trammel::app
