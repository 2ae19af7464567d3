#include "trammel/run/jog.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "second_motors.hpp"
#include "trammel/card_map.hpp"

namespace trammel::run {

namespace reg = card_map::reg;

Jog::Jog(driver::Card& card, const machine::Machine& machine, MachinePosition& position)
    : card_(card), machine_(machine), position_(position) {}

void Jog::start(const gcode::Coordinates& velocity) {
  double speed = 0;
  for (std::size_t a = 0; a < machine_.axes.size(); ++a) speed += velocity[a] * velocity[a];
  position_.look(card_.snapshot());
  begin(jog_path(machine_, card_.timing(), position_.pulses(), velocity), std::sqrt(speed));
}

void Jog::start(const gcode::Coordinates& distance, double speed) {
  position_.look(card_.snapshot());
  begin(jog_path(machine_, card_.timing(), position_.pulses(), distance, speed), speed);
}

void Jog::begin(const JogPath& path, double speed) {
  if (path_) throw driver::StateError("jog: one is under way; stop it first");
  driver::Stream stream(card_);
  before_ = {card_.read(reg::kRatioFeed), card_.read(reg::kSlew)};
  path_ = path;
  stopping_ = false;
  // Where the time base makes the ramp, the path waits for it at ratio 0.
  set_ratio_at_once(path.ramped_by_time_base ? 0 : driver::Card::kFullRatio);
  for (const driver::FeedCommand& piece : path.pieces) stream.put(piece);
  stream.put(SecondMotors(machine_).with(path.line));
  const auto ramp = std::chrono::nanoseconds(static_cast<std::int64_t>(path.ramp_seconds * 1e9));
  card_.set_slew_time(std::min(ramp, driver::time_of(driver::Card::kSlowestSlew, card_.timing().clock_hz)));
  stream.flush();
  if (path.ramped_by_time_base) set_speed(speed);
}

// While nothing moves: the ratio is there after some clocks, fewer than an access takes.
void Jog::set_ratio_at_once(std::uint32_t ratio) {
  card_.set_slew_time(std::chrono::nanoseconds(0));
  card_.set_ratio(ratio);
  card_.status();
}

double Jog::set_speed(double speed) {
  if (!path_ || stopping_ || !(speed >= 0)) return 0;
  const double share = std::min(speed / path_->speed, 1.0);
  const auto ratio = static_cast<std::uint32_t>(std::lround(share * driver::Card::kFullRatio));
  card_.set_ratio(ratio);
  return path_->speed * ratio / driver::Card::kFullRatio;
}

void Jog::stop() {
  if (!path_ || stopping_) return;
  card_.set_hold(true);
  stopping_ = true;
}

bool Jog::moving() {
  if (!path_) return false;
  const driver::Status status = card_.status();
  if (status.faulted) path_.reset();
  card_.throw_if_faulted(status, "jog");
  if (status.busy && !(stopping_ && status.held)) return true;
  finish();
  return false;
}

void Jog::wait() {
  while (moving()) card_.bus().sleep(driver::time_of(card_.poll_interval(), card_.timing().clock_hz));
}

void Jog::finish() {
  path_.reset();
  position_.look(card_.stop());
  set_ratio_at_once(before_.ratio);
  std::array<driver::Access, 2> slew{driver::write_of(reg::kSlew, before_.slew)};
  card_.transfer(slew.data(), 1, "jog: slew");
}

}  // namespace trammel::run
