#include "trammel/driver/position_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "card_identity.hpp"
#include "nanoseconds.hpp"
#include "stream_limits.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kLongestPeriod = std::uint64_t{1} << 32;  // clocks
constexpr std::int64_t kFarthest = (std::int64_t{1} << 30) * PositionStream::kPulse;
constexpr unsigned kMaxStalePeriods = field::kStreamingStalePeriods >> field::kStreamingStalePeriodsShift;
// Exactly one tick per kClocksPerTick clocks: 2^-64 ticks per clock.
constexpr std::uint64_t kStreamRate = ~std::uint64_t{0} / PositionStream::kClocksPerTick + 1;

// After a line, the card is polled when it has certainly taken the line: the card's clocks from the commit to STATUS,
// spent in reads of at least this many clocks each (docs/reference/behaviour.md, Accesses).
constexpr unsigned kTakenUpClocks = 12;
constexpr unsigned kReadClocks = 5;
// STATUS and GEOMETRY_BEGUN are read before and after STALE_TICKS, at most this many times, until all belong to one
// state.
constexpr int kLooks = 4;

// Nearest whole pulse, half up: the same for every position of the origin.
std::int64_t whole_pulses(std::int64_t position) {
  const std::int64_t raised = position + PositionStream::kPulse / 2;
  return raised >= 0 ? raised / PositionStream::kPulse
                     : -((-raised + PositionStream::kPulse - 1) / PositionStream::kPulse);
}

// Pulses of an axis after `ticks` ticks of a line: docs/reference/behaviour.md, Lines.
std::int64_t pulses_after(std::int64_t increment, std::uint64_t ticks) {
  constexpr unsigned kFraction = map::constant::kFractionBits;
  const Int128 way = Int128(static_cast<std::int64_t>(ticks)) * Int128(increment);
  const Int128 phase = way + Int128(std::int64_t{1} << (kFraction - 1));
  return static_cast<std::int64_t>((phase.bits() >> kFraction).low());
}

// Rounds value * part / whole, 0 <= part <= whole < 2^40.
std::int64_t share(std::int64_t value, std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return 0;
  const double exact = static_cast<double>(value) * (static_cast<double>(part) / static_cast<double>(whole));
  return std::llround(exact);
}

}  // namespace

// After an error of the link or the card, the contents of the card are unknown.
template <class Call>
auto PositionStream::closing_at_errors(Call call) {
  try {
    return call();
  } catch (const Error&) {
    open_ = false;
    throw;
  }
}

PositionStream::PositionStream(Card& card, const PositionStreamOptions& options)
    : card_(&card),
      options_(options),
      axes_(card.identification().axes),
      margin_clocks_(clocks_of(options.margin, card.timing().clock_hz, "position stream: margin")) {
  if (!map::has_engine(card.identification().engines, map::engine::kStreaming)) {
    throw ArgumentError(fmt::format("position stream: needs {}, which the card does not have (engines 0x{:X})",
                                    map::kEngineNames[map::engine::kStreaming], card.identification().engines));
  }
  if (options.stale_periods > kMaxStalePeriods) {
    throw ArgumentError(
        fmt::format("position stream: {} stale periods are outside 0 .. {}", options.stale_periods, kMaxStalePeriods));
  }
  if (options.ahead == 0) throw ArgumentError("position stream: 0 periods ahead: at least 1");
  for (unsigned n = 0; n < axes_; ++n) {
    const double most = options.max_speed[n];
    if (!(most >= 0 && most <= 1e12)) {
      throw ArgumentError(fmt::format("position stream: axis {}: a largest speed of {} pulses/s", n, most));
    }
    least_clocks_[n] = std::max<std::uint64_t>(card.timing().pulse_period[n], kClocksPerTick);
  }
  if (card.ratio() != kFullRatio) {
    throw StateError(fmt::format("position stream: the ratio is {} / 65536; set it to the full one", card.ratio()));
  }
  const Status status = card.read_status();
  card.parts().registers.throw_if_faulted(status, "position stream");
  TimeBase& time_base = card.parts().time_base;
  if (!time_base.holds_by_this_program()) time_base.throw_if_held("position stream");
  if (status.busy) throw StateError("position stream: the card is busy; wait until it is idle, or abort it");
  origin_ = card.read_snapshot().position;
  start();
}

