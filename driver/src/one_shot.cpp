#include "trammel/driver/one_shot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clocks.hpp"
#include "trammel/card_map.hpp"
#include "wide_arithmetic.hpp"

namespace trammel::driver {
namespace {

using wide::uint128;

constexpr unsigned kFractionBits = card_map::constant::kFractionBits;
constexpr std::uint64_t kMaxLength = (std::uint64_t{1} << 40) - 1;
constexpr std::uint64_t kMaxCount = 0xFFFFFFFF;
constexpr std::uint64_t kMaxClocks = (std::uint64_t{1} << 62) - 1;
constexpr std::int64_t kMaxDisplacement = std::int64_t{1} << 62;

std::uint64_t magnitude(std::int64_t value) {
  return value < 0 ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
}

std::uint64_t longest(const Displacement& displacement) {
  std::uint64_t result = 0;
  for (const std::int64_t pulses : displacement) {
    result = std::max(result, magnitude(pulses));
  }
  return result;
}

void check_displacement(const CardTiming& card, const Displacement& displacement) {
  for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::int64_t pulses = displacement[axis];
    if (pulses != 0 && axis >= card.axes) {
      throw ArgumentError(
          fmt::format("line: axis {} is to move {} pulses, but the card has {} axes", axis, pulses, card.axes));
    }
    if (pulses > kMaxDisplacement || pulses < -kMaxDisplacement) {
      throw ArgumentError(fmt::format("line: {} pulses of axis {} are more than 2^62", pulses, axis));
    }
  }
  if (longest(displacement) == 0) {
    throw ArgumentError("line: no axis moves");
  }
}

// The fewest clocks in which the axis makes its pulses. Bound: 2^62 pulses * 2^32 Hz, 94 bits.
uint128 fewest_clocks(const CardTiming& card, std::size_t axis, std::uint64_t pulses, std::uint64_t max_velocity) {
  const uint128 of_card = uint128{pulses} * std::max<std::uint32_t>(card.pulse_period[axis], 1);
  if (max_velocity == 0) {
    return of_card;
  }
  return std::max(of_card, wide::ceil_div(uint128{pulses} * card.clock_hz, max_velocity));
}

// N for the whole line: `clocks`, or more where a limit asks for it and the policy allows it.
uint128 limited_clocks(const CardTiming& card, const Displacement& displacement, std::uint64_t clocks,
                       const LineLimits& limits) {
  uint128 result = clocks;
  for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::uint64_t pulses = magnitude(displacement[axis]);
    const uint128 needed = fewest_clocks(card, axis, pulses, limits.max_velocity[axis]);
    if (needed > clocks && limits.policy == LimitPolicy::kRefuse) {
      throw ArgumentError(fmt::format(
          "line: axis {}: {} pulses in {} clocks at {} Hz are too fast for its limit ({} pulses/s, 0: none) or for its "
          "step length and space ({} clocks a pulse)",
          axis, pulses, clocks, card.clock_hz, limits.max_velocity[axis], card.pulse_period[axis]));
    }
    result = std::max(result, needed);
  }
  return result;
}

// round(pulses * index / parts): pulses up to the start of part `index`.
std::uint64_t pulses_before(std::uint64_t pulses, std::size_t index, std::size_t parts) {
  return static_cast<std::uint64_t>((uint128{pulses} * index + parts / 2) / parts);
}

std::uint64_t speed_clocks(const CardTiming& card, const Displacement& displacement, PathSpeed speed) {
  if (speed.pulses == 0 || speed.seconds == 0) {
    throw ArgumentError(fmt::format("line: a speed of {} pulses in {} s", speed.pulses, speed.seconds));
  }
  uint128 square = 0;  // of the path's length; 8 * 2^124 at most
  for (const std::int64_t pulses : displacement) {
    square += uint128{magnitude(pulses)} * magnitude(pulses);
  }
  // The fewest whole N with N * speed >= length * f: the root may be rounded up first, as N * pulses is whole.
  const uint128 scaled = wide::ceil_root(square, std::uint64_t{card.clock_hz} * speed.seconds);
  const uint128 clocks = wide::ceil_div(scaled, speed.pulses);
  return static_cast<std::uint64_t>(std::min<uint128>(clocks, kMaxClocks + 1));  // too long is refused later
}

void require_direct_mode(const Card& card) {
  const std::uint32_t engines = card.identification().engines;
  if (!card_map::has_engine(engines, card_map::engine::kDirectMode)) {
    throw ArgumentError(
        fmt::format("line: the card has no direct mode (engines 0x{:X}); stream it as LINE and FEED", engines));
  }
}

const OneShotPart require_single_part(const OneShotPlan& plan) {
  if (plan.size() != 1) {
    throw ArgumentError(fmt::format("line: {} clocks are too long for one start; run_line takes its {} parts",
                                    plan.clocks(), plan.size()));
  }
  return plan.part(0);
}

}  // namespace

std::uint64_t one_shot_frequency(std::uint64_t pulses, std::uint64_t clocks) {
  return static_cast<std::uint64_t>(((uint128{pulses} << kFractionBits) + clocks / 2) / clocks);
}

