#include "trammel/driver/unit_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bitset>

#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
using map::Descriptor;

constexpr std::uint32_t kWindowWords = map::kWindowBytes / 4;

const map::Unit* known_unit(std::uint8_t tag) {
  const auto* const found =
      std::find_if(map::kUnits.begin(), map::kUnits.end(), [tag](const map::Unit& unit) { return unit.tag == tag; });
  return found == map::kUnits.end() ? nullptr : found;
}

constexpr const char* kRemedy = "use a bitstream and a driver of one release";

template <typename... Values>
[[noreturn]] void refuse(const Descriptor& d, fmt::format_string<Values...> text, Values&&... values) {
  throw IdentificationError(
      fmt::format("card: unit {}: {}: {}", unit_name(d), fmt::format(text, std::forward<Values>(values)...), kRemedy));
}

using Words = std::bitset<kWindowWords>;

// Marks the words of all instances as used.
void take_words(const Descriptor& d, Words& taken) {
  if (d.words == 0) return;
  const std::uint32_t instances = d.stride == 0 ? 1 : d.instances;
  if (instances > 1 && d.stride < d.words) {
    refuse(d, "a stride of {} words, but an instance uses {}", d.stride, d.words);
  }
  const std::uint32_t end = d.base + (instances - 1) * d.stride + d.words;
  if (end > kWindowWords) refuse(d, "its registers end at word {}, the window at {}", end, kWindowWords);
  for (std::uint32_t instance = 0; instance < instances; ++instance) {
    for (std::uint32_t word = 0; word < d.words; ++word) {
      const std::uint32_t at = d.base + instance * d.stride + word;
      if (taken[at]) refuse(d, "register 0x{:03X} is another unit's as well", 4 * at);
      taken[at] = true;
    }
  }
}

// The driver uses the addresses of the map as constants, so a unit that it knows must be at its address.
void check_known(const Descriptor& d, const map::Unit& unit, unsigned axes) {
  if (d.major != unit.major) {
    refuse(d, "version {}.{}, this driver takes version {}", d.major, d.minor, unit.major);
  }
  const Descriptor expected =
      map::describe(unit, {~std::uint32_t{0}, axes, d.instances, d.instances, d.instances, d.instances});
  if (unit.count == map::UnitCount::Axes && d.instances != axes) {
    refuse(d, "{} instances, but AXES reads {}", d.instances, axes);
  }
  if (d.base != expected.base || (d.instances > 1 && d.stride != expected.stride)) {
    refuse(d, "registers at 0x{:03X}, {} words apart; this driver takes 0x{:03X}, {} words apart", 4 * d.base, d.stride,
           4 * expected.base, expected.stride);
  }
  if (d.words < expected.words) refuse(d, "{} words of registers, this driver takes {}", d.words, expected.words);
}

}  // namespace

UnitTable UnitTable::read(Bus& bus, unsigned axes) {
  constexpr std::size_t kWords = 2 * map::kDescriptorSlots;
  std::array<Access, kWords> accesses;
  for (std::size_t i = 0; i < kWords; ++i) {
    accesses[i] = read_of(map::reg::descriptor(static_cast<std::uint32_t>(i)));
  }
  const std::size_t made = bus.transfer(accesses.data(), kWords);
  if (made < kWords) {
    throw IdentificationError(
        fmt::format("card: no Trammel card answers: the read of 0x{:03X} was refused", accesses[made].address));
  }
  UnitTable table;
  for (std::size_t i = 0; i + 1 < kWords; i += 2) {
    const Descriptor d = map::descriptor_of(accesses[i].data, accesses[i + 1].data);
    if (d.tag == 0) {
      table.check(axes);
      return table;
    }
    table.units_[table.count_++] = d;
  }
  throw IdentificationError(
      fmt::format("card: its table of units does not end within {} descriptors: {}", table.count_, kRemedy));
}

void UnitTable::check(unsigned axes) const {
  Words taken;
  for (const Descriptor& d : *this) {
    if (find(d.tag) != &d) refuse(d, "it is described twice");
    if (d.instances == 0) refuse(d, "0 instances");
    take_words(d, taken);
    if (const map::Unit* const unit = known_unit(d.tag)) check_known(d, *unit, axes);
  }
  for (const map::Unit& unit : map::kUnits) {
    if (unit.engine != map::engine::kLines || find(unit.tag) != nullptr) continue;
    throw IdentificationError(fmt::format("card: no unit {}, which every card has: {}", unit.name, kRemedy));
  }
}

const Descriptor* UnitTable::find(std::uint8_t tag) const {
  const auto* const found = std::find_if(begin(), end(), [tag](const Descriptor& d) { return d.tag == tag; });
  return found == end() ? nullptr : found;
}

std::uint32_t UnitTable::engines() const {
  std::uint32_t result = 0;
  for (const Descriptor& d : *this) result |= engines_of(d);
  return result;
}

std::uint32_t engines_of(const Descriptor& d) {
  const map::Unit* const unit = known_unit(d.tag);
  if (unit == nullptr) return 0;
  std::uint32_t result = 1U << unit->engine;
  for (std::size_t bit = 0; bit < unit->features.size(); ++bit) {
    if (unit->features[bit] != 0 && (d.features >> bit & 1) != 0) result |= 1U << unit->features[bit];
  }
  return result;
}

std::string unit_name(const Descriptor& d) {
  const map::Unit* const unit = known_unit(d.tag);
  return unit != nullptr ? std::string(unit->name) : fmt::format("tag {}", d.tag);
}

std::string feature_names(const Descriptor& d) {
  const map::Unit* const unit = known_unit(d.tag);
  std::string text;
  for (std::size_t bit = 0; bit < 8; ++bit) {
    if ((d.features >> bit & 1) == 0) continue;
    const std::uint32_t engine = unit != nullptr ? unit->features[bit] : 0;
    if (!text.empty()) text += ", ";
    text += engine != 0 ? std::string(map::kEngineNames[engine]) : fmt::format("feature {}", bit);
  }
  return text;
}

}  // namespace trammel::driver
