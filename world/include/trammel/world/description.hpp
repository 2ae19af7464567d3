// What a world consists of: plain data, by a world file (world_file.hpp) or by hand.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/world/carriage.hpp"
#include "trammel/world/contact.hpp"

namespace trammel::world {

// Inputs of the card that a world can wire.
inline constexpr unsigned kMostInputs = 32;

struct AxisDescription {
  char letter = 'X';
  unsigned card_axis = 0;   // of the card, 0 to 7; each axis has its own
  double pulses_a_mm = 80;  // a degree for A, B and C; for those who show places; > 0
  CarriageParameters carriage;
  // Of a drive that watches its motor: so far behind its field, full steps, it raises its alarm (the button
  // "<letter>_alarm"), and the motor is without power until that is released. None: it does not watch. > 0
  std::optional<double> alarm_at;
};

// A switch that a carriage presses, or a plate that a probe touches.
struct SwitchDescription {
  std::string name;
  unsigned input = 0;           // of the card, below kMostInputs
  unsigned axis = 0;            // index of its axis in the description
  std::int64_t at = 0;          // pulses: where it is pressed
  bool above = false;           // from there on upwards; else downwards
  std::int64_t hysteresis = 0;  // pulses, >= 0: so far back it is released
  ContactParameters contact;
};

// Something that a person presses, or that the script of events does: a button, a drive's alarm.
struct ButtonDescription {
  std::string name;
  std::optional<unsigned> input;  // of the card, below kMostInputs; none: the emergency stop's pin
  bool cuts_power = false;        // of all motors, while it is pressed
  ContactParameters contact;
  double power_delay = 0;  // s, >= 0: the power goes so long after the press, as behind a relay with a delay
};

struct Event {
  std::uint64_t nanoseconds = 0;  // of the card's time
  std::string button;
  bool press = true;  // else release
};

struct Description {
  std::uint64_t seed = 1;     // of the contacts' bounces
  bool closed_level = false;  // at a pin while its contact is closed: 0 with a pull-up and a switch to ground
  std::vector<AxisDescription> axes;
  std::vector<SwitchDescription> switches;
  std::vector<ButtonDescription> buttons;
  std::vector<Event> events;  // in any order
};

// The button of a drive's alarm: "x_alarm".
std::string alarm_name(char letter);

}  // namespace trammel::world
