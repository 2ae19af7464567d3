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

// Steps of the processing of a word, in clocks after its write.
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
  state_.outputs.geometry_write = false;
  state_.outputs.feed_write = false;
  state_.outputs.geometry_commit = false;
  state_.outputs.feed_commit = false;
  state_.outputs.drop = false;
  state_.outputs.refuse = false;
  if (in.reset || in.clear) {
    restart();
  } else if (state_.outputs.ready) {
    idle(in);
  } else {
    go_on(in);
  }
}

void CommandChecker::restart() {
  state_.open = true;
  state_.flush_waits = false;
  state_.expected = 0;
  state_.received = 0;
  state_.outputs = Outputs{};
}

void CommandChecker::idle(const Inputs& in) {
  if ((in.flush || state_.flush_waits) && state_.outputs.partial) refuse(Reason::Truncated);
  state_.flush_waits = false;
  if (!in.write) return;
  state_.outputs.ready = false;
  state_.unread = in.closed ? Reason::Faulted : state_.open ? Reason::None : Reason::StreamClosed;
  state_.age = state_.unread == Reason::None ? 0 : kAnswer - kUnread;
  if (state_.unread != Reason::None) return;
  if (!state_.outputs.partial) state_.received = 0;
  state_.halfwords[state_.received++] = static_cast<std::uint16_t>(in.word);
  state_.halfwords[state_.received++] = static_cast<std::uint16_t>(in.word >> 16);
}

void CommandChecker::go_on(const Inputs& in) {
  state_.flush_waits = state_.flush_waits || in.flush;
  ++state_.age;
  if (state_.unread != Reason::None) {
    if (state_.age == kAnswer) answer_unread();
    return;
  }
  const bool header = !state_.outputs.partial;
  if (state_.age == kStoreLow && !header) store(state_.received - 2);
  if (state_.age == kReadNumber && header) {
    state_.command = card_map::find_command(static_cast<std::uint8_t>(state_.halfwords[0]));
    if (state_.command != nullptr && !card_map::is_known(*state_.command, engines_)) state_.command = nullptr;
    state_.outputs.number = static_cast<std::uint8_t>(state_.halfwords[1] >> 8);
  }
  if (state_.age == kStoreHigh) {
    if (header) {
      state_.header_verdict = judge_header(in);
    } else {
      store(state_.received - 1);
    }
  }
  if (state_.age == kAnswer) answer();
}

void CommandChecker::answer() {
  state_.outputs.ready = true;
  const bool header = !state_.outputs.partial;
  const Reason verdict = header ? state_.header_verdict : judge_payload();
  if (verdict != Reason::None) {
    refuse(verdict);
    return;
  }
  state_.outputs.partial = true;
  if (header) {
    store(0);
  } else if (state_.received >= card_map::halfwords(*state_.command, mask())) {
    state_.outputs.geometry_commit = state_.command->to_geometry;
    state_.outputs.feed_commit = state_.command->to_feed;
    state_.outputs.partial = false;
    ++state_.expected;
  }
}

void CommandChecker::answer_unread() {
  state_.outputs.ready = true;
  state_.outputs.refuse = true;
  state_.outputs.reason = static_cast<std::uint8_t>(state_.unread);
}

void CommandChecker::refuse(Reason reason) {
  state_.outputs.refuse = true;
  state_.outputs.reason = static_cast<std::uint8_t>(reason);
  state_.outputs.drop = true;
  state_.outputs.partial = false;
  state_.open = false;
}

void CommandChecker::store(std::size_t index) {
  if (index >= card_map::halfwords(*state_.command, mask())) return;
  state_.outputs.halfword = state_.halfwords[index];
  state_.outputs.geometry_write = state_.command->to_geometry;
  state_.outputs.feed_write = state_.command->to_feed;
}

bool CommandChecker::mask_fits() const {
  const bool present = (mask() & ~card_mask_) == 0;
  switch (state_.command->mask_rule) {
    case MaskRule::Any:
      return present && mask() != 0;
    case MaskRule::Plane:
      return present && card_map::axes_in(mask()) == 2;
    case MaskRule::PlaneAndAxes:
      return present && card_map::axes_in(mask()) >= 2;
    case MaskRule::Flags:
      return card_map::flags_good(*state_.command, mask(), engines_);
    case MaskRule::None:
      return mask() == 0;
  }
  return false;
}

std::size_t CommandChecker::copies(const Field& field) const {
  return field.per_axis ? card_map::axes_in(mask()) - state_.command->axes_in_base : 1;
}

Reason CommandChecker::judge_header(const Inputs& in) const {
  if (state_.command == nullptr) return Reason::UnknownOpcode;
  if (!mask_fits()) return Reason::BadMask;
  if ((state_.halfwords[1] & 0xFF) != card_map::words(*state_.command, mask())) return Reason::BadLength;
  if (state_.outputs.number != state_.expected) return Reason::BadNumber;
  const std::uint32_t needed = card_map::queue_halfwords(*state_.command, mask());
  if (state_.command->to_geometry && in.geometry_room < needed) return Reason::NoRoom;
  if (state_.command->to_feed && in.feed_room < needed) return Reason::NoRoom;
  return Reason::None;
}

// The first violation among the fields that have begun to arrive, in their order.
Reason CommandChecker::judge_payload() const {
  Field count{};
  count.bits = 40;
  count.halfwords = kCountHalfwords;
  count.minimum = state_.command->count_minimum;
  // The first violation among the fields that have arrived so far, in their order.
  for (std::size_t i = kCountBegin; state_.command->count_maximum == 0 && i < std::min(state_.received, kPayloadBegin);
       ++i) {
    if (state_.halfwords[i] != 0) return Reason::BadField;
  }
  if (const Reason reason = judge_field(count, kCountBegin); reason != Reason::None) return reason;
  for (std::size_t i = 0; i < state_.command->field_count; ++i) {
    const Field& field = state_.command->fields[i];
    for (std::size_t copy = 0; copy < copies(field); ++copy) {
      const std::size_t begin = kPayloadBegin + field.offset + copy * state_.command->axis_halfwords;
      if (const Reason reason = judge_field(field, begin); reason != Reason::None) return reason;
    }
  }
  const std::size_t end = card_map::halfwords(*state_.command, mask());
  return state_.received > end && state_.halfwords[end] != 0 ? Reason::BadField : Reason::None;
}

// A field is checked when its last halfword has arrived.
Reason CommandChecker::judge_field(const Field& field, std::size_t begin) const {
  if (state_.received < begin + field.halfwords) return Reason::None;
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
  for (std::size_t i = count; i > 0; --i) sum = sum << 16 | state_.halfwords[begin + i - 1];
  return sum;
}

}  // namespace trammel::model
