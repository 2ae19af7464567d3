// The description of a world: plain data, from a world file (world_file.hpp) or written by the program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/world/carriage.hpp"
#include "trammel/world/contact.hpp"

namespace trammel::world {

// Number of the card's inputs that a world can wire.
inline constexpr unsigned kMostInputs = 32;

struct AxisDescription {
  char letter = 'X';
  unsigned card_axis = 0;   // axis of the card, 0 to 7; used by one axis only
  double pulses_a_mm = 80;  // pulses per mm; per degree for A, B and C; for display only; > 0
  CarriageParameters carriage;
  // For a drive that monitors its motor: lag behind the field, full steps, at which the drive raises its alarm (the
  // button "<letter>_alarm"). The motor has no power until the alarm is released. nullopt: no monitoring. > 0
  std::optional<double> alarm_at;
};

// A switch that a carriage presses, or a plate that a probe touches.
struct SwitchDescription {
  std::string name;
  unsigned input = 0;           // input of the card, below kMostInputs
  unsigned axis = 0;            // index of its axis in the description
  std::int64_t at = 0;          // position at which it is pressed, pulses
  bool above = false;           // true: pressed at and above this position; false: at and below
  std::int64_t hysteresis = 0;  // pulses, >= 0: distance back to the release
  ContactParameters contact;
};

// A contact that a person or the script of events presses: a button, or a drive's alarm.
struct ButtonDescription {
  std::string name;
  std::optional<unsigned> input;  // input of the card, below kMostInputs; nullopt: the emergency stop's pin
  bool cuts_power = false;        // cuts the power of all motors while it is pressed
  ContactParameters contact;
  // Delay from the press to the loss of power, s, >= 0, as behind a delay relay.
  double power_delay = 0;
};

struct Event {
  std::uint64_t nanoseconds = 0;  // card time
  std::string button;
  bool press = true;  // false: release
};

struct Description {
  std::uint64_t seed = 1;     // seed of the contacts' bounces
  bool closed_level = false;  // level at a pin while its contact is closed: 0 with a pull-up and a switch to ground
  std::vector<AxisDescription> axes;
  std::vector<SwitchDescription> switches;
  std::vector<ButtonDescription> buttons;
  std::vector<Event> events;  // in any order
};

// Name of the button of a drive's alarm: "x_alarm".
std::string alarm_name(char letter);

}  // namespace trammel::world
