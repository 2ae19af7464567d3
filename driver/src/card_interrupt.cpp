#include "trammel/driver/low_level/card_interrupt.hpp"

#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

bool CardInterrupt::pause(std::uint64_t clocks, std::uint32_t wake) {
  if (!registers_.bus().has_interrupt()) {
    registers_.bus().sleep(time_of(clocks, card_.clock_hz));
    return false;
  }
  enable(wake);
  return registers_.bus().wait_for_interrupt(time_of(clocks, card_.clock_hz));
}

bool CardInterrupt::tells_of_room() const {
  return registers_.bus().has_interrupt() && card_map::has_engine(card_.engines, card_map::engine::kWatermarks);
}

// With that much room, fewer than depth - room + 1 halfwords are queued.
std::uint32_t CardInterrupt::wake_at_room(std::uint32_t geometry, std::uint32_t feed) {
  std::uint32_t wake = 0;
  if (geometry != 0) {
    set_watermark(reg::kGeometryWatermark, geometry_watermark_, card_.geometry_depth - geometry + 1);
    wake |= field::kStatusGeometryLow;
  }
  if (feed != 0) {
    set_watermark(reg::kFeedWatermark, feed_watermark_, card_.feed_depth - feed + 1);
    wake |= field::kStatusFeedLow;
  }
  return wake;
}

void CardInterrupt::set_watermark(std::uint32_t address, std::optional<std::uint32_t>& written, std::uint32_t value) {
  if (written == value) return;
  registers_.write(address, value, "watermarks");
  written = value;
}

void CardInterrupt::enable(std::uint32_t wake) {
  const std::uint32_t wanted = field::kStatusFaulted | field::kStatusRefused | wake;
  if (enabled_ == wanted) return;
  registers_.write(reg::kIrqEnable, wanted, "interrupts");
  enabled_ = wanted;
}

}  // namespace trammel::driver
