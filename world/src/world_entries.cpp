#include "world_entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "events.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::world {

namespace {

constexpr std::string_view kLetters = "XYZABCUVWE";  // in the order of the card's axes
constexpr Bounds kPlace{-1e6, 1e6, "mm"};

char letter_of(const Table& table) {
  const std::string& name = table.name();
  const char letter = name.size() == 1 ? static_cast<char>(std::toupper(static_cast<unsigned char>(name[0]))) : ' ';
  if (kLetters.find(letter) == std::string_view::npos || name[0] == letter) {
    table.refuse("is no axis: axes are x y z a b c u v w e, as [axis.x]");
  }
  return letter;
}

ContactParameters read_contact(Table& table, bool normally_closed) {
  ContactParameters contact;
  contact.normally_closed = table.word("normally", {"open", "closed"}, normally_closed ? 1 : 0) == 1;
  contact.bounce = table.number("bounce", {0, 1000, "ms"}, contact.bounce * 1e3) / 1e3;
  contact.bounces = static_cast<unsigned>(table.whole("bounces", ContactParameters::kMostBounces, contact.bounces));
  return contact;
}

unsigned read_input(Table& table, const char* key) {
  return static_cast<unsigned>(table.whole(key, sim::kInputs - 1, 0));
}

MotorParameters read_motor(Table& table) {
  constexpr double kGramSquareCentimetre = 1e-7;  // kg m^2
  constexpr double kTurn = 6.283185307179586;
  MotorParameters motor;
  motor.pulses_a_full_step = table.number("microsteps", {1, 1024, ""}, motor.pulses_a_full_step);
  motor.full_steps_a_turn = table.number("full_steps_a_turn", {4, 10'000, ""}, motor.full_steps_a_turn);
  motor.radius = table.number("mm_a_turn", {1e-3, 1e5, "mm"}, 40) / 1e3 / kTurn;
  motor.holding_torque = table.number("torque", {1e-6, 1e4, "N m"}, motor.holding_torque);
  motor.rotor_inertia =
      table.number("rotor", {1e-3, 1e9, "g cm^2"}, motor.rotor_inertia / kGramSquareCentimetre) * kGramSquareCentimetre;
  motor.mass = table.number("mass", {0, 1e6, "kg"}, motor.mass);
  motor.friction = table.number("friction", {0, 1e4, "N m"}, motor.friction);
  motor.damping = table.number("damping", {0, 1e4, "N m s"}, motor.damping);
  return motor;
}

std::int64_t pulses_of(const AxisDescription& axis, double millimetres) {
  return std::llround(millimetres * axis.pulses_a_mm);
}

AxisDescription read_axis(Table& table, Reading& reading) {
  AxisDescription axis;
  axis.letter = letter_of(table);
  MotorParameters& motor = axis.carriage.motor;
  motor = read_motor(table);
  axis.pulses_a_mm =
      motor.pulses_a_full_step * motor.full_steps_a_turn / table.number("mm_a_turn", {1e-3, 1e5, "mm"}, 40);
  if (table.has("low")) axis.carriage.low = pulses_of(axis, table.number("low", {-1e6, 0, "mm"}, 0));
  if (table.has("high")) axis.carriage.high = pulses_of(axis, table.number("high", {0, 1e6, "mm"}, 0));
  table.find("low"), table.find("high"), table.find("card_axis");
  if (table.has("alarm_at")) {
    axis.alarm_at = table.number("alarm_at", {0.1, 1e6, "full steps"}, 0);
    if (!table.has("alarm")) table.refuse("alarm_at", "needs an input of the card: alarm = 8");
  }
  table.find("alarm_at"), table.find("alarm");
  if (table.has("alarm")) {
    ButtonDescription alarm{alarm_name(axis.letter), read_input(table, "alarm"), false, {false, 0, 0}};
    alarm.contact.normally_closed = table.word("alarm_normally", {"open", "closed"}, 0) == 1;
    reading.lines.emplace_back("button " + alarm.name, table.line());
    reading.world.buttons.push_back(alarm);
  }
  table.find("alarm_normally");
  return axis;
}

}  // namespace

// Axes are in the card's order, unless the entry card_axis selects another axis of the card.
void read_axes(Table& root, Reading& reading) {
  std::vector<Table> tables = root.tables("axis");
  if (tables.empty()) root.refuse("no axis: at least one table [axis.x]");
  std::sort(tables.begin(), tables.end(),
            [](const Table& a, const Table& b) { return kLetters.find(letter_of(a)) < kLetters.find(letter_of(b)); });
  for (Table& table : tables) {
    AxisDescription axis = read_axis(table, reading);
    axis.card_axis = static_cast<unsigned>(table.whole("card_axis", 7, reading.world.axes.size()));
    table.refuse_other_keys();
    reading.lines.emplace_back(fmt::format("axis {}", axis.letter), table.line());
    reading.world.axes.push_back(axis);
  }
}

void read_switch(Table& table, Reading& reading) {
  SwitchDescription one;
  one.name = table.name();
  std::vector<std::string> letters;
  for (const AxisDescription& axis : reading.world.axes) {
    letters.emplace_back(1, static_cast<char>(std::tolower(static_cast<unsigned char>(axis.letter))));
  }
  if (!table.has("input") || !table.has("axis") || table.has("below") == table.has("above")) {
    table.refuse("needs input = 0, axis = \"x\", and the place in mm where it is pressed: below = -100 or above = 300");
  }
  one.axis = static_cast<unsigned>(table.word("axis", letters, 0));
  const AxisDescription& axis = reading.world.axes[one.axis];
  one.input = read_input(table, "input");
  one.above = table.has("above");
  one.at = pulses_of(axis, table.number("below", kPlace, 0) + table.number("above", kPlace, 0));
  one.hysteresis = pulses_of(axis, table.number("release", {0, 1e6, "mm"}, 0.1));
  one.contact = read_contact(table, true);
  table.refuse_other_keys();
  reading.lines.emplace_back("switch " + one.name, table.line());
  reading.world.switches.push_back(one);
}

void read_button(Table& table, Reading& reading) {
  ButtonDescription button;
  button.name = table.name();
  const bool emergency = table.flag("emergency_stop", false);
  if (table.has("input") == emergency) table.refuse("needs either input = 6 or emergency_stop = true");
  if (!emergency) button.input = read_input(table, "input");
  table.find("input");
  button.cuts_power = table.flag("cuts_power", emergency);
  button.power_delay = table.number("power_off_after", {0, 60'000, "ms"}, 0) / 1e3;
  button.contact = read_contact(table, emergency);
  table.refuse_other_keys();
  reading.lines.emplace_back("button " + button.name, table.line());
  reading.world.buttons.push_back(button);
}

void read_events(Table& root, Reading& reading) {
  const toml::value* list = root.find("events");
  if (list == nullptr) return;
  if (!list->is_array()) root.refuse("events", "must be a list: [\"at 1.5 s press estop\"]");
  for (const toml::value& one : list->as_array()) {
    if (!one.is_string()) root.refuse("events", "must be a list of texts: [\"at 1.5 s press estop\"]");
    reading.world.events.push_back(parse_event(one.as_string().str, root.file(), one.location().line(), reading.world));
  }
}

}  // namespace trammel::world
