// Where a stop has left a card, and what to do about its fault, for people.
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
  driver::LimitState limits;         // of FAULT
  std::optional<driver::Rest> rest;  // of the last stop, where the card still stands there

  std::uint32_t faults() const { return place.now.faults; }
};

// Of a card that is not on its way to a stop, or that moves. Throws as driver::Card does.
StoppedCard read_stopped(driver::Card& card);

// "X 90.0125 Y 0.0000 mm (pulses 7201, 0)"; pulses of the card's axes alone where no machine zero says more.
std::string standing_text(const machine::Machine& machine, const StoppedCard& card);

// How far on the path the last stop was: "in command 3 of the geometry queue, 1234 ticks before its end (exact)".
std::string path_text(const driver::Rest& rest, std::uint32_t clock_hz);

// What to do about a fault, a sentence each: which axes to move which way, what to remove, how to clear it. None
// without a fault.
std::vector<std::string> fault_cures(const machine::Machine& machine, const StoppedCard& card);

// Both, in one line: where the card stands, how far on the path, and what to do.
std::string stop_text(const machine::Machine& machine, const StoppedCard& card);

}  // namespace trammel::app
