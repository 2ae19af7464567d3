#include "trammel/model/command_fetch.hpp"

#include <array>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace trammel::model {

namespace {

using card_map::Opcode;

constexpr int kHeader = 4;  // stored halfwords before the payload
constexpr int kMaxPayload = 64;
constexpr int kEndless = 1 << 20;
constexpr std::size_t kFurtherAxes = 28;  // arc in chords: offset of the increments of the other axes in the payload

// The targets of a payload's halfwords, and the first halfword that waits.
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

// Layouts by opcode, of all commands that a card can be built with. The other commands have no payload, or that of a
// line.
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
  // The index of an increment here is an index of state_.axes.
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
  all[static_cast<std::uint8_t>(Opcode::Pwm)] =
      layout_of(Opcode::Pwm, {{"select", path::kCommand}, {"duty", path::kCommand}, {"gain", path::kCommand}}, "");
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
  if (state_.opcode == Opcode::Line) return load_target::increment(state_.axes[payload / 3]);
  if (is_chord() && payload >= kFurtherAxes)
    return load_target::increment(state_.axes[2 + (payload - kFurtherAxes) / 3]);
  const unsigned target = kLayouts[static_cast<std::uint8_t>(state_.opcode)].targets[payload];
  if (is_chord() && target == load_target::increment(0)) return load_target::increment(state_.axes[0]);
  if (is_chord() && target == load_target::increment(1)) return load_target::increment(state_.axes[1]);
  return target;
}

// Puts the plane's axes first.
void CommandFetch::order_axes(std::uint16_t plane) {
  const unsigned x = plane >> 4 & 7;
  const unsigned y = plane >> 8 & 7;
  std::size_t count = 0;
  state_.axes[count++] = static_cast<std::uint8_t>(x);
  state_.axes[count++] = static_cast<std::uint8_t>(y);
  for (unsigned axis = 0; axis < 8; ++axis) {
    if ((state_.mask >> axis & 1) != 0 && axis != x && axis != y)
      state_.axes[count++] = static_cast<std::uint8_t>(axis);
  }
}

// The first halfword determines the length of the command and the axes of a line.
void CommandFetch::arrive(int index, std::uint16_t halfword) {
  if (index > 0) {
    state_.bus = {true, static_cast<std::uint16_t>(target_of(index)), halfword};
    if (is_chord() && state_.bus.target == load_target::kChordPlane) order_axes(halfword);
    return;
  }
  state_.header_here = true;
  state_.opcode = static_cast<Opcode>(halfword & 0xFF);
  state_.mask = static_cast<std::uint8_t>(halfword >> 8);
  const card_map::Command* command = card_map::find_command(static_cast<std::uint8_t>(state_.opcode));
  state_.length = command != nullptr ? static_cast<int>(card_map::queue_halfwords(*command, state_.mask)) : kHeader;
  state_.pause_at = kLayouts[static_cast<std::uint8_t>(state_.opcode)].pause_at;
  state_.engine = static_cast<std::uint8_t>(is_path() ? command->engine : card_map::engine::kLines);
  std::size_t count = 0;
  for (unsigned axis = 0; axis < 8; ++axis) {
    if ((state_.mask >> axis & 1) != 0) state_.axes[count++] = static_cast<std::uint8_t>(axis);
  }
}

void CommandFetch::ask(const Inputs& in) {
  const int next = state_.asked + 1;
  if (state_.mode == Mode::Idle) {
    if (in.empty) return;
    state_.mode = Mode::Reading;
    state_.asked = 0;
  } else if (state_.mode == Mode::Waiting) {
    if (!may_go_on(in)) return;
    state_.mode = Mode::Reading;
    state_.asked = state_.pause_at;
  } else if (state_.asked < 0) {
    return;
  } else if (state_.asked < kHeader - 1) {
    state_.asked = next;  // the header is known when its last halfword is requested
  } else if (next >= state_.length) {
    state_.asked = -1;
    if (state_.mode == Mode::Finishing) state_.mode = Mode::Idle;
  } else if (next == state_.pause_at && is_feed() && !in.payload_ready) {
    state_.split = true;
    state_.asked = -1;
  } else if (next == state_.pause_at && !is_feed() && !may_go_on(in)) {
    state_.mode = Mode::Waiting;
    state_.asked = -1;
  } else {
    state_.asked = next;
  }
}

void CommandFetch::clock(const Inputs& in) {
  const int arrived = state_.arriving[1];
  state_.arriving[1] = state_.arriving[0];
  state_.arriving[0] = state_.asked;
  state_.bus.valid = false;
  if (arrived >= 0) arrive(arrived, in.halfword);
  if (in.pop) {
    state_.mode = state_.split ? Mode::Finishing : Mode::Idle;
    if (state_.split) state_.asked = state_.pause_at;
    state_.split = state_.header_here = false;
  } else {
    ask(in);
  }
  const int last = state_.split ? state_.pause_at - 1 : state_.length - 1;
  if (state_.mode == Mode::Reading && state_.header_here && arrived >= kHeader - 1 && arrived == last)
    state_.mode = Mode::Decoded;
  if (in.clear) {
    state_.mode = Mode::Idle;
    state_.split = state_.header_here = false;
    state_.asked = state_.arriving[0] = state_.arriving[1] = -1;
  }
}

}  // namespace trammel::model
