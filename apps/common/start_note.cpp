#include "start_note.hpp"

#include <fmt/format.h>

#include <string>

#include "terminal.hpp"
#include "trammel/run/end_position.hpp"

namespace trammel::app {

void tell_of_start(const run::Start& start, const run::CardPlace& found) {
  std::string text;
  if (!found.was_set()) {
    text = "the card was reset: machine zero is where it stands now";
  } else if (start.at != gcode::Coordinates{} || !start.limits_off.empty()) {
    text = "the machine stands at " + run::place_text(start.at, start.machine);
  }
  if (!start.limits_off.empty()) text += fmt::format("; soft limits of {} are off: not homed", start.limits_off);
  if (!text.empty()) tell("note", text);
}

}  // namespace trammel::app
