// Real-time commands: executed at once in every state.
#include <algorithm>

#include "trammel/grbl/controller.hpp"

namespace trammel::grbl {
namespace {

constexpr int kLeastOverride = 10;
constexpr int kMostOverride = 200;

}  // namespace

void Controller::realtime(std::uint8_t byte) {
  switch (byte) {
    case '?':
      return report();
    case '!':
      return request_hold(State::kHold);
    case '~':
      return resume();
    case 0x18:
      return request_reset();
    case 0x84:
      return request_hold(State::kDoor);
    case 0x85:
      if (state_ == State::kJog) cancel_jog();
      return;
    default:
      return override_by(byte);
  }
}

void Controller::override_by(std::uint8_t byte) {
  const auto step = [byte](int value, std::uint8_t first) {
    constexpr int kSteps[]{0, 10, -10, 1, -1};
    const int index = byte - first;
    return index == 0 ? 100 : std::clamp(value + kSteps[index], kLeastOverride, kMostOverride);
  };
  if (byte >= 0x90 && byte <= 0x94) {
    feed_override_ = machine_.override_feed(step(static_cast<int>(feed_override_), 0x90));
  } else if (byte >= 0x95 && byte <= 0x97) {
    rapid_override_ = byte == 0x95 ? 100 : byte == 0x96 ? 50 : 25;
    machine_.override_rapids(rapid_override_);
  } else if (byte >= 0x99 && byte <= 0x9D) {
    spindle_override_ = step(spindle_override_, 0x99);
  } else {
    return;
  }
  status_.overrides_changed();
}

void Controller::request_reset() {
  input_.clear();
  reset_ = true;
  if (executing_) machine_.stop();
}

void Controller::cancel_jog() {
  cancelling_jog_ = true;
  queue_.clear();
  if (executing_) machine_.stop();
}

void Controller::request_hold(State state) {
  if (state_ == State::kAlarm || state_ == State::kCheck || state_ == State::kSleep || state_ == State::kHome) return;
  if (state == State::kDoor) say("[MSG:Check Door]");
  if (state_ == State::kJog) return cancel_jog();
  if (!held()) before_hold_ = state_;
  if (!held() || state == State::kDoor) state_ = state;
  if (executing_) machine_.hold(true);
}

void Controller::resume() {
  if (state_ != State::kHold && state_ != State::kDoor) {
    if (executing_) machine_.hold(false);  // a hold by the machine's feed hold button
    return;
  }
  state_ = before_hold_;
  machine_.hold(false);
  if (answer_at_resume_) answer(Status::kOk);
  answer_at_resume_ = false;
}

}  // namespace trammel::grbl
