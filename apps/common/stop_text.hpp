// The position of a card after a stop, and the remedy for its fault, as text for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/card_place.hpp"

namespace trammel::app {

struct StoppedCard {
  run::CardPlace place;
  std::uint32_t clock_hz = 0;
  unsigned axes = 0;
  driver::LimitState limits;         // details of the causes in FAULT
  std::optional<driver::Rest> rest;  // record of the last stop, if the card is still at that position

  std::uint32_t faults() const { return place.now.faults; }
};

// Reads the state of a card. `rest` stays empty while the card moves or is still stopping. Throws as driver::Card does.
StoppedCard read_stopped(driver::Card& card);

// "X 90.0125 Y 0.0000 mm (pulses 7201, 0)"; only pulses of the card's axes if no machine zero was set.
std::string standing_text(const machine::Machine& machine, const StoppedCard& card);

// The place on the path of the last stop: "in command 3 of the geometry queue, 1234 ticks before its end (exact)".
std::string path_text(const driver::Rest& rest, std::uint32_t clock_hz);

// The remedy for a fault, one sentence per action: which axes to move in which direction, what to remove, how to clear
// the fault. Empty without a fault.
std::vector<std::string> fault_cures(const machine::Machine& machine, const StoppedCard& card);

// All in one line: the card's position, its place on the path, and the remedy.
std::string stop_text(const machine::Machine& machine, const StoppedCard& card);

}  // namespace trammel::app
