// How a card controls the machine's drives and monitors an emergency-stop chain. Bits of output masks are outputs, bits
// of axis masks axes, bits of fault masks the bits of FAULT.
#pragma once

#include <chrono>
#include <cstdint>

namespace trammel::driver {

// Outputs that follow the state of the drives or of the card. An inactive output has its idle level (strap
// output_idle_i), an active one the opposite level; commands and safe levels do not change it. An output has at most
// one role.
struct OutputRoles {
  std::uint16_t enable = 0;       // active while the drives are enabled
  std::uint16_t brake = 0;        // active while the brake is released
  std::uint16_t charge_pump = 0;  // a square wave while the card is healthy
  std::uint16_t healthy = 0;      // active while the card is healthy

  std::uint16_t all() const { return static_cast<std::uint16_t>(enable | brake | charge_pump | healthy); }
};

// The enable sequence, common to the drives of all axes in `axes`. Delays are rounded up to 4,096 clocks of the card,
// the idle time to 2^20 clocks; each may be up to 65,535 of these units. An emergency stop disables the drives at once.
struct EnableSequence {
  std::uint8_t axes = 0;                          // axes of the sequence; 0: none, motion waits for nothing
  bool manual = false;                            // motion waits for Card::enable(), else enables
  std::chrono::nanoseconds brake_release{0};      // from the enable to the release of the brake
  std::chrono::nanoseconds before_first_step{0};  // from the release to the first step
  std::chrono::nanoseconds after_last_step{0};    // from the last step to the setting of the brake
  std::chrono::nanoseconds brake_set{0};          // from the setting of the brake to the disable
  std::chrono::nanoseconds idle{0};               // without motion, to the disable; 0: never
  std::uint32_t disable_causes = 0;               // faults that disable the drives at rest
};

// Conditions under which the card is healthy.
struct Health {
  std::uint32_t causes = 0;                      // none of these faults is present
  bool needs_watchdog = false;                   // and the watchdog is running
  std::chrono::nanoseconds pump_half_period{0};  // half the wave's period; rounded up to clocks; 0: no wave
};

}  // namespace trammel::driver
