// What LinuxCNC is told of the card: where the axes stand, inputs, and the edges of the probe and of index inputs as
// the card captures them. Positions are pulses from the card's machine zero.
//
// Thread-safety: as of the card. Errors: driver::LinkError and what else driver::Card throws.
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

  // `card` and `machine` must outlive it; the card's place has been set.
  CardLook(driver::Card& card, const machine::Machine& machine);

  // Reads the card, and fills in what it says: position, speed, inputs, homed, valid, fault, captures, index_latched,
  // index_position, TRAMMEL_STATUS_LINK, _HELD and _PROBE. The other fields stay.
  void look(trammel_status& status);
  // As of the last look.
  const driver::Snapshot& snapshot() const { return now_; }
  Pulses position() const { return from_zero(now_); }
  Pulses from_zero(const driver::Snapshot& snapshot) const;

  // Joints that wait for their index edge, bit n: joint n. One that begins to wait gets a capture unit; one that ends
  // is forgotten. Gives back joints that cannot be served: no input with the role index, or no unit left.
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
  driver::Snapshot before_;  // of the speed
  std::optional<unsigned> probe_unit_;
  std::uint32_t waits_ = 0;                                         // joints, as told last
  std::uint32_t latched_ = 0;                                       // of them
  std::array<std::optional<unsigned>, card_map::kMaxAxes> unit_{};  // of a joint that waits
  unsigned looks_ = 0;
};

}  // namespace trammel::linuxcnc
