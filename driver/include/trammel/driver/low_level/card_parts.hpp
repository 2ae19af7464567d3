// The parts of a card by duty, for code that moves it in a way of its own, as streams and one-shot lines do, and for
// tools that show registers. Programs that use streams and lines need none of it.
//
// Writes here pass by what Card, its streams and its lines know: a register that one of them has set keeps the value
// that was written last. Thread-safety: as of Card; `requests` is for any thread.
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
