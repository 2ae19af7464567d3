// The parts of a card by function: for code with its own way of moving the card, such as streams and one-shot lines,
// and for tools that show registers. Programs that use streams and lines do not need them.
//
// Writes made here bypass the bookkeeping of Card, its streams and its lines: a register that one of them has set keeps
// the value written last. Thread-safety as of Card; any thread may use `requests`.
#pragma once

#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/card_interrupt.hpp"
#include "trammel/driver/low_level/ports.hpp"
#include "trammel/driver/low_level/registers.hpp"
#include "trammel/driver/low_level/requests.hpp"
#include "trammel/driver/low_level/snapshots.hpp"
#include "trammel/driver/low_level/time_base.hpp"
#include "trammel/driver/low_level/watchdog.hpp"

namespace trammel::driver {

struct CardParts {
  CardParts(Bus& bus, Identification card, const CardTiming& times);
  CardParts(const CardParts&) = delete;  // parts refer to one another
  CardParts& operator=(const CardParts&) = delete;

  const Identification identification;
  CardTiming timing;
  Registers registers;
  TimeBase time_base;
  Snapshots snapshots;
  Ports ports;
  CardInterrupt interrupt;
  Watchdog watchdog;
  Requests requests;
};

}  // namespace trammel::driver
