// Reads the card for LinuxCNC: positions of the axes, inputs, and the edges of the probe and of index inputs as the
// card captures them. Positions are pulses from the card's machine zero.
//
// Thread safety: as the card. Throws driver::LinkError and all that driver::Card throws.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trammel/driver/card.hpp"
#include "trammel/linuxcnc/shared_region.h"
#include "trammel/machine/machine.hpp"

namespace trammel::linuxcnc {

class CardLook {
 public:
  using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;

  // `card` and `machine` must outlive this object; the card's place has been set.
  CardLook(driver::Card& card, const machine::Machine& machine);

  // Reads the card, and fills in position, speed, inputs, homed, valid, fault, captures, index_latched, index_position,
  // TRAMMEL_STATUS_LINK, _HELD and _PROBE. The other fields do not change.
  void look(trammel_status& status);
  // The state at the last look().
  const driver::Snapshot& snapshot() const { return now_; }
  Pulses position() const { return from_zero(now_); }
  Pulses from_zero(const driver::Snapshot& snapshot) const;

  // Sets the joints that wait for their index edge, bit n: joint n. A joint that starts to wait gets a capture unit; a
  // joint that stops waiting releases it. Returns the joints that cannot be served: they have no input with the role
  // index, or no unit is free.
  std::uint32_t set_index_waits(std::uint32_t joints);

 private:
  void start_probe();
  void look_at_place(trammel_status& status);
  void look_at_captures(trammel_status& status);
  std::optional<unsigned> free_unit() const;

  driver::Card& card_;
  const machine::Machine& machine_;
  std::array<std::int32_t, card_map::kMaxAxes> zero_{};
  driver::Snapshot now_;
  driver::Snapshot before_;  // start of the speed measurement
  std::optional<unsigned> probe_unit_;
  std::uint32_t waits_ = 0;                                         // joints that wait, as last set
  std::uint32_t latched_ = 0;                                       // joints of `waits_` that have met their edge
  std::array<std::optional<unsigned>, card_map::kMaxAxes> unit_{};  // capture unit of each waiting joint
  unsigned looks_ = 0;
};

}  // namespace trammel::linuxcnc
