#include "trammel/model/command_fetch.hpp"

#include <array>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace trammel::model {

namespace {

using card_map::Opcode;

constexpr int kHeader = 4;  // halfwords before the payload, as they are stored
constexpr int kMaxPayload = 64;
constexpr int kEndless = 1 << 20;
constexpr std::size_t kFurtherAxes = 28;  // of an arc in chords: where their increments begin in the payload

// Where the halfwords of a payload go, and the first one that waits.
struct Layout {
  std::array<std::uint16_t, kMaxPayload> targets{};
  int pause_at = kEndless;
};

using Names = std::initializer_list<std::pair<std::string_view, unsigned>>;

Layout layout_of(Opcode opcode, const Names& names, std::string_view waits) {
  Layout layout;
  layout.targets.fill(load_target::kNowhere);
  const card_map::Command& command = *card_map::find_command(static_cast<std::uint8_t>(opcode));
  for (std::size_t i = 0; i < command.field_count; ++i) {
    const card_map::Field& field = command.fields[i];
    if (field.name == waits) layout.pause_at = kHeader + static_cast<int>(field.offset);
    for (const auto& [name, target] : names) {
      if (field.name != name) continue;
      for (std::size_t k = 0; k < field.halfwords; ++k)
        layout.targets[field.offset + k] = static_cast<std::uint16_t>(target);
    }
  }
  return layout;
}

// By opcode, of what a card can be built with; the others have no payload, or a line's.
std::array<Layout, 256> all_layouts() {
  namespace path = load_target;
  namespace feed = feed_target;
  std::array<Layout, 256> all;
  all[static_cast<std::uint8_t>(Opcode::Arc)] = layout_of(Opcode::Arc,
                                                          {{"prescale", path::kPrescale},
                                                           {"plane", path::kPlane},
                                                           {"quadrants", path::kQuadrants},
                                                           {"end_x", path::kEndX},
                                                           {"end_y", path::kEndY},
                                                           {"deviation", path::kDeviation},
                                                           {"gradient_x", path::kGradientX},
                                                           {"gradient_y", path::kGradientY},
                                                           {"half_x", path::kHalfX},
                                                           {"half_y", path::kHalfY}},
                                                          "plane");
  // Increments are numbered in the order of axes_.
  all[static_cast<std::uint8_t>(Opcode::ArcChord)] = layout_of(Opcode::ArcChord,
                                                               {{"prescale", path::kPrescale},
                                                                {"plane", path::kChordPlane},
                                                                {"shifts", path::kChordShifts},
                                                                {"x", path::kChordState},
                                                                {"y", path::kChordState},
                                                                {"first_x", path::increment(0)},
                                                                {"first_y", path::increment(1)},
                                                                {"closing_x", path::kChordClosing},
                                                                {"closing_y", path::kChordClosing}},
                                                               "plane");
  all[static_cast<std::uint8_t>(Opcode::Output)] =
      layout_of(Opcode::Output, {{"set", path::kCommand}, {"clear", path::kCommand}}, "");
  for (const Opcode conditional : {Opcode::Probe, Opcode::WaitInput})
    all[static_cast<std::uint8_t>(conditional)] = layout_of(conditional, {{"condition", path::kCommand}}, "");
  all[static_cast<std::uint8_t>(Opcode::Line)].pause_at = kHeader;
  all[static_cast<std::uint8_t>(Opcode::Feed)] = layout_of(Opcode::Feed,
                                                           {{"rate", feed::kRate},
                                                            {"floor", feed::kFloor},
                                                            {"stop_distance", feed::kStopDistance},
                                                            {"acceleration", feed::kAcceleration},
                                                            {"jerk", feed::kJerk}},
                                                           "acceleration");
  return all;
}

const std::array<Layout, 256> kLayouts = all_layouts();

}  // namespace

