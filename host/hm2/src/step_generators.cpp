#include "trammel/hm2/step_generators.hpp"

#include <algorithm>
#include <chrono>

#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::hm2 {
namespace {

using driver::PositionStream;

constexpr std::int64_t kPulse = std::int64_t{1} << 32;
constexpr std::int64_t kHalf = kPulse / 2;
constexpr unsigned kToStream = 32 - PositionStream::kFractionBits;
// A stream reaches 2^30 pulses from its origin. It is closed and reopened at half of that.
constexpr std::int64_t kFarthest = kPulse << 29;
constexpr std::chrono::seconds kMargin{1};

std::uint64_t clocks_of(double seconds, std::uint32_t hz, std::uint64_t least) {
  return std::max(static_cast<std::uint64_t>(seconds * hz), least);
}

// Rounded down. The driver rounds up to clocks, which gives the same number.
std::chrono::nanoseconds time_of(std::uint32_t clocks, std::uint32_t hz) {
  return std::chrono::nanoseconds(std::uint64_t{clocks} * 1'000'000'000 / hz);
}

}  // namespace

StepGenerators::StepGenerators(driver::Card& card, CardTime& time)
    : card_(card),
      time_(time),
      axes_(card.identification().axes),
      slice_(clocks_of(kSlice, card.identification().clock_hz, kLeastSlice)),
      lead_(clocks_of(kLead, card.identification().clock_hz, kLeastLead)) {
  if (!card_map::has_engine(card.identification().engines, card_map::engine::kStreaming)) {
    throw driver::ArgumentError("step generators of hostmot2: the card has no position streaming");
  }
  read_counters();
  origin_ = counters_;
  latch();
}

// A refusal of the card ends the motion; a lost link ends the server.
template <class Call>
void StepGenerators::guarded(Call call) {
  try {
    call();
  } catch (const driver::LinkError&) {
    throw;
  } catch (const driver::Error& error) {
    stop();
    trouble_ = error.what();
  }
}

void StepGenerators::set_rate(unsigned axis, std::int32_t rate) {
  if (trouble_.empty()) rates_[axis] = rate;
}

void StepGenerators::set_times(unsigned axis, const StepTimes& times) {
  times_[axis] = times;
  new_times_ |= 1U << axis;
  if (!moves()) guarded([&] { apply_times(); });
}

void StepGenerators::apply_times() {
  const std::uint32_t hz = card_.identification().clock_hz;
  for (unsigned n = 0; n < axes_; ++n) {
    if ((new_times_ >> n & 1) == 0) continue;
    driver::AxisSettings settings;
    settings.step_length = time_of(times_[n].length, hz);
    settings.step_space = time_of(times_[n].space, hz);
    settings.direction_setup = time_of(times_[n].setup, hz);
    settings.direction_hold = time_of(times_[n].hold, hz);
    settings.mode = times_[n].mode;
    settings.invert_first = times_[n].invert_first;
    settings.invert_second = times_[n].invert_second;
    card_.configure_axis(n, settings);
  }
  new_times_ = 0;
}

bool StepGenerators::all_rates_are_zero() const {
  return std::all_of(rates_.begin(), rates_.end(), [](std::int32_t rate) { return rate == 0; });
}

std::uint64_t StepGenerators::next_due() const {
  if (!trouble_.empty()) return kNever;
  if (stream_) return end_ - std::min(end_, lead_);
  return all_rates_are_zero() ? kNever : time_.now();
}

void StepGenerators::run_to(std::uint64_t clock) {
  while (next_due() <= std::max(clock, time_.now())) {
    time_.run_to(next_due());
    guarded([&] {
      const bool rested = stream_ && lines_[(sent_ - 1) % lines_.size()].rates == Rates{};
      const bool far = std::any_of(told_.begin(), told_.end(),
                                   [](std::int64_t told) { return told > kFarthest || told < -kFarthest; });
      if (!stream_) return open();
      if ((rested && all_rates_are_zero()) || far) return close();
      send_line();
    });
    if (time_.now() >= clock) break;
  }
  time_.run_to(clock);
}

// Begins with the fraction of a pulse that is left from the previous stream.
void StepGenerators::open() {
  apply_times();
  for (unsigned n = 0; n < axes_; ++n) {
    const auto pulses = std::int64_t{driver::pulses_between(origin_[n], counters_[n])} * kPulse;
    told_[n] -= pulses;
  }
  origin_ = counters_;
  driver::PositionStreamOptions options;
  options.ahead = 1;
  sent_ = 0;
  stream_.emplace(card_, options);
  ++counts_.streams;
  const std::uint64_t before = time_.now();
  end_ = before;
  send_line();
  // The line begins at an unknown time during its accesses. The estimate is good to half of their duration and affects
  // only the fraction.
  const std::uint64_t begin = before + (time_.now() - before) / 2;
  lines_[0].begin = begin;
  end_ = begin + lines_[0].clocks;
}

void StepGenerators::close() {
  counts_.stale_ticks += stream_->stale_ticks();
  stream_->finish();
  stream_.reset();
  read_counters();
}

void StepGenerators::read_counters() { counters_ = card_.read_snapshot().position; }

// Clocks of the next line: at least twice the longest pulse with its space, so that there is room for one. An axis at
// rest needs none, whatever its step times are.
std::uint64_t StepGenerators::next_clocks() const {
  std::uint64_t clocks = slice_;
  for (unsigned n = 0; n < axes_; ++n) {
    if (rates_[n] != 0) clocks = std::max<std::uint64_t>(clocks, 2 * card_.timing().pulse_period[n]);
  }
  return clocks;
}

void StepGenerators::send_line() {
  Line& line = lines_[sent_ % lines_.size()];
  line.begin = end_;
  line.clocks = next_clocks();
  line.from = told_;
  line.rates = allowed_rates(line.clocks);
  PositionStream::Positions targets{};
  for (unsigned n = 0; n < axes_; ++n) {
    told_[n] += line.rates[n] * static_cast<std::int64_t>(line.clocks);
    targets[n] = told_[n] >> kToStream;
  }
  ++sent_;
  ++counts_.lines;
  end_ += line.clocks;
  stream_->send(targets, line.clocks);
}

// Limits the rates. One pulse is subtracted because rounding may add one to the line.
StepGenerators::Rates StepGenerators::allowed_rates(std::uint64_t clocks) {
  Rates rates{};
  bool clamped = false;
  for (unsigned n = 0; n < axes_; ++n) {
    if (rates_[n] == 0) continue;
    const std::uint64_t least = std::max<std::uint64_t>(card_.timing().pulse_period[n], PositionStream::kClocksPerTick);
    const std::uint64_t pulses = clocks / least - 1;
    const auto most = static_cast<std::int64_t>(pulses * (kPulse / clocks));
    rates[n] = std::clamp<std::int64_t>(rates_[n], -most, most);
    clamped = clamped || rates[n] != rates_[n];
  }
  if (clamped) ++counts_.clamped;
  return rates;
}

void StepGenerators::stop() {
  rates_ = {};
  if (!stream_) return;
  counts_.stale_ticks += stream_->stale_ticks();
  stream_.reset();
  // On a fault the card stops by itself, at once or on a ramp.
  if (card_.read_status().faulted) card_.wait_until_stopped(kMargin);
  card_.abort();
  while (card_.busy()) time_.run_to(time_.now() + driver::poll_interval(card_.identification().clock_hz));
  read_counters();
  told_ = {};
  origin_ = counters_;
}

void StepGenerators::clear_trouble() {
  guarded([&] {
    card_.clear_faults(kMargin);
    // A cause that is still active cannot be cleared.
    trouble_ = card_.read_faults() == 0 ? "" : card_.read_fault_text();
  });
}

StepGenerators::Positions StepGenerators::told_at(std::uint64_t clock) const {
  Positions told = told_;
  if (!stream_) return told;
  const std::uint64_t kept = std::min<std::uint64_t>(sent_, lines_.size());
  for (std::uint64_t back = 1; back <= kept; ++back) {
    const Line& line = lines_[(sent_ - back) % lines_.size()];
    if (clock < line.begin && back != kept) continue;
    const auto clocks =
        static_cast<std::int64_t>(std::clamp<std::uint64_t>(clock, line.begin, line.begin + line.clocks) - line.begin);
    for (unsigned n = 0; n < axes_; ++n) told[n] = line.from[n] + line.rates[n] * clocks;
    break;
  }
  return told;
}

void StepGenerators::latch() {
  const driver::Snapshot now = card_.read_snapshot();
  const Positions told = told_at(now.time);
  counters_ = now.position;
  for (unsigned n = 0; n < axes_; ++n) {
    const std::int64_t pulses = std::int64_t{driver::pulses_between(origin_[n], counters_[n])} * kPulse;
    const std::int64_t fraction = std::clamp(told[n] - pulses, -kHalf, kHalf - 1);
    accumulators_[n] = (static_cast<std::uint32_t>(counters_[n]) << 16) + static_cast<std::uint32_t>(fraction >> 16);
  }
}

}  // namespace trammel::hm2
