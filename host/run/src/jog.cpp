#include "trammel/run/jog.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/low_level/requests.hpp"

namespace trammel::run {

namespace reg = card_map::reg;

namespace {

constexpr double kLinesAhead = 24;        // approximate number of lines ahead at full speed
constexpr std::uint64_t kMinTicks = 512;  // per line: more than the decoding time and the card's reserve
constexpr double kFractionOfQueue = 0.5;
constexpr int kLinesAtOnce = 2;

// Feed ticks to send ahead: more than two stop distances at this ratio, so that an under-run hold would end when they
// are queued, plus kAheadSeconds and the reserve.
double ticks_ahead(const JogPath& path, const driver::CardTiming& card, double ratio) {
  constexpr double kStops = 2.2;
  constexpr double kReserve = 4 * card_map::constant::kUnderrunReserveTicks;
  double rate = 0;  // ticks per clock
  for (const driver::FeedCommand& piece : path.pieces) rate = std::max(rate, static_cast<double>(piece.rate) * 0x1p-64);
  return kStops * path.stop_distance * ratio * ratio + Jog::kAheadSeconds * card.clock_hz * rate * ratio + kReserve;
}

// Feed ticks of a line, chosen so that the lines sent ahead fit well into the queue.
std::uint64_t line_ticks(const JogPath& path, const driver::CardTiming& card, const driver::Identification& who) {
  if (!card_map::has_engine(who.engines, card_map::engine::kUnderrunHold)) return path.ticks;
  const auto all = static_cast<std::uint8_t>((1U << who.axes) - 1);
  const auto line = card_map::find_command(static_cast<std::uint8_t>(card_map::Opcode::Line));
  const double fit = kFractionOfQueue * who.geometry_depth / card_map::queue_halfwords(*line, all);
  const double lines = std::max(1.0, std::min(kLinesAhead, fit));
  return std::max(static_cast<std::uint64_t>(ticks_ahead(path, card, 1) / lines), kMinTicks);
}

}  // namespace

Jog::Jog(driver::Card& card, const machine::Machine& machine, MachinePosition& position)
    : card_(card), machine_(machine), position_(position) {}

void Jog::start(const gcode::Coordinates& velocity) {
  double speed = 0;
  for (std::size_t a = 0; a < machine_.axes.size(); ++a) speed += velocity[a] * velocity[a];
  position_.look(card_.read_snapshot());
  begin(jog_path(machine_, card_.timing(), position_.pulses(), velocity), std::sqrt(speed));
}

void Jog::start(const gcode::Coordinates& distance, double speed) {
  position_.look(card_.read_snapshot());
  begin(jog_path(machine_, card_.timing(), position_.pulses(), distance, speed), speed);
}

void Jog::begin(const JogPath& path, double speed) {
  if (path_) throw driver::StateError("jog: one is under way; stop it first");
  stream_.emplace(card_);
  before_ = {card_.parts().registers.read(reg::kRatioFeed), card_.parts().registers.read(reg::kSlew)};
  path_ = path;
  stopping_ = false;
  sent_ticks_ = 0;
  line_ticks_ = line_ticks(path, card_.timing(), card_.identification());
  // If the time base makes the ramp, the path is loaded at ratio 0.
  set_ratio_at_once(path.ramped_by_time_base ? 0 : driver::Card::kFullRatio);
  ratio_ = path.ramped_by_time_base ? 0 : 1;
  for (const driver::FeedCommand& piece : path.pieces) stream_->put(piece);
  send_line();
  const auto ramp = std::chrono::nanoseconds(static_cast<std::int64_t>(path.ramp_seconds * 1e9));
  card_.set_slew_time(std::min(ramp, driver::time_of(driver::Card::kSlowestSlew, card_.timing().clock_hz)));
  stream_->flush();
  if (path.ramped_by_time_base) {
    set_speed(speed);
  } else {
    // The card starts at full ratio as soon as a complete stop is queued, and would go into an under-run hold if
    // nothing more followed. So enough lines are sent at once.
    feed(std::numeric_limits<int>::max());
  }
}

void Jog::send_line() {
  const std::uint64_t left = path_->ticks - sent_ticks_;
  // The last line takes up the remainder, so no line is shorter than the others.
  const std::uint64_t ticks = left < 2 * line_ticks_ ? left : line_ticks_;
  stream_->put(line_of(*path_, sent_ticks_, sent_ticks_ + ticks));
  sent_ticks_ += ticks;
}

// Sends lines until enough are queued, but at most `most` per call, so that a stop is not delayed. The line in
// execution counts as done.
void Jog::feed(int most) {
  if (stopping_ || sent_ticks_ == path_->ticks) return;
  const std::uint64_t begun = std::uint64_t{card_.parts().registers.read(reg::kGeometryBegun)} * line_ticks_;
  const double wanted = ticks_ahead(*path_, card_.timing(), ratio_);
  for (int i = 0; i < most && sent_ticks_ != path_->ticks; ++i) {
    if (sent_ticks_ > begun && static_cast<double>(sent_ticks_ - begun) >= wanted) break;
    send_line();
  }
  stream_->flush();
}

// Only at rest: the ratio takes effect after some clocks, fewer than an access takes.
void Jog::set_ratio_at_once(std::uint32_t ratio) {
  card_.set_slew_time(std::chrono::nanoseconds(0));
  card_.set_ratio(ratio);
  card_.read_status();
}

double Jog::set_speed(double speed) {
  if (!path_ || stopping_ || !(speed >= 0)) return 0;
  const double share = std::min(speed / path_->speed, 1.0);
  const auto ratio = static_cast<std::uint32_t>(std::lround(share * driver::Card::kFullRatio));
  card_.set_ratio(ratio);
  ratio_ = share;
  return path_->speed * ratio / driver::Card::kFullRatio;
}

void Jog::stop() {
  if (!path_ || stopping_) return;
  card_.set_hold(true);
  stopping_ = true;
}

bool Jog::moving() {
  if (!path_) return false;
  try {
    driver::serve_requests(card_);
  } catch (const driver::StoppedError&) {
    finish();
    throw;
  }
  const driver::Status status = card_.read_status();
  if (status.faulted) path_.reset();
  card_.parts().registers.throw_if_faulted(status, "jog");
  if (status.busy && !(stopping_ && status.held)) {
    feed(kLinesAtOnce);
    return true;
  }
  finish();
  return false;
}

void Jog::wait() {
  while (moving())
    card_.bus().sleep(driver::time_of(driver::poll_interval(card_.timing().clock_hz), card_.timing().clock_hz));
}

void Jog::finish() {
  path_.reset();
  stream_.reset();
  position_.look(card_.stop());
  set_ratio_at_once(before_.ratio);
  std::array<driver::Access, 2> slew{driver::write_of(reg::kSlew, before_.slew)};
  card_.parts().registers.transfer(slew.data(), 1, "jog: slew");
}

}  // namespace trammel::run
