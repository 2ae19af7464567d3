// What a card does about the machine's drives and about an emergency-stop chain. Bits of masks of outputs are outputs,
// bits of masks of axes axes, those of faults the bits of FAULT.
#pragma once

#include <chrono>
#include <cstdint>

namespace trammel::driver {

// Outputs that follow the drives or the card. Each stands at its idle level (the strap output_idle_i) and at the other
// while it is active; commands and safe levels do not change it. An output has one role.
struct OutputRoles {
  std::uint16_t enable = 0;       // active while the drives are enabled
  std::uint16_t brake = 0;        // active while the brake is released
  std::uint16_t charge_pump = 0;  // a square wave while the card is healthy
  std::uint16_t healthy = 0;      // active while the card is healthy

  std::uint16_t all() const { return static_cast<std::uint16_t>(enable | brake | charge_pump | healthy); }
};

// One sequence for the drives of all axes that it names. Times are rounded up to 4,096 clocks of the card, the idle
// time to 2^20; each may be as long as 65,535 of these.
struct EnableSequence {
  std::uint8_t axes = 0;                          // that it serves; 0: none, motion waits for nothing
  bool manual = false;                            // motion waits for Card::enable(); else it enables the drives
  std::chrono::nanoseconds brake_release{0};      // from the enable to the release of the brake
  std::chrono::nanoseconds before_first_step{0};  // from there on
  std::chrono::nanoseconds after_last_step{0};    // until the brake is set, when the drives are to be disabled
  std::chrono::nanoseconds brake_set{0};          // from there to the disable
  std::chrono::nanoseconds idle{0};               // without motion, until they are disabled; 0: never
  std::uint32_t disable_causes = 0;               // faults that disable them at rest; the emergency stop does at once
};

// When the card is healthy.
struct Health {
  std::uint32_t causes = 0;                      // with none of these faults
  bool needs_watchdog = false;                   // and while the watchdog runs
  std::chrono::nanoseconds pump_half_period{0};  // of the charge pump's wave, rounded up to clocks; 0: no wave
};

}  // namespace trammel::driver