// Restarts everything at the present position of the axes.
void PositionStream::start() {
  card_->abort();
  card_->clear_refusal();
  const std::uint32_t reaction = card_->parts().registers.read(reg::kStopReaction) | field::kStopReactionMissingPeriod;
  std::array<Access, 4> accesses{
      write_of(reg::kStopReaction, reaction),
      write_of(reg::kStreaming, field::kStreamingOn | options_.stale_periods << field::kStreamingStalePeriodsShift),
      read_of(reg::kGeometryRoom)};
  card_->parts().registers.transfer(accesses.data(), 3, "position stream");
  geometry_room_ = accesses[2].data;
  limits_ = std::make_shared<const StreamLimits>(StreamLimits::read_from(*card_, origin_, options_.stale_periods));
  odd_clocks_ = odd_time_ = 0;
  beyond_ = {};
  behind_ = 0;
  pending_ = fed_ = false;
  lines_ = begun_ = 0;
  longest_ticks_ = 0;
  number_ = 0;
  open_ = true;
}

PositionStream::Sent PositionStream::send(const Positions& targets, std::chrono::nanoseconds duration) {
  const std::uint64_t hz = card_->identification().clock_hz;
  if (duration.count() < 0 ||
      static_cast<std::uint64_t>(duration.count()) >
          kLongestPeriod / hz * kNanosecondsPerSecond + kLongestPeriod % hz * kNanosecondsPerSecond / hz) {
    throw ArgumentError(fmt::format("position stream: a period of {} ns", duration.count()));
  }
  // Whole seconds are converted separately, so that 64 bits suffice.
  const auto time = static_cast<std::uint64_t>(duration.count());
  const std::uint64_t parts = time % kNanosecondsPerSecond * hz + odd_time_;
  const Sent sent = send(targets, time / kNanosecondsPerSecond * hz + parts / kNanosecondsPerSecond);
  odd_time_ = parts % kNanosecondsPerSecond;
  return sent;
}

PositionStream::Sent PositionStream::send(const Positions& targets, std::uint64_t clocks) {
  if (!open_) throw StateError("position stream: closed by an error or at its end; recover it, or open another");
  if (clocks < shortest_period() || clocks > kLongestPeriod) {
    throw ArgumentError(fmt::format("position stream: a period of {} clocks is outside {} .. {}", clocks,
                                    shortest_period(), kLongestPeriod));
  }
  Pulses pulses{};
  for (unsigned n = 0; n < map::kMaxAxes; ++n) {
    if (n >= axes_ ? targets[n] != 0 : targets[n] < -kFarthest || targets[n] > kFarthest) {
      throw ArgumentError(fmt::format("position stream: axis {}: a target of {} / 2^24 pulses", n, targets[n]));
    }
    pulses[n] = whole_pulses(targets[n]);
  }
  const Step step = step_to(pulses, (odd_clocks_ + clocks) / kClocksPerTick);
  require_room();
  return closing_at_errors([&] {
    const Sent sent = send_line(step);
    odd_clocks_ = (odd_clocks_ + clocks) % kClocksPerTick;
    return sent;
  });
}

// Requires room for a line, as of the last poll, or of a new one if that is not enough.
void PositionStream::require_room() {
  const std::uint32_t need = map::queue_halfwords(layout_of(LineCommand{}), line_mask());
  if (need > geometry_room_) geometry_room_ = card_->parts().registers.read(reg::kGeometryRoom);
  if (need > geometry_room_) {
    throw StateError(fmt::format("position stream: the card's queue is full, {} periods ahead", lines_ - begun_));
  }
}

// The line to the target, shortened by the card's excess time unless that makes it too fast.
PositionStream::Step PositionStream::step_to(const Pulses& told, std::uint64_t ticks) const {
  const std::uint64_t most = std::min(behind_, ticks / 2);
  Step step = step_to(told, ticks, most);
  if (most != 0 && fastest_axis(step.line)) step = step_to(told, ticks, 0);
  if (const auto axis = fastest_axis(step.line)) {
    throw ArgumentError(
        fmt::format("position stream: axis {}: {} pulses in {} clocks are too fast: at least {} clocks a pulse, at "
                    "most {} pulses/s",
                    *axis, step.line.pulses[*axis], kClocksPerTick * step.line.ticks, least_clocks_[*axis],
                    options_.max_speed[*axis] == 0 ? "any" : fmt::format("{}", options_.max_speed[*axis])));
  }
  require_limits(step);
  return step;
}