unsigned CommandFetch::target_of(int index) const {
  const unsigned ticks = queue_ == Queue::Geometry ? load_target::kTicks : feed_target::kTicks;
  if (index < kHeader) return ticks;
  const auto payload = static_cast<std::size_t>(index - kHeader);
  if (queue_ == Queue::Feed && !is_feed()) return feed_target::kNowhere;
  if (opcode_ == Opcode::Line) return load_target::increment(axes_[payload / 3]);
  if (is_chord() && payload >= kFurtherAxes) return load_target::increment(axes_[2 + (payload - kFurtherAxes) / 3]);
  const unsigned target = kLayouts[static_cast<std::uint8_t>(opcode_)].targets[payload];
  if (is_chord() && target == load_target::increment(0)) return load_target::increment(axes_[0]);
  if (is_chord() && target == load_target::increment(1)) return load_target::increment(axes_[1]);
  return target;
}

// The plane's axes first.
void CommandFetch::order_axes(std::uint16_t plane) {
  const unsigned x = plane >> 4 & 7;
  const unsigned y = plane >> 8 & 7;
  std::size_t count = 0;
  axes_[count++] = static_cast<std::uint8_t>(x);
  axes_[count++] = static_cast<std::uint8_t>(y);
  for (unsigned axis = 0; axis < 8; ++axis) {
    if ((mask_ >> axis & 1) != 0 && axis != x && axis != y) axes_[count++] = static_cast<std::uint8_t>(axis);
  }
}

// The first halfword says how long the command is and which axes a line moves.
void CommandFetch::arrive(int index, std::uint16_t halfword) {
  if (index > 0) {
    bus_ = {true, static_cast<std::uint16_t>(target_of(index)), halfword};
    if (is_chord() && bus_.target == load_target::kChordPlane) order_axes(halfword);
    return;
  }
  header_here_ = true;
  opcode_ = static_cast<Opcode>(halfword & 0xFF);
  mask_ = static_cast<std::uint8_t>(halfword >> 8);
  const card_map::Command* command = card_map::find_command(static_cast<std::uint8_t>(opcode_));
  length_ = command != nullptr ? static_cast<int>(card_map::queue_halfwords(*command, mask_)) : kHeader;
  pause_at_ = kLayouts[static_cast<std::uint8_t>(opcode_)].pause_at;
  engine_ = static_cast<std::uint8_t>(is_path() ? command->engine : card_map::engine::kLines);
  std::size_t count = 0;
  for (unsigned axis = 0; axis < 8; ++axis) {
    if ((mask_ >> axis & 1) != 0) axes_[count++] = static_cast<std::uint8_t>(axis);
  }
}

void CommandFetch::ask(const Inputs& in) {
  const int next = asked_ + 1;
  if (state_ == State::Idle) {
    if (in.empty) return;
    state_ = State::Reading;
    asked_ = 0;
  } else if (state_ == State::Waiting) {
    if (!may_go_on(in)) return;
    state_ = State::Reading;
    asked_ = pause_at_;
  } else if (asked_ < 0) {
    return;
  } else if (asked_ < kHeader - 1) {
    asked_ = next;  // the header is known when its last halfword is asked for
  } else if (next >= length_) {
    asked_ = -1;
    if (state_ == State::Finishing) state_ = State::Idle;
  } else if (next == pause_at_ && is_feed() && !in.payload_ready) {
    split_ = true;
    asked_ = -1;
  } else if (next == pause_at_ && !is_feed() && !may_go_on(in)) {
    state_ = State::Waiting;
    asked_ = -1;
  } else {
    asked_ = next;
  }
}

void CommandFetch::work(const Inputs& in) {
  const int arrived = arriving_[1];
  arriving_[1] = arriving_[0];
  arriving_[0] = asked_;
  bus_.valid = false;
  if (arrived >= 0) arrive(arrived, in.halfword);
  if (in.pop) {
    state_ = split_ ? State::Finishing : State::Idle;
    if (split_) asked_ = pause_at_;
    split_ = header_here_ = false;
  } else {
    ask(in);
  }
  const int last = split_ ? pause_at_ - 1 : length_ - 1;
  if (state_ == State::Reading && header_here_ && arrived >= kHeader - 1 && arrived == last) state_ = State::Decoded;
  if (in.clear) {
    state_ = State::Idle;
    split_ = header_here_ = false;
    asked_ = arriving_[0] = arriving_[1] = -1;
  }
}

}  // namespace trammel::model
