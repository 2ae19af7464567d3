#include "key_jog.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "trammel/driver/errors.hpp"
#include "trammel/run/end_position.hpp"

namespace trammel::app {
namespace {

constexpr std::array<double, 5> kSteps{0, 0.01, 0.1, 1, 10};  // mm, by digit
constexpr double kLeastShare = 1.0 / 64;

}  // namespace

void KeyJog::keys(const std::vector<JogKey>& keys, DeadMan::Time now) {
  for (const JogKey& one : keys) key(one, now);
}

void KeyJog::key(const JogKey& key, DeadMan::Time now) {
  if (key.kind != JogKey::Kind::kMove && key.kind != JogKey::Kind::kOther) note_.clear();
  switch (key.kind) {
    case JogKey::Kind::kMove:
      return move(key, now);
    case JogKey::Kind::kStep:
      if (key.number < kSteps.size()) step_ = key.number;
      return;
    case JogKey::Kind::kFaster:
      share_ = std::min(1.0, share_ * 2);
      return;
    case JogKey::Kind::kSlower:
      share_ = std::max(kLeastShare, share_ / 2);
      return;
    case JogKey::Kind::kEnd:
      ended_ = true;
      return stop();
    case JogKey::Kind::kStop:
    case JogKey::Kind::kOther:  // a wrong key stops the motion, because no motion was intended
      return stop();
  }
}

void KeyJog::move(const JogKey& key, DeadMan::Time now) {
  if (moving_) {
    // Another key during a motion ends the motion: two directions at once are a mistake.
    if (!(*moving_ == key)) return stop();
    return dead_man_.repeat(now);
  }
  if (key.axis >= machine_.axes.size()) {
    note_ = "the machine has no such axis";
    return;
  }
  gcode::Coordinates by{};
  const double speed = speed_of(key.axis);
  try {
    if (step_ == 0) {
      by[key.axis] = key.sign * speed;
      jog_.start(by);
    } else {
      by[key.axis] = key.sign * kSteps[step_];
      jog_.start(by, speed);
    }
  } catch (const driver::ArgumentError& error) {
    note_ = error.what();
    return;
  }
  note_.clear();
  moving_ = key;
  while_held_ = step_ == 0;
  stopping_ = false;
  dead_man_.press(now);
}

double KeyJog::speed_of(std::size_t axis) const {
  const double most = machine_.axes[axis].max_velocity;
  return share_ * std::min(speed_.value_or(most / 4), most);
}

bool KeyJog::look(DeadMan::Time now) {
  if (!moving_) return false;
  if (while_held_ && dead_man_.released(now)) stop();
  if (jog_.moving()) return true;
  moving_.reset();
  return false;
}

void KeyJog::stop() {
  if (!moving_ || stopping_) return;
  jog_.stop();
  stopping_ = true;
}

std::string KeyJog::line() const {
  const std::string step =
      step_ == 0 ? std::string("while a key is held") : fmt::format("by {:g} a key", kSteps[step_]);
  return fmt::format("{}   {}, {:.0f} % of the speed", run::place_text(position_.millimetres(), machine_), step,
                     100 * share_);
}

}  // namespace trammel::app
