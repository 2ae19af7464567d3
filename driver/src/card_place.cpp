// The machine's place that a card keeps: register accesses, and how a program starts from it.
#include "trammel/driver/card_place.hpp"

#include <fmt/format.h>

#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

constexpr unsigned kMapMinorOfPlace = 3;  // the machine's place came with map 3.3

// Checked here because the card's own refusal of the address would explain less.
void check_map(const Identification& card) {
  if (card.map_minor >= kMapMinorOfPlace) return;
  throw ArgumentError(
      fmt::format("the card's map {}.{} keeps no place of the machine, which came with {}.{}: update it",
                  card.map_major, card.map_minor, card.map_major, kMapMinorOfPlace));
}

void check_axes(std::uint8_t axes, unsigned present, const char* what) {
  if (axes >> present == 0) return;
  throw ArgumentError(fmt::format("{}: axes 0x{:02X}: the card has {} axes", what, axes, present));
}

void check_axis(unsigned axis, unsigned present) {
  if (axis >= present) throw ArgumentError(fmt::format("machine zero of axis {}: the card has {} axes", axis, present));
}

unsigned bit(unsigned axis) { return 1U << axis; }

[[noreturn]] void throw_lost(unsigned axes) {
  std::string names;
  for (unsigned n = 0; n < card_map::kMaxAxes; ++n) {
    if ((axes & bit(n)) != 0) names += fmt::format("{}{}", names.empty() ? "axis " : ", ", n);
  }
  throw StateError(
      fmt::format("place: that of {} was lost: the card stopped at once in a motion, or a drive had a fault; set "
                  "machine zero anew, or trust the position if no step was lost",
                  names));
}

}  // namespace

Place Card::read_place() {
  check_map(identification());
  const std::uint32_t place = parts_->registers.read(reg::kPlace);
  Registers::check_read({reg::kPlace, place});
  return {static_cast<std::uint8_t>((place & field::kPlacePositionValid) >> field::kPlacePositionValidShift),
          static_cast<std::uint8_t>((place & field::kPlaceHomed) >> field::kPlaceHomedShift)};
}

void Card::set_place(std::uint8_t axes, bool valid, bool homed) {
  check_map(identification());
  check_axes(axes, identification().axes, "place");
  if (homed && !valid) throw ArgumentError("place: an axis that is homed has a valid place");
  const std::uint32_t bits = (valid ? field::kSetPlacePositionValid : 0) | (homed ? field::kSetPlaceHomed : 0);
  parts_->registers.write(reg::kSetPlace, std::uint32_t{axes} << field::kSetPlaceAxesShift | bits, "place");
}

std::uint8_t Card::read_keeps_place() {
  check_map(identification());
  const std::uint32_t axes = parts_->registers.read(reg::kKeepsPlace);
  Registers::check_read({reg::kKeepsPlace, axes});
  return static_cast<std::uint8_t>(axes);
}

void Card::set_keeps_place(std::uint8_t axes) {
  check_map(identification());
  check_axes(axes, identification().axes, "axes that keep their place");
  parts_->registers.write(reg::kKeepsPlace, axes, "axes that keep their place");
}

std::int32_t Card::read_machine_zero(unsigned axis) {
  check_map(identification());
  check_axis(axis, identification().axes);
  return static_cast<std::int32_t>(parts_->registers.read(reg::machine_zero(axis)));
}

void Card::set_machine_zero(unsigned axis, std::int32_t pulses) {
  check_map(identification());
  check_axis(axis, identification().axes);
  parts_->registers.write(reg::machine_zero(axis), static_cast<std::uint32_t>(pulses), "machine zero");
}

std::uint32_t Card::read_scales() {
  check_map(identification());
  return parts_->registers.read(reg::kScales);
}

void Card::set_scales(std::uint32_t hash) {
  check_map(identification());
  parts_->registers.write(reg::kScales, hash, "scales");
}

std::array<std::int32_t, card_map::kMaxAxes> CardPlace::pulses() const {
  std::array<std::int32_t, card_map::kMaxAxes> pulses{};
  for (std::size_t n = 0; was_set() && n < pulses.size(); ++n) pulses[n] = pulses_between(zero[n], now.position[n]);
  return pulses;
}

CardPlace read_card_place(Card& card) {
  CardPlace place;
  place.now = card.read_snapshot();
  place.bits = card.read_place();  // after the snapshot: an axis that is valid now was valid then
  place.scales = card.read_scales();
  place.keeps = card.read_keeps_place();
  for (unsigned n = 0; n < card.identification().axes; ++n) place.zero[n] = card.read_machine_zero(n);
  return place;
}

void keep_place(Card& card, const CardPlace& place, std::uint32_t scales, std::uint8_t trusted) {
  const unsigned axes = card.identification().axes;
  if (!place.was_set()) {
    for (unsigned n = 0; n < axes; ++n) card.set_machine_zero(n, place.now.position[n]);
    card.set_place(static_cast<std::uint8_t>(bit(axes) - 1), true, false);
  } else if (const auto lost = static_cast<std::uint8_t>(trusted & ~place.bits.valid); lost != 0) {
    card.set_place(lost, true, false);
  }
  if (place.scales <= kScalesInPulses && place.scales != scales) card.set_scales(scales);
}

PlaceBegin begin_at_place(Card& card, std::uint8_t axes, bool trust) {
  check_axes(axes, card.identification().axes, "place");
  const CardPlace found = read_card_place(card);
  if (found.now.status.busy) {
    throw StateError("place: the card moves, or holds in a motion: wait until it is idle, or take it over");
  }
  const unsigned lost = found.was_set() ? axes & ~unsigned{found.bits.valid} : 0;
  if (lost != 0 && !trust) throw_lost(lost);
  keep_place(card, found, kScalesInPulses, axes);
  return {read_card_place(card), !found.was_set()};
}

}  // namespace trammel::driver
