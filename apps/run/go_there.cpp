#include "go_there.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include "common/card_choice.hpp"
#include "common/errors.hpp"
#include "common/stop_at_signals.hpp"
#include "common/terminal.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {
namespace {

constexpr double kShareOfVelocity = 0.25;  // the default of a jog
constexpr double kMinute = 60;

double speed_of(const machine::Machine& machine, const gcode::Coordinates& from, const gcode::Coordinates& to) {
  double speed = 0;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const double most = kShareOfVelocity * machine.axes[i].max_velocity;
    if (from[i] != to[i]) speed = speed == 0 ? most : std::min(speed, most);
  }
  return speed;
}

std::string line_to(const machine::Machine& machine, const gcode::Coordinates& to, double speed) {
  std::string text = fmt::format("G53 G1 F{:.6f}", speed * kMinute);
  for (std::size_t i = 0; i < machine.axes.size(); ++i) text += fmt::format(" {}{:.9f}", machine.axes[i].letter, to[i]);
  return text + "\n";
}

void ask(const std::string& what, bool yes) {
  tell("note", what);
  if (yes) return;
  if (::isatty(STDIN_FILENO) == 0)
    throw UsageError("nothing has moved, because there is no terminal on which to ask. Give --yes to allow this move");
  std::cerr << "move there? [y/N] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "y" && answer != "Y" && answer != "yes") throw UsageError("nothing has moved");
}

}  // namespace

void go_there(driver::Card& card, const machine::Machine& machine, const planner::Pulses& from,
              const planner::Pulses& to, bool yes) {
  if (from == to) return;
  const kinematics::Kinematics kinematics(machine);
  const gcode::Coordinates here = kinematics.coordinates(from);
  const gcode::Coordinates there = kinematics.coordinates(to);
  const double speed = speed_of(machine, here, there);
  const std::string text = line_to(machine, there, speed);
  run::RunSettings settings;
  settings.start = here;
  settings.stands_at = from;
  run::Runner runner([text] { return std::make_unique<gcode::TextLines>(text, "the way there"); }, machine,
                     planner::limits_of(card.identification()), settings);
  if (runner.plan().end != to)
    throw UsageError("the machine is not where the run begins, and no straight line leads exactly there");
  ask(fmt::format("the machine stands at {}, but the run begins at {}: the machine moves there first, on a straight "
                  "line at {:g} mm/s",
                  run::place_text(here, machine), run::place_text(there, machine), speed),
      yes);
  const MotionWatchdog watchdog(card, machine.motion);
  run_until_signal(runner, card, machine, false);
}

}  // namespace trammel::app
