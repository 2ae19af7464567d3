#include "trammel/linuxcnc/servo_stream.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::linuxcnc {
namespace {

using driver::PositionStream;

constexpr double kMostCorrection = 0.002;  // fraction of a period, and so the largest relative change of a speed
constexpr double kMeanPeriods = 64;        // periods over which the number of queued periods is averaged
constexpr double kFullError = 0.5;         // error in periods at which the full correction is applied
constexpr std::chrono::nanoseconds kLook = std::chrono::milliseconds(1);
constexpr std::uint64_t kSpare = 2;  // a period at rest is omitted when the queue exceeds the lead by more than this

// Rounds as the driver does.
std::int64_t nearest_pulse(std::int64_t target) {
  return (target + PositionStream::kPulse / 2) >> PositionStream::kFractionBits;
}

}  // namespace

void ServoStream::open(const ServoSettings& settings, const Pulses& from) {
  settings_ = settings;
  settings_.lead = std::max(settings_.lead, 1U);
  driver::PositionStreamOptions options;
  options.ahead = settings_.lead;
  options.stale_periods = settings_.stale_periods;
  options.max_speed = settings_.max_speed;
  card_.set_ratio(driver::Card::kFullRatio);
  stream_ = std::make_unique<PositionStream>(card_, options);
  origin_ = from;
  rounded_ = from;
  resting_ = true;
  first_ = true;
  ahead_ = 0;
  mean_ahead_ = settings_.lead - kFullError;
  if (record_ != nullptr) record_->opened(card_.read_snapshot().time, from);
}

// Duration of the period's line: its own, that of periods that never arrived, and the correction of the lead.
std::int64_t ServoStream::duration_of(const trammel_period& period, std::uint64_t periods) {
  const double wanted = settings_.lead - kFullError;
  const double error = std::clamp((wanted - mean_ahead_) / kFullError, -1.0, 1.0);
  const double nominal = static_cast<double>(period.duration) * static_cast<double>(periods);
  return std::llround(nominal * (1 + kMostCorrection * error));
}

// Whether the period can be omitted. Each omitted period makes the queue shorter by one when the next one arrives. In a
// hold the queue does not change.
bool ServoStream::can_skip(bool moves, bool held) {
  if (moves || !resting_) return false;
  if (held) return ahead_ >= settings_.lead;
  if (ahead_ <= settings_.lead + kSpare) return false;
  --ahead_;
  return true;
}

void ServoStream::follow(const trammel_period& period, bool held) {
  const bool begun_anew = first_ || period.number <= last_number_;
  const std::uint64_t periods = begun_anew ? 1 : period.number - last_number_;
  PositionStream::Positions targets{};
  bool moves = false;
  Pulses rounded{};
  for (unsigned n = 0; n < card_.identification().axes; ++n) {
    targets[n] = period.target[n] - origin_[n] * PositionStream::kPulse;
    rounded[n] = nearest_pulse(period.target[n]);
    moves = moves || rounded[n] != rounded_[n];
  }
  counts_.dropped += static_cast<std::uint32_t>(periods - 1);
  last_number_ = period.number;
  if (can_skip(moves, held)) return;
  std::int64_t duration = duration_of(period, periods);
  const bool short_of_lead = !first_ && ahead_ + 1 < settings_.lead;
  if (!moves && resting_ && short_of_lead && !held) duration += period.duration;
  const PositionStream::Sent sent = stream_->send(targets, std::chrono::nanoseconds(duration));
  if (record_ != nullptr) record_->line(period, duration);
  first_ = false;
  resting_ = !moves;
  rounded_ = rounded;
  if (sent.stale_ticks != 0) ++counts_.late;
  ahead_ = sent.ahead;
  if (!held) mean_ahead_ += (static_cast<double>(ahead_) - mean_ahead_) / kMeanPeriods;
}

void ServoStream::close() {
  if (!resting_) return end_on_ramp();
  const std::unique_ptr<PositionStream> stream = std::move(stream_);
  stream->finish();
  note_end();
}

// Leaves the stream without a period: the card continues its last line for `stale_periods`, and then ramps down with a
// fault. This fault is expected, and cleared here. In a hold no period is missing, so the card is aborted, which moves
// nothing.
void ServoStream::end_on_ramp() {
  const bool has_begun = stream_->has_begun();
  stream_.reset();
  if (!has_begun) return drop();
  const auto deadline = std::chrono::seconds(2);
  try {
    for (std::chrono::nanoseconds waited{0}; !card_.read_status().faulted; waited += kLook) {
      if (card_.read_status().held) card_.stop();
      if (!card_.read_status().busy) break;
      if (waited > deadline) throw driver::TimeoutError("position stream: waiting for the end of its lines", 0);
      card_.bus().sleep(kLook);
    }
  } catch (const driver::FaultError&) {
    // The fault occurred while the hold was being set.
  }
  card_.wait_until_stopped();
  const std::uint32_t faults = card_.read_faults();
  note_end();
  if ((faults & ~card_map::field::kFaultMissingPeriod) != 0) {
    card_.parts().registers.throw_fault(faults, "end of a stream");
  }
  if (faults != 0) card_.clear_faults();
  card_.parts().registers.write(card_map::reg::kStreaming, 0, "position stream: end");
}

// For a stream of fewer periods than its lead, of which the card has executed none.
void ServoStream::drop() {
  card_.abort();
  card_.parts().registers.write(card_map::reg::kStreaming, 0, "position stream: end");
  note_end();
}

void ServoStream::abandon() {
  const bool was_open = is_open();
  stream_.reset();
  card_.wait_until_stopped();
  if (was_open) note_end();
}

void ServoStream::note_end() {
  if (record_ != nullptr) record_->closed(card_.read_snapshot().time);
}

}  // namespace trammel::linuxcnc
