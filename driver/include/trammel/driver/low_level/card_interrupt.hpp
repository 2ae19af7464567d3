// A card's interrupt, if the bus has one: pauses that the interrupt ends early. Errors and thread-safety as of
// Registers.
#pragma once

#include <cstdint>
#include <optional>

#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/registers.hpp"

namespace trammel::driver {

class CardInterrupt {
 public:
  // Both must outlive the object.
  CardInterrupt(Registers& registers, const Identification& card) : registers_(registers), card_(card) {}

  // Waits for `clocks`. Returns earlier, with true, if the bus has an interrupt and the card has a fault, refuses an
  // access or reaches a condition in `wake` (bits of IRQ_ENABLE).
  bool pause(std::uint64_t clocks, std::uint32_t wake);

  // Whether an interrupt can end a wait for room in the queues.
  bool tells_of_room() const;
  // The `wake` bits with which pause() ends when the queues have this much room, halfwords (0: any room suffices). Sets
  // the watermarks. Requires tells_of_room().
  std::uint32_t wake_at_room(std::uint32_t geometry, std::uint32_t feed);

 private:
  void set_watermark(std::uint32_t address, std::optional<std::uint32_t>& written, std::uint32_t value);
  void enable(std::uint32_t wake);

  Registers& registers_;
  const Identification& card_;
  std::optional<std::uint32_t> enabled_;  // last written value; the same below
  std::optional<std::uint32_t> geometry_watermark_;
  std::optional<std::uint32_t> feed_watermark_;
};

}  // namespace trammel::driver
