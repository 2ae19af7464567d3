// A card's snapshots: the state in one clock, latched by the card on request, at a stop, at a MARK and at a probe's
// edge. The functions are documented in Card. Errors and thread-safety as of Registers.
#pragma once

#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/registers.hpp"

namespace trammel::driver {

class Snapshots {
 public:
  // Both must outlive the object.
  Snapshots(Registers& registers, const Identification& card) : registers_(registers), card_(card) {}

  // Latches one now.
  Snapshot take();
  Snapshot stop() { return read_area(card_map::Area::Stop); }
  Snapshot mark();
  Snapshot probe();
  std::uint32_t marks();
  void clear_probe();
  Rest rest();
  // The snapshot of a valid capture; it is already written, so this does not wait.
  Snapshot capture(card_map::Area area) { return read_without_waiting(area); }

 private:
  // Waits until the snapshot under way has been written.
  void wait_until_written();
  Snapshot read_area(card_map::Area area);
  Snapshot read_without_waiting(card_map::Area area);

  Registers& registers_;
  const Identification& card_;
};

}  // namespace trammel::driver
