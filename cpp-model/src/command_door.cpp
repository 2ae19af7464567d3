#include "trammel/model/command_door.hpp"

#include <stdexcept>

namespace trammel::model {

using card_map::Field;
using card_map::FieldKind;
using card_map::MaskRule;
using card_map::Reason;

namespace {

using uint128 = CommandDoor::uint128;

constexpr std::size_t kCountBegin = 2;
constexpr std::size_t kCountHalfwords = 3;
constexpr std::size_t kPayloadBegin = kCountBegin + kCountHalfwords;

// Steps of a word's way, in clocks after its write.
constexpr int kStoreLow = 2;
constexpr int kReadNumber = 3;
constexpr int kStoreHigh = 4;
constexpr int kAnswer = CommandDoor::kAnswerClocks - 1;

std::uint8_t lowest_axes(unsigned axes) {
  if (axes < 1 || axes > card_map::kMaxAxes) throw std::invalid_argument("CommandDoor: axes must be 1 .. 8");
  return static_cast<std::uint8_t>((1U << axes) - 1U);
}

bool in_signed_range(uint128 value, const Field& field) {
  const std::uint32_t wire_bits = 16 * field.halfwords;
  const bool negative = (value >> (wire_bits - 1) & 1) != 0;
  const uint128 wire_modulus = wire_bits == 128 ? 0 : uint128{1} << wire_bits;
  const uint128 magnitude = negative ? wire_modulus - value : value;
  if (field.limit != 0) return magnitude <= field.limit;
  const uint128 half_range = uint128{1} << (field.bits - 1);
  return negative ? magnitude <= half_range : magnitude < half_range;
}

bool in_unsigned_range(uint128 value, const Field& field) {
  if (value < field.minimum) return false;
  if (field.limit != 0 && value > field.limit) return false;
  if (field.mask != 0 && (value & ~uint128{field.mask}) != 0) return false;
  return value >> field.bits == 0;
}

}  // namespace

CommandDoor::CommandDoor(unsigned axes) : card_mask_(lowest_axes(axes)) {}

void CommandDoor::clock(const Inputs& in) {
  const bool interrupted = !outputs_.ready || in.write;
  outputs_.done = false;
  outputs_.error = false;
  outputs_.geometry_write = false;
  outputs_.feed_write = false;
  outputs_.geometry_commit = false;
  outputs_.feed_commit = false;
  outputs_.drop = false;
  outputs_.refuse = false;
  if (in.reset || in.clear) {
    restart();
    outputs_.error = interrupted && !in.reset;
  } else if (outputs_.ready) {
    idle(in);
  } else {
    work(in);
  }
}

void CommandDoor::restart() {
  open_ = true;
  flush_waits_ = false;
  expected_ = 0;
  received_ = 0;
  outputs_ = Outputs{};
}

void CommandDoor::idle(const Inputs& in) {
  if ((in.flush || flush_waits_) && outputs_.partial) refuse(Reason::Truncated);
  flush_waits_ = false;
  if (!in.write) return;
  outputs_.ready = false;
  age_ = open_ ? 0 : kAnswer - 1;
  if (!open_) return;
  if (!outputs_.partial) received_ = 0;
  halfwords_[received_++] = static_cast<std::uint16_t>(in.word);
  halfwords_[received_++] = static_cast<std::uint16_t>(in.word >> 16);
}

void CommandDoor::work(const Inputs& in) {
  flush_waits_ = flush_waits_ || in.flush;
  ++age_;
  const bool header = !outputs_.partial;
  if (age_ == kStoreLow && !header) store(received_ - 2);
  if (age_ == kReadNumber && header) {
    command_ = card_map::find_command(static_cast<std::uint8_t>(halfwords_[0]));
    outputs_.number = static_cast<std::uint8_t>(halfwords_[1] >> 8);
  }
  if (age_ == kStoreHigh) {
    if (header) {
      header_verdict_ = judge_header(in);
    } else {
      store(received_ - 1);
    }
  }
  if (age_ == kAnswer) answer();
}

void CommandDoor::answer() {
  outputs_.ready = true;
  const bool header = !outputs_.partial;
  const Reason verdict = !open_ ? Reason::DoorClosed : header ? header_verdict_ : judge_payload();
  if (verdict != Reason::None) {
    outputs_.error = true;
    refuse(verdict);
    return;
  }
  outputs_.done = true;
  outputs_.partial = true;
  if (header) {
    store(0);
  } else if (received_ >= card_map::halfwords(*command_, mask())) {
    outputs_.geometry_commit = command_->to_geometry;
    outputs_.feed_commit = command_->to_feed;
    outputs_.partial = false;
    ++expected_;
  }
}

void CommandDoor::refuse(Reason reason) {
  outputs_.refuse = true;
  outputs_.reason = static_cast<std::uint8_t>(reason);
  outputs_.drop = open_;
  outputs_.partial = false;
  open_ = false;
}

void CommandDoor::store(std::size_t index) {
  if (index >= card_map::halfwords(*command_, mask())) return;
  outputs_.halfword = halfwords_[index];
  if (index == kPayloadBegin - 1) {
    outputs_.halfword = static_cast<std::uint16_t>((halfwords_[index] & 0xFF) | outputs_.number << 8);
  }
  outputs_.geometry_write = command_->to_geometry;
  outputs_.feed_write = command_->to_feed;
}

bool CommandDoor::mask_fits() const {
  if ((mask() & ~card_mask_) != 0) return false;
  switch (command_->mask_rule) {
    case MaskRule::Any:
      return mask() != 0;
    case MaskRule::Plane:
      return card_map::axes_in(mask()) == 2;
    case MaskRule::None:
      return mask() == 0;
  }
  return false;
}

Reason CommandDoor::judge_header(const Inputs& in) const {
  if (command_ == nullptr) return Reason::UnknownOpcode;
  if (!mask_fits()) return Reason::BadMask;
  if ((halfwords_[1] & 0xFF) != card_map::words(*command_, mask())) return Reason::BadLength;
  if (outputs_.number != expected_) return Reason::BadNumber;
  const std::uint32_t needed = card_map::queue_halfwords(*command_, mask());
  if (command_->to_geometry && in.geometry_room < needed) return Reason::NoRoom;
  if (command_->to_feed && in.feed_room < needed) return Reason::NoRoom;
  return Reason::None;
}

// The first violation among the fields that have begun, in their order.
Reason CommandDoor::judge_payload() const {
  const bool no_count = command_->count_maximum == 0;
  const Field count{"count",
                    no_count ? FieldKind::Zero : FieldKind::Unsigned,
                    40,
                    0,
                    kCountHalfwords,
                    false,
                    command_->count_minimum,
                    command_->count_maximum,
                    0,
                    false};
  if (const Reason reason = judge_field(count, kCountBegin); reason != Reason::None) return reason;
  for (std::size_t i = 0; i < command_->field_count; ++i) {
    const Field& field = command_->fields[i];
    const std::size_t copies = field.per_axis ? card_map::axes_in(mask()) : 1;
    for (std::size_t copy = 0; copy < copies; ++copy) {
      const std::size_t begin = kPayloadBegin + field.offset + copy * command_->axis_halfwords;
      if (const Reason reason = judge_field(field, begin); reason != Reason::None) return reason;
    }
  }
  const std::size_t end = card_map::halfwords(*command_, mask());
  return received_ > end && halfwords_[end] != 0 ? Reason::BadField : Reason::None;
}

// A field is judged when its last halfword is there; one that must be 0, in each of its halfwords.
Reason CommandDoor::judge_field(const Field& field, std::size_t begin) const {
  if (received_ <= begin) return Reason::None;
  const bool whole = received_ >= begin + field.halfwords;
  if (field.kind == FieldKind::Zero) {
    const std::size_t there = whole ? field.halfwords : received_ - begin;
    return value(begin, there) == 0 ? Reason::None : Reason::BadField;
  }
  if (!whole) return Reason::None;
  const uint128 all = value(begin, field.halfwords);
  const bool in_range = field.kind == FieldKind::Signed ? in_signed_range(all, field) : in_unsigned_range(all, field);
  if (!in_range) return Reason::BadField;
  if (field.at_most_count && all > value(kCountBegin, kCountHalfwords)) return Reason::BadField;
  if (field.name == "plane") {
    const unsigned first = 1U << (static_cast<unsigned>(all >> 4) & 7);
    const unsigned second = 1U << (static_cast<unsigned>(all >> 8) & 7);
    if (first == second || mask() != (first | second)) return Reason::BadMask;
  }
  return Reason::None;
}

uint128 CommandDoor::value(std::size_t begin, std::size_t count) const {
  uint128 sum = 0;
  for (std::size_t i = count; i > 0; --i) sum = sum << 16 | halfwords_[begin + i - 1];
  return sum;
}

}  // namespace trammel::model
