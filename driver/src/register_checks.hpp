// Checks of values against the register map, and a register that several settings share.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/registers.hpp"

namespace trammel::driver {

inline constexpr std::uint16_t kMapMinorOfRest = 4;  // the area REST and STATUS.settled came with map 3.4

inline const card_map::Register& register_at(std::uint32_t address) { return *card_map::find_register(address).entry; }

inline std::uint32_t field_bits(std::uint32_t value, std::uint32_t mask, std::uint32_t shift) {
  return (value & mask) >> shift;
}

// Throws ArgumentError, whose message starts with `what`, unless the register accepts the value: no undefined bits,
// within the limits of its field.
inline void check_setting(std::uint32_t address, std::uint64_t value, const std::string& what) {
  const card_map::Register& setting = register_at(address);
  const std::uint64_t max = setting.limited != 0 ? setting.maximum : setting.mask;
  const std::uint64_t min = setting.limited != 0 ? setting.minimum : 0;
  if (value < min || value > max) {
    throw ArgumentError(fmt::format("{} is outside {} .. {} ({})", what, min, max, setting.name));
  }
}

// Throws IdentificationError unless the value of an identification register is within the limits of this driver.
inline void check_field(std::uint32_t address, std::uint32_t value, std::uint32_t min, std::uint32_t max,
                        const char* unit) {
  if (value >= min && value <= max) return;
  throw IdentificationError(
      fmt::format("card: {}: {} {}, this driver takes {} to {}", register_at(address).name, value, unit, min, max));
}

// Throws ArgumentError unless the card has path commands.
inline void require_path_commands(std::uint32_t engines, std::string_view what) {
  if (card_map::has_engine(engines, card_map::engine::kPathCommands)) return;
  throw ArgumentError(fmt::format("{}: needs {}, which the card does not have (engines 0x{:X})", what,
                                  card_map::kEngineNames[card_map::engine::kPathCommands], engines));
}

// Sets the bits of STOP_REACTION in `mask`; the others stay. 1: stop on a ramp.
inline void set_reactions(Registers& registers, std::uint32_t mask, std::uint32_t ramps, std::string_view what) {
  const std::uint32_t before = registers.read(card_map::reg::kStopReaction);
  registers.write(card_map::reg::kStopReaction, (before & ~mask) | ramps, what);
}

}  // namespace trammel::driver