void PositionStream::require_limits(const Step& step) const {
  for (unsigned n = 0; n < axes_; ++n) {
    const std::string complaint =
        limits_->complaint(n, {step.line.pulses[n], kClocksPerTick * step.line.ticks, step.told[n] + step.beyond[n]});
    if (!complaint.empty()) throw ArgumentError(fmt::format("position stream: axis {}: {}", n, complaint));
  }
}

PositionStream::Step PositionStream::step_to(const Pulses& told, std::uint64_t ticks, std::uint64_t caught_up) const {
  Step step;
  step.told = told;
  step.behind = behind_ - caught_up;
  step.line.ticks = ticks - caught_up;
  for (unsigned n = 0; n < axes_; ++n) {
    step.beyond[n] = share(beyond_[n], step.behind, behind_);
    step.line.pulses[n] = told[n] + step.beyond[n] - told_[n] - beyond_[n];
  }
  return step;
}

std::optional<unsigned> PositionStream::fastest_axis(const Line& line) const {
  const std::uint64_t clocks = kClocksPerTick * line.ticks;
  for (unsigned n = 0; n < axes_; ++n) {
    const auto pulses = static_cast<std::uint64_t>(std::abs(line.pulses[n]));
    if (pulses > line.ticks || pulses * least_clocks_[n] > clocks) return n;
    // Rounding may add or remove a pulse.
    const double seconds = static_cast<double>(clocks) / card_->identification().clock_hz;
    const double most = options_.max_speed[n] * seconds + 1;
    if (options_.max_speed[n] != 0 && static_cast<double>(pulses) > most) return n;
  }
  return std::nullopt;
}

PositionStream::Sent PositionStream::send_line(const Step& step) {
  LineCommand line;
  line.ticks = step.line.ticks;
  line.mask = line_mask();
  for (unsigned n = 0; n < axes_; ++n) line.increment[n] = rounded_increment(step.line.pulses[n], line.ticks);
  used_ = 0;
  put(line);
  if (lines_ + 1 == options_.ahead) put_feed();
  const std::size_t reads = (kTakenUpClocks + map::constant::kDecodeAxisClocks * axes_) / kReadClocks + 1;
  for (std::size_t i = 0; i < reads; ++i) accesses_[used_++] = read_of(reg::kStatus);
  ++lines_;
  const Look look = transfer_and_look();
  told_ = step.told;
  beyond_ = step.beyond;
  behind_ = step.behind;
  longest_ticks_ = std::max(longest_ticks_, line.ticks);
  Sent sent;
  sent.ahead = lines_ - look.begun;
  // If this line has not begun, the previous one has not ended, and this line is in time.
  if (pending_ && sent.ahead == 0) sent.stale_ticks = look.stale_ticks;
  gone_beyond(sent.stale_ticks);
  last_ = line;
  pending_ = true;
  return sent;
}

// Accounts for the last line's continuation by `ticks`.
void PositionStream::gone_beyond(std::uint64_t ticks) {
  behind_ += ticks;
  all_stale_ticks_ += ticks;
  for (unsigned n = 0; n < axes_ && ticks != 0; ++n) {
    const std::int64_t increment = last_.increment[n];
    beyond_[n] += pulses_after(increment, last_.ticks + ticks) - pulses_after(increment, last_.ticks);
  }
}

void PositionStream::put_feed() {
  FeedCommand feed;
  feed.ticks = 1;  // the piece continues as long as lines take ticks
  feed.rate = kStreamRate;
  put(feed);
  fed_ = true;
}

void PositionStream::put(const Command& command) {
  std::array<std::uint32_t, kMaxCommandWords> words{};
  const std::size_t count = encode(command, number_++, words.data());
  for (std::size_t i = 0; i < count; ++i) accesses_[used_++] = write_of(reg::kStream, words[i]);
}

// Makes the prepared accesses, and polls the card until the values read belong to one state.
PositionStream::Look PositionStream::transfer_and_look() {
  for (int looks = 0; looks < kLooks; ++looks) {
    const std::size_t first = used_;
    for (const std::uint32_t address :
         {reg::kStatus, reg::kGeometryBegun, reg::kStaleTicks, reg::kStatus, reg::kGeometryBegun, reg::kGeometryRoom}) {
      accesses_[used_++] = read_of(address);
    }
    card_->parts().registers.transfer_stream(accesses_.data(), used_);
    card_->parts().watchdog.look();
    used_ = 0;
    const Access* read = &accesses_[first];
    const Status before = card_->parts().registers.status_of(read[0]);
    const Status after = card_->parts().registers.status_of(read[3]);
    card_->parts().registers.throw_if_faulted(after, "position stream");
    const std::uint64_t begun = count_after(begun_, read[4].data);
    if (begun > lines_) throw_not_ours(read[4].data);
    const bool stale = ((read[0].data | read[3].data) & field::kStatusStale) != 0;
    begun_ = begun;
    geometry_room_ = read[5].data;
    if (before.busy && after.busy && !stale && read[4].data == read[1].data) return {begun, read[2].data};
  }
  check_identity(card_->parts());
  throw StateError(
      fmt::format("position stream: period {} was over when it was looked at: the bus is too slow for it, "
                  "or the card was reset or aborted by somebody else",
                  lines_));
}

