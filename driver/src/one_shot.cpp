#include "trammel/driver/one_shot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "card_identity.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/driver/wide.hpp"
#include "wait_budget.hpp"

namespace trammel::driver {
namespace {

constexpr std::uint64_t mask_of(std::uint32_t address) { return card_map::find_register(address).entry->mask; }
constexpr std::uint64_t kMaxLength = mask_of(card_map::reg::kLengthHi) << 32 | mask_of(card_map::reg::kLengthLo);
constexpr std::uint64_t kMaxCount = mask_of(card_map::reg::count(0));
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

// Smallest number of clocks in which the axis makes its pulses. Bound: 2^62 pulses * 2^32 Hz, 94 bits.
Uint128 fewest_clocks(const CardTiming& card, std::size_t axis, std::uint64_t pulses, std::uint64_t max_velocity) {
  const Uint128 of_card = Uint128::product(pulses, std::max<std::uint32_t>(card.pulse_period[axis], 1));
  if (max_velocity == 0) {
    return of_card;
  }
  return std::max(of_card, ceil_div(Uint128::product(pulses, card.clock_hz), max_velocity));
}

// N for the whole line: `clocks`, or more if a limit requires it and the policy allows it.
Uint128 limited_clocks(const CardTiming& card, const Displacement& displacement, std::uint64_t clocks,
                       const LineLimits& limits) {
  Uint128 result = clocks;
  for (std::size_t axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::uint64_t pulses = magnitude(displacement[axis]);
    const Uint128 needed = fewest_clocks(card, axis, pulses, limits.max_velocity[axis]);
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
  return ((Uint128::product(pulses, index) + parts / 2) / parts).low();
}

// A product of 256 bits.
struct Product {
  Uint128 high;
  Uint128 low;
};

Product multiply(Uint128 a, Uint128 b) {
  const Uint128 low_low = Uint128::product(a.low(), b.low());
  const Uint128 low_high = Uint128::product(a.low(), b.high());
  const Uint128 high_low = Uint128::product(a.high(), b.low());
  const Uint128 middle = Uint128(low_low.high()) + Uint128(low_high.low()) + Uint128(high_low.low());
  return {Uint128::product(a.high(), b.high()) + Uint128(low_high.high()) + Uint128(high_low.high()) +
              Uint128(middle.high()),
          Uint128(middle.low(), low_low.low())};
}

bool less(const Product& a, const Product& b) { return a.high != b.high ? a.high < b.high : a.low < b.low; }

// The smallest R with R^2 >= square * factor^2. Bound: the root of square is below 2^64 and so is factor, so R <=
// 2^128.
Uint128 ceil_root(Uint128 square, std::uint64_t factor) {
  const Product target = multiply(square, Uint128::product(factor, factor));
  Uint128 below;  // below^2 < target, once a bit is set
  for (unsigned bit = 128; bit-- > 0;) {
    const Uint128 candidate = below + (Uint128(1) << bit);
    if (less(multiply(candidate, candidate), target)) {
      below = candidate;
    }
  }
  return target.high == Uint128(0) && target.low == Uint128(0) ? Uint128(0) : below + Uint128(1);
}

std::uint64_t speed_clocks(const CardTiming& card, const Displacement& displacement, PathSpeed speed) {
  if (speed.pulses == 0 || speed.seconds == 0) {
    throw ArgumentError(fmt::format("line: a speed of {} pulses in {} s", speed.pulses, speed.seconds));
  }
  Uint128 square;  // square of the path's length; at most 8 * 2^124
  for (const std::int64_t pulses : displacement) {
    square = square + Uint128::product(magnitude(pulses), magnitude(pulses));
  }
  // The smallest integer N with N * speed >= length * f. The root may be rounded up first, because N * pulses is an
  // integer.
  const Uint128 scaled = ceil_root(square, std::uint64_t{card.clock_hz} * speed.seconds);
  const Uint128 clocks = ceil_div(scaled, speed.pulses);
  return std::min<Uint128>(clocks, kMaxClocks + 1).low();  // a longer line is refused later
}

bool has_direct_mode(const Card& card) {
  return card_map::has_engine(card.identification().engines, card_map::engine::kDirectMode);
}

// One write per register of the card's axes, LENGTH and START. The slots are in descending order, so those of the
// card's axes are directly before LENGTH and START.
void start_direct(Card& card, const OneShotPart& part) {
  const auto words = part.words();
  const unsigned axes = card.identification().axes;
  const std::size_t absent = words.size() - one_shot_words(axes);
  std::array<Access, kOneShotWords + 1> accesses;
  for (std::size_t i = absent; i < words.size(); ++i) {
    const auto offset = static_cast<std::uint32_t>(4 * (i - absent));
    accesses[i - absent] = write_of(card_map::reg::frequency_lo(axes - 1) + offset, words[i]);
  }
  card.parts().registers.transfer(accesses.data(), words.size() - absent, "line");
}

// Without direct mode: the same increments on feed ticks, one per clock except for 2^-64 of a tick.
void start_streamed(Card& card, const OneShotPart& part) {
  Stream stream(card);
  FeedCommand feed;
  feed.ticks = part.length;
  feed.rate = ~std::uint64_t{0};
  feed.floor = ~std::uint32_t{0};
  LineCommand line;
  line.ticks = part.length;
  line.mask = part.mask;
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const auto increment = static_cast<std::int64_t>(part.frequency[axis]);
    line.increment[axis] = (part.negative >> axis & 1U) != 0 ? -increment : increment;
  }
  stream.put(feed);
  stream.put(line);
  stream.flush();
}

// Checks, when the card is idle, that it is still the same card and was not reset since the start.
void check_made(Card& card, const OneShotPart& part) {
  check_identity(card.parts());
  if (!has_direct_mode(card)) {
    return;
  }
  std::array<Access, 3> length{read_of(card_map::reg::kLengthLo), read_of(card_map::reg::kLengthHi)};
  card.parts().registers.transfer(length.data(), 2, "line");
  if ((length[0].data | std::uint64_t{length[1].data} << 32) != part.length) {
    throw StateError("line: the card does not know it any more: it was reset, or is used by another program");
  }
}

// Otherwise nothing would move, and no waiting call would end.
void require_moving(Card& card) {
  card.parts().time_base.throw_if_held("line");
  if (card.parts().registers.read(card_map::reg::kRatioFeed) == 0) {
    throw HeldError("line: the time base's ratio is 0: set another one first");
  }
}

OneShotPart require_single_part(const OneShotPlan& plan) {
  if (plan.size() != 1) {
    throw ArgumentError(fmt::format("line: {} clocks are too long for one start; run_line takes its {} parts",
                                    plan.clocks(), plan.size()));
  }
  return plan.part(0);
}

}  // namespace

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
    part.frequency[axis] = rounded_share(count, part_clocks_);
    // An axis of the line takes part even if it has no pulse in this part, so that no part has an empty mask.
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
  const Uint128 total = limited_clocks(card, displacement, clocks, limits);
  if (total > kMaxClocks) {
    throw ArgumentError(fmt::format("line: it would take 2^62 clocks at {} Hz or more", card.clock_hz));
  }
  // A part has at most ceil(|p| / parts) pulses and a full share of the clocks, so never more pulses than clocks.
  const Uint128 parts = std::max(ceil_div(total, kMaxLength), ceil_div(longest(displacement), kMaxCount));
  OneShotPlan plan;
  plan.displacement_ = displacement;
  plan.parts_ = static_cast<std::size_t>(parts.low());
  plan.part_clocks_ = ceil_div(total, parts).low();
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
  if (has_direct_mode(card)) {
    start_direct(card, part);
  } else {
    start_streamed(card, part);
  }
}