std::array<std::uint32_t, kOneShotWords> OneShotPart::words() const {
  namespace reg = card_map::reg;
  std::array<std::uint32_t, kOneShotWords> result{};
  const auto at = [&result](std::uint32_t address) -> std::uint32_t& {
    return result[(address - reg::frequency_lo(card_map::kMaxAxes - 1)) / 4];
  };
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    at(reg::frequency_lo(axis)) = static_cast<std::uint32_t>(frequency[axis]);
    at(reg::frequency_hi(axis)) = static_cast<std::uint32_t>(frequency[axis] >> 32);
    at(reg::count(axis)) = count[axis];
    at(reg::direction(axis)) = (negative >> axis) & 1U;
  }
  at(reg::kLengthLo) = static_cast<std::uint32_t>(length);
  at(reg::kLengthHi) = static_cast<std::uint32_t>(length >> 32);
  at(reg::kStart) = mask;
  return result;
}

OneShotPart OneShotPlan::part(std::size_t index) const {
  OneShotPart part;
  part.length = part_clocks_;
  for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::uint64_t pulses = magnitude(displacement_[axis]);
    const std::uint64_t count = pulses_before(pulses, index + 1, parts_) - pulses_before(pulses, index, parts_);
    part.count[axis] = static_cast<std::uint32_t>(count);
    part.frequency[axis] = one_shot_frequency(count, part_clocks_);
    // An axis of the line without a pulse in this part takes part all the same: no part has an empty mask.
    part.mask = static_cast<std::uint8_t>(part.mask | (pulses != 0 ? 1U : 0U) << axis);
    part.negative = static_cast<std::uint8_t>(part.negative | (displacement_[axis] < 0 ? 1U : 0U) << axis);
  }
  return part;
}

OneShotPlan plan_line_clocks(const CardTiming& card, const Displacement& displacement, std::uint64_t clocks,
                             const LineLimits& limits) {
  check_displacement(card, displacement);
  if (clocks == 0) {
    throw ArgumentError("line: a duration of 0 clocks");
  }
  const uint128 total = limited_clocks(card, displacement, clocks, limits);
  if (total > kMaxClocks) {
    throw ArgumentError(fmt::format("line: it would take 2^62 clocks at {} Hz or more", card.clock_hz));
  }
  // A part has ceil(|p| / parts) pulses at most and a whole share of the clocks, so never more pulses than clocks.
  const uint128 parts = std::max(wide::ceil_div(total, kMaxLength), wide::ceil_div(longest(displacement), kMaxCount));
  OneShotPlan plan;
  plan.displacement_ = displacement;
  plan.parts_ = static_cast<std::size_t>(parts);
  plan.part_clocks_ = static_cast<std::uint64_t>(wide::ceil_div(total, parts));
  plan.slowed_ = total > clocks;
  return plan;
}

OneShotPlan plan_line(const CardTiming& card, const Displacement& displacement, std::chrono::nanoseconds duration,
                      const LineLimits& limits) {
  check_displacement(card, displacement);
  if (duration.count() <= 0) {
    throw ArgumentError(fmt::format("line: a duration of {} ns", duration.count()));
  }
  return plan_line_clocks(card, displacement, clocks_of(duration, card.clock_hz, "line: duration"), limits);
}

OneShotPlan plan_line(const CardTiming& card, const Displacement& displacement, PathSpeed speed,
                      const LineLimits& limits) {
  check_displacement(card, displacement);
  return plan_line_clocks(card, displacement, speed_clocks(card, displacement, speed), limits);
}

void start_line(Card& card, const OneShotPart& part) {
  namespace reg = card_map::reg;
  require_direct_mode(card);
  const auto words = part.words();
  // The slots run downwards, so that those of the card's axes lie just before LENGTH and START.
  const unsigned axes = card.identification().axes;
  const std::size_t absent = words.size() - one_shot_words(axes);
  try {
    card.bus().write_block(reg::frequency_lo(axes - 1), &words[absent], words.size() - absent,
                           Addressing::kIncrementing);
  } catch (const BusError& error) {
    card.throw_refusal(error, "line");
  }
}

OneShotPlan start_line(Card& card, const Displacement& displacement, std::chrono::nanoseconds duration,
                       const LineLimits& limits) {
  require_direct_mode(card);
  const OneShotPlan plan = plan_line(card.timing(), displacement, duration, limits);
  start_line(card, require_single_part(plan));
  return plan;
}

OneShotPlan start_line(Card& card, const Displacement& displacement, PathSpeed speed, const LineLimits& limits) {
  require_direct_mode(card);
  const OneShotPlan plan = plan_line(card.timing(), displacement, speed, limits);
  start_line(card, require_single_part(plan));
  return plan;
}

void run_line(Card& card, const OneShotPlan& plan, std::chrono::nanoseconds patience) {
  card.clocks(patience, "line: patience");
  for (std::size_t index = 0; index < plan.size(); ++index) {
    const OneShotPart part = plan.part(index);
    start_line(card, part);
    card.bus().wait(part.length);
    card.wait_until_idle(patience);
  }
}

}  // namespace trammel::driver