// The card counts lines that this stream has not sent, or its count has decreased.
void PositionStream::throw_not_ours(std::uint32_t begun) {
  check_identity(card_->parts());
  // A fault after the read of STATUS may have reset the counts.
  card_->parts().registers.throw_if_faulted(card_->read_status(), "position stream");
  throw StateError(
      fmt::format("position stream: the card says that it has begun {} lines, where {} were sent and {} had begun: it "
                  "was reset, or used by somebody else",
                  begun, lines_, begun_));
}

PositionStream::Positions PositionStream::finish() {
  if (!open_) throw StateError("position stream: closed by an error or at its end; recover it, or open another");
  return closing_at_errors([&] {
    used_ = 0;
    if (lines_ != 0 && !fed_) put_feed();
    put(EndCommand{});
    const std::size_t count = used_;
    card_->parts().registers.transfer_stream(accesses_.data(), count);
    const std::uint64_t clocks = (lines_ - begun_ + 1) * longest_ticks_ * kClocksPerTick * (1 + options_.stale_periods);
    const auto limit = time_of(clocks + margin_clocks_, card_->identification().clock_hz);
    card_->wait_until_idle(limit);
    if (pending_) gone_beyond(card_->parts().registers.read(reg::kStaleTicks));
    pending_ = false;
    expect_positions(card_->read_snapshot().position);
    Access off = write_of(reg::kStreaming, 0);
    std::array<Access, 2> accesses{off};
    card_->parts().registers.transfer(accesses.data(), 1, "position stream");
    open_ = false;
    return position();
  });
}

void PositionStream::expect_positions(const std::array<std::int32_t, map::kMaxAxes>& seen) const {
  const Positions expected = position();
  for (unsigned n = 0; n < axes_; ++n) {
    const std::int32_t away = pulses_between(at_card(n, expected[n] / kPulse), seen[n]);
    if (away == 0) continue;
    throw StateError(fmt::format(
        "position stream: axis {} ended {} pulses from where it was sent: the card was used by somebody else", n,
        away));
  }
}

PositionStream::Positions PositionStream::position() const {
  Positions result{};
  for (unsigned n = 0; n < axes_; ++n) result[n] = (told_[n] + beyond_[n]) * kPulse;
  return result;
}

// Converts a position of the stream to POSITION of the card.
std::int32_t PositionStream::at_card(unsigned axis, std::int64_t pulses) const {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(origin_[axis]) + static_cast<std::uint32_t>(pulses));
}

PositionStream::Stopped PositionStream::recover() {
  open_ = false;
  if (!card_->read_status().faulted) card_->stop(options_.margin);
  const std::uint64_t slew = std::max<std::uint32_t>(card_->parts().registers.read(reg::kSlew), 1);
  const std::uint64_t limit = kSlowestSlew / slew + margin_clocks_;
  const std::uint64_t pause = poll_interval(card_->timing().clock_hz);
  for (std::uint64_t waited = 0; card_->read_status().busy; waited += pause) {
    if (waited > limit) throw TimeoutError("position stream: waiting for the card to stand", waited);
    if (interrupted()) throw InterruptedError("position stream: interrupted before the card stood; recover it again");
    card_->bus().sleep(time_of(pause, card_->identification().clock_hz));
  }
  Stopped stopped;
  stopped.faults = card_->read_faults();
  if ((stopped.faults & field::kFaultMissingPeriod) != 0)
    stopped.stale_ticks = card_->parts().registers.read(reg::kStaleTicks);
  const Snapshot now = card_->read_snapshot();
  for (unsigned n = 0; n < axes_; ++n) {
    const std::int64_t expected = told_[n] + beyond_[n];
    told_[n] = expected + pulses_between(at_card(n, expected), now.position[n]);
    stopped.positions[n] = told_[n] * kPulse;
  }
  card_->clear_faults();
  start();
  return stopped;
}

}  // namespace trammel::driver
