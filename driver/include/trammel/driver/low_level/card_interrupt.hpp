// A card's interrupt, where the bus has one: pauses that it ends early. Errors and thread-safety: as of Registers.
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

  // Lets up to `clocks` pass: fewer only where the bus has an interrupt and the card is faulted, refuses something or
  // gets to what `wake` asks for, by the bits of IRQ_ENABLE. True for the interrupt.
  bool pause(std::uint64_t clocks, std::uint32_t wake);

  // Whether a wait for room in the queues can end by an interrupt.
  bool tells_of_room() const;
  // What to wake for in pause(), so that it ends when the queues have this much room, halfwords (0: whatever they
  // have). Sets their watermarks. Only where tells_of_room().
  std::uint32_t wake_at_room(std::uint32_t geometry, std::uint32_t feed);

 private:
  void set_watermark(std::uint32_t address, std::optional<std::uint32_t>& written, std::uint32_t value);
  void enable(std::uint32_t wake);

  Registers& registers_;
  const Identification& card_;
  std::optional<std::uint32_t> enabled_;  // as written last, and so the watermarks
  std::optional<std::uint32_t> geometry_watermark_;
  std::optional<std::uint32_t> feed_watermark_;
};

}  // namespace trammel::driver
