#include "trammel/model/command_checker.hpp"

#include <algorithm>
#include <stdexcept>

#include "trammel/card_map.hpp"

namespace trammel::model {

using card_map::Field;
using card_map::FieldKind;
using card_map::MaskRule;
using card_map::Reason;

namespace {

constexpr std::size_t kCountBegin = 2;
constexpr std::size_t kCountHalfwords = 3;
constexpr std::size_t kPayloadBegin = kCountBegin + kCountHalfwords;

// Steps of a word's way, in clocks after its write.
constexpr int kStoreLow = 2;
constexpr int kReadNumber = 3;
constexpr int kStoreHigh = 4;
constexpr int kAnswer = CommandChecker::kAnswerClocks - 1;
constexpr int kUnread = CommandChecker::kClosedAnswerClocks - 1;

std::uint8_t lowest_axes(unsigned axes) {
  if (axes < 1 || axes > card_map::kMaxAxes) throw std::invalid_argument("CommandChecker: axes must be 1 .. 8");
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

bool in_unsigned_range(uint128 value, const Field& field, std::uint32_t engines) {
  if (value < field.minimum) return false;
  if (field.limit != 0 && value > field.limit) return false;
  if (field.mask != 0 && (value & ~uint128{card_map::bits_with_meaning(field, engines)}) != 0) return false;
  return value >> field.bits == 0;
}

}  // namespace

CommandChecker::CommandChecker(unsigned axes, std::uint32_t engines)
    : card_mask_(lowest_axes(axes)), engines_(engines) {}

void CommandChecker::clock(const Inputs& in) {
  outputs_.geometry_write = false;
  outputs_.feed_write = false;
  outputs_.geometry_commit = false;
  outputs_.feed_commit = false;
  outputs_.drop = false;
  outputs_.refuse = false;
  if (in.reset || in.clear) {
    restart();
  } else if (outputs_.ready) {
    idle(in);
  } else {
    go_on(in);
  }
}

void CommandChecker::restart() {
  open_ = true;
  flush_waits_ = false;
  expected_ = 0;
  received_ = 0;
  outputs_ = Outputs{};
}

void CommandChecker::idle(const Inputs& in) {
  if ((in.flush || flush_waits_) && outputs_.partial) refuse(Reason::Truncated);
  flush_waits_ = false;
  if (!in.write) return;
  outputs_.ready = false;
  unread_ = in.closed ? Reason::Faulted : open_ ? Reason::None : Reason::StreamClosed;
  age_ = unread_ == Reason::None ? 0 : kAnswer - kUnread;
  if (unread_ != Reason::None) return;
  if (!outputs_.partial) received_ = 0;
  halfwords_[received_++] = static_cast<std::uint16_t>(in.word);
  halfwords_[received_++] = static_cast<std::uint16_t>(in.word >> 16);
}

void CommandChecker::go_on(const Inputs& in) {
  flush_waits_ = flush_waits_ || in.flush;
  ++age_;
  if (unread_ != Reason::None) {
    if (age_ == kAnswer) answer_unread();
    return;
  }
  const bool header = !outputs_.partial;
  if (age_ == kStoreLow && !header) store(received_ - 2);
  if (age_ == kReadNumber && header) {
    command_ = card_map::find_command(static_cast<std::uint8_t>(halfwords_[0]));
    if (command_ != nullptr && !card_map::is_known(*command_, engines_)) command_ = nullptr;
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

void CommandChecker::answer() {
  outputs_.ready = true;
  const bool header = !outputs_.partial;
  const Reason verdict = header ? header_verdict_ : judge_payload();
  if (verdict != Reason::None) {
    refuse(verdict);
    return;
  }
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

void CommandChecker::answer_unread() {
  outputs_.ready = true;
  outputs_.refuse = true;
  outputs_.reason = static_cast<std::uint8_t>(unread_);
}

void CommandChecker::refuse(Reason reason) {
  outputs_.refuse = true;
  outputs_.reason = static_cast<std::uint8_t>(reason);
  outputs_.drop = true;
  outputs_.partial = false;
  open_ = false;
}

void CommandChecker::store(std::size_t index) {
  if (index >= card_map::halfwords(*command_, mask())) return;
  outputs_.halfword = halfwords_[index];
  outputs_.geometry_write = command_->to_geometry;
  outputs_.feed_write = command_->to_feed;
}

bool CommandChecker::mask_fits() const {
  const bool present = (mask() & ~card_mask_) == 0;
  switch (command_->mask_rule) {
    case MaskRule::Any:
      return present && mask() != 0;
    case MaskRule::Plane:
      return present && card_map::axes_in(mask()) == 2;
    case MaskRule::PlaneAndAxes:
      return present && card_map::axes_in(mask()) >= 2;
    case MaskRule::Flags:
      return card_map::flags_good(*command_, mask(), engines_);
    case MaskRule::None:
      return mask() == 0;
  }
  return false;
}

std::size_t CommandChecker::copies(const Field& field) const {
  return field.per_axis ? card_map::axes_in(mask()) - command_->axes_in_base : 1;
}

Reason CommandChecker::judge_header(const Inputs& in) const {
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
Reason CommandChecker::judge_payload() const {
  Field count{};
  count.bits = 40;
  count.halfwords = kCountHalfwords;
  count.minimum = command_->count_minimum;
  // A count that must be 0 is judged halfword by halfword.
  for (std::size_t i = kCountBegin; command_->count_maximum == 0 && i < std::min(received_, kPayloadBegin); ++i) {
    if (halfwords_[i] != 0) return Reason::BadField;
  }
  if (const Reason reason = judge_field(count, kCountBegin); reason != Reason::None) return reason;
  for (std::size_t i = 0; i < command_->field_count; ++i) {
    const Field& field = command_->fields[i];
    for (std::size_t copy = 0; copy < copies(field); ++copy) {
      const std::size_t begin = kPayloadBegin + field.offset + copy * command_->axis_halfwords;
      if (const Reason reason = judge_field(field, begin); reason != Reason::None) return reason;
    }
  }
  const std::size_t end = card_map::halfwords(*command_, mask());
  return received_ > end && halfwords_[end] != 0 ? Reason::BadField : Reason::None;
}

// A field is judged when its last halfword is there.
Reason CommandChecker::judge_field(const Field& field, std::size_t begin) const {
  if (received_ < begin + field.halfwords) return Reason::None;
  const uint128 all = value(begin, field.halfwords);
  const bool in_range =
      field.kind == FieldKind::Signed ? in_signed_range(all, field) : in_unsigned_range(all, field, engines_);
  if (!in_range) return Reason::BadField;
  if (field.at_most_count && all > value(kCountBegin, kCountHalfwords)) return Reason::BadField;
  if (field.name == "plane") {
    const unsigned first = 1U << (static_cast<unsigned>(all >> 4) & 7);
    const unsigned second = 1U << (static_cast<unsigned>(all >> 8) & 7);
    if (first == second || (mask() & (first | second)) != (first | second)) return Reason::BadMask;
  }
  return Reason::None;
}

uint128 CommandChecker::value(std::size_t begin, std::size_t count) const {
  uint128 sum = 0;
  for (std::size_t i = count; i > 0; --i) sum = sum << 16 | halfwords_[begin + i - 1];
  return sum;
}

}  // namespace trammel::model