OneShotPlan start_line(Card& card, const Displacement& displacement, std::chrono::nanoseconds duration,
                       const LineLimits& limits) {
  const OneShotPlan plan = plan_line(card.timing(), displacement, duration, limits);
  start_line(card, require_single_part(plan));
  return plan;
}

OneShotPlan start_line(Card& card, const Displacement& displacement, PathSpeed speed, const LineLimits& limits) {
  const OneShotPlan plan = plan_line(card.timing(), displacement, speed, limits);
  start_line(card, require_single_part(plan));
  return plan;
}

void run_line(Card& card, const OneShotPlan& plan, std::chrono::nanoseconds margin) {
  constexpr const char* kContext = "line: waiting for its end";
  constexpr std::uint32_t kLooksPerSecond = 50;
  const std::uint64_t margin_clocks = clocks_of(margin, card.timing().clock_hz, "line: margin");
  const std::uint64_t shortest_pause = poll_interval(card.timing().clock_hz);
  const std::uint64_t look = std::max<std::uint64_t>(card.timing().clock_hz / kLooksPerSecond, shortest_pause);
  require_moving(card);
  for (std::size_t index = 0; index < plan.size(); ++index) {
    const OneShotPart part = plan.part(index);
    start_line(card, part);
    WaitBudget waiting(card, kContext, margin_clocks);
    waiting.allow(PlannedTime::of(part.length));
    // The first pause is about as long as the line, the last ones are short.
    Status status;
    std::uint64_t left = part.length;
    do {
      const std::uint64_t pause = std::clamp(left, shortest_pause, look);
      waiting.pause(status, pause, WaitBudget::kIdle);
      left -= std::min(left, pause);
      status = card.read_status();
      card.parts().registers.throw_if_faulted(status, kContext);
      serve_requests(card);
    } while (status.busy);
    check_made(card, part);
  }
}

}  // namespace trammel::driver
