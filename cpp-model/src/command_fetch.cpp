#include "trammel/model/command_fetch.hpp"

#include <string_view>

namespace trammel::model {

namespace {

using card_map::Opcode;

constexpr int kMostPayload = 40;

// What a halfword of an arc or a feed piece loads.
struct Target {
  bool prescale = false;
  std::uint8_t feed = 0;
  std::uint16_t deviation = 0;
};
using Targets = std::array<Target, kMostPayload>;

Target target_of(std::string_view field) {
  if (field == "prescale") return {true, 0, 0};
  constexpr std::string_view kDeviation[] = {"deviation", "gradient_x", "gradient_y", "half_x", "half_y",
                                             "end_x",     "end_y",      "quadrants",  "plane"};
  constexpr std::string_view kFeed[] = {"rate", "acceleration", "jerk", "floor"};
  Target target;
  for (unsigned i = 0; i < std::size(kDeviation); ++i) {
    if (field == kDeviation[i]) target.deviation = static_cast<std::uint16_t>(1U << i);
  }
  for (unsigned i = 0; i < std::size(kFeed); ++i) {
    if (field == kFeed[i]) target.feed = static_cast<std::uint8_t>(1U << i);
  }
  return target;
}

Targets targets_of(Opcode opcode) {
  Targets targets;
  const card_map::Command& command = *card_map::find_command(static_cast<std::uint8_t>(opcode));
  for (std::size_t i = 0; i < command.field_count; ++i) {
    const card_map::Field& field = command.fields[i];
    for (std::size_t k = 0; k < field.halfwords; ++k) targets[field.offset + k] = target_of(field.name);
  }
  return targets;
}

const Targets kArc = targets_of(Opcode::Arc);
const Targets kFeedPiece = targets_of(Opcode::Feed);

}  // namespace

// The header's first halfword says how long the command is and which axes a line moves.
void CommandFetch::plan(std::uint16_t header) {
  opcode_ = static_cast<Opcode>(header & 0xFF);
  mask_ = static_cast<std::uint8_t>(header >> 8);
  path_ = opcode_ == Opcode::Line || opcode_ == Opcode::Arc;
  const card_map::Command* command = card_map::find_command(static_cast<std::uint8_t>(header & 0xFF));
  length_ = command != nullptr ? static_cast<int>(card_map::queue_halfwords(*command, mask_)) : kHeader;
  std::size_t count = 0;
  for (unsigned axis = 0; axis < 8; ++axis) {
    if ((mask_ >> axis & 1) != 0) axes_[count++] = static_cast<std::uint8_t>(axis);
  }
}

void CommandFetch::direct(int payload_index) {
  const auto index = static_cast<std::size_t>(payload_index);
  if (opcode_ == Opcode::Line) {
    load_.increment = static_cast<std::uint8_t>(1U << axes_[index / 3]);
    return;
  }
  const Target& target = (opcode_ == Opcode::Arc ? kArc : kFeedPiece)[index];
  load_.prescale = target.prescale;
  load_.feed = target.feed;
  load_.deviation = target.deviation;
}

void CommandFetch::clock(const Inputs& in) {
  const int arrived = arriving_[1];
  arriving_[1] = arriving_[0];
  arriving_[0] = asked_;
  load_ = LoadBus{};
  load_.word = in.word;
  if (arrived == 0) {
    plan(in.word);
  } else if (arrived > 0 && arrived < kHeader) {
    load_.count = true;
  } else if (arrived >= kHeader) {
    direct(arrived - kHeader);
  }

  const bool payload_ready = opcode_ != Opcode::Arc || !in.arc_busy;
  switch (phase_) {
    case Phase::Idle:
      if (in.empty) break;
      phase_ = Phase::Reading;
      asked_ = 0;
      break;
    case Phase::Reading:
      // The header is known when its last halfword is asked for.
      if (asked_ >= kHeader - 1 && asked_ + 1 >= length_) {
        phase_ = Phase::Tail;
        tail_ = 2;
        asked_ = -1;
      } else if (asked_ == kHeader - 1 && !payload_ready) {
        phase_ = Phase::Waiting;
        asked_ = -1;
      } else {
        ++asked_;
      }
      break;
    case Phase::Waiting:
      if (!payload_ready) break;
      phase_ = Phase::Reading;
      asked_ = kHeader;
      break;
    case Phase::Tail:
      if (--tail_ == 0) phase_ = Phase::Valid;
      break;
    case Phase::Valid:
      if (in.pop) phase_ = Phase::Idle;
      break;
  }
  if (in.clear) {
    phase_ = Phase::Idle;
    asked_ = -1;
    arriving_ = {-1, -1};
  }
}

}  // namespace trammel::model
