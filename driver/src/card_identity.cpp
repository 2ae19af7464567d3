#include "card_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

std::uint32_t longest_command(bool map::Command::*queue, const Identification& card) {
  std::uint32_t result = 0;
  for (const map::Command& command : map::kCommands) {
    if (!map::is_known(command, card.engines)) {
      continue;
    }
    const auto mask = static_cast<std::uint8_t>(command.axis_halfwords != 0 ? (1U << card.axes) - 1 : 0);
    result = std::max(result, command.*queue ? map::queue_halfwords(command, mask) : 0);
  }
  return result;
}

// The component to update if card and driver have different versions.
const char* update(std::uint32_t on_card, std::uint32_t here) {
  return on_card > here ? "update the driver" : "update the card's bitstream";
}

void check_versions(const Identification& card) {
  const std::uint32_t major = field_bits(map::kMapVersionValue, field::kMapVersionMajor, field::kMapVersionMajorShift);
  if (card.map_major != major) {
    throw IdentificationError(fmt::format("card: MAP_VERSION: {}.{}, this driver takes version {}: {}", card.map_major,
                                          card.map_minor, major, update(card.map_major, major)));
  }
  if (card.commands_version != map::kCommandsVersionValue) {
    throw IdentificationError(fmt::format("card: COMMANDS_VERSION: {}, this driver takes version {}: {}",
                                          card.commands_version, map::kCommandsVersionValue,
                                          update(card.commands_version, map::kCommandsVersionValue)));
  }
}

void check_build(const Identification& card) {
  constexpr std::uint32_t kDeepest = 32768;  // halfwords; the RTL refuses to build larger queues
  check_field(reg::kClockHz, card.clock_hz, 1, register_at(reg::kClockHz).mask, "Hz (its clock strap)");
  check_field(reg::kGeometryDepth, card.geometry_depth, longest_command(&map::Command::to_geometry, card), kDeepest,
              "halfwords");
  check_field(reg::kFeedDepth, card.feed_depth, longest_command(&map::Command::to_feed, card), kDeepest, "halfwords");
}

// Reads of the step times of all axes, and room for one more access.
struct StepTimes {
  explicit StepTimes(unsigned axes) {
    for (unsigned axis = 0; axis < axes; ++axis) {
      accesses[count++] = read_of(reg::step_length(axis));
      accesses[count++] = read_of(reg::step_space(axis));
    }
  }
  std::uint32_t period(unsigned axis) const {
    Registers::check_read(accesses[2 * axis]);
    Registers::check_read(accesses[2 * axis + 1]);
    return shortest_pulse_period(accesses[2 * axis].data, accesses[2 * axis + 1].data);
  }
  std::array<Access, 2 * map::kMaxAxes + 1> accesses{};
  std::size_t count = 0;
};

// Makes reads that a card known to this driver cannot refuse.
void read_identity(Bus& bus, Access* accesses, std::size_t count) {
  const std::size_t made = bus.transfer(accesses, count);
  if (made < count) {
    throw IdentificationError(
        fmt::format("card: no Trammel card answers: the read of 0x{:03X} was refused", accesses[made].address));
  }
}

}  // namespace

Identification read_identification(Bus& bus) {
  Access magic = read_of(reg::kMagic);
  read_identity(bus, &magic, 1);
  if (magic.data != map::kMagicValue) {
    throw IdentificationError(
        fmt::format("card: no Trammel card answers: MAGIC reads 0x{:08X}, not 0x{:08X}", magic.data, map::kMagicValue));
  }
  std::array<Access, 6> who{read_of(reg::kMapVersion), read_of(reg::kCommandsVersion), read_of(reg::kAxes),
                            read_of(reg::kClockHz),    read_of(reg::kGeometryDepth),   read_of(reg::kFeedDepth)};
  read_identity(bus, who.data(), who.size());
  Identification identification;
  identification.map_major =
      static_cast<std::uint16_t>(field_bits(who[0].data, field::kMapVersionMajor, field::kMapVersionMajorShift));
  identification.map_minor =
      static_cast<std::uint16_t>(field_bits(who[0].data, field::kMapVersionMinor, field::kMapVersionMinorShift));
  identification.commands_version = who[1].data;
  check_versions(identification);
  identification.axes = who[2].data;
  identification.clock_hz = who[3].data;
  identification.geometry_depth = who[4].data;
  identification.feed_depth = who[5].data;
  check_field(reg::kAxes, identification.axes, 1, map::kMaxAxes, "axes");
  identification.units = UnitTable::read(bus, identification.axes);
  identification.engines = identification.units.engines();
  check_build(identification);
  return identification;
}

CardTiming read_timing(Bus& bus, const Identification& card) {
  CardTiming timing;
  timing.clock_hz = card.clock_hz;
  timing.axes = card.axes;
  StepTimes times(card.axes);
  read_identity(bus, times.accesses.data(), times.count);
  for (unsigned axis = 0; axis < card.axes; ++axis) timing.pulse_period[axis] = times.period(axis);
  return timing;
}

void check_identity(CardParts& card) {
  StepTimes times(card.identification.axes);
  times.accesses[times.count] = read_of(reg::kMagic);
  const Access& magic = times.accesses[times.count];
  if (card.registers.try_transfer(times.accesses.data(), times.count + 1) <= times.count ||
      magic.data != map::kMagicValue) {
    throw LinkError(fmt::format("card: it does not answer any more: MAGIC reads 0x{:08X}", magic.data));
  }
  for (unsigned axis = 0; axis < card.identification.axes; ++axis) {
    if (times.period(axis) != card.timing.pulse_period[axis]) {
      throw StateError(
          fmt::format("card: axis {} has other step times than it was given: the card was reset since, or is used by "
                      "another program",
                      axis));
    }
  }
}

Build read_build(Registers& registers) {
  std::array<Access, 3> accesses{read_of(reg::kBuildId), read_of(reg::kBuildFlags), read_of(reg::kBoardId)};
  registers.transfer(accesses.data(), accesses.size(), "build");
  Registers::check_read(accesses[1]);
  return {accesses[0].data, (accesses[1].data & field::kBuildFlagsDirty) != 0, accesses[2].data};
}

}  // namespace trammel::driver
