// The fake's time: queues that empty, barriers, one-shot lines.
#include <algorithm>

#include "trammel/card_map.hpp"
#include "trammel/driver/fake_card.hpp"
#include "wide_arithmetic.hpp"

namespace trammel::driver {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kRatioBits = 16;
constexpr unsigned kIncrementBits = 40;

bool is_barrier(const Command& command) {
  return std::holds_alternative<DwellCommand>(command) || std::holds_alternative<EndCommand>(command);
}

std::uint64_t ticks_of(const Command& command) {
  if (const auto* line = std::get_if<LineCommand>(&command)) {
    return line->ticks;
  }
  if (const auto* arc = std::get_if<ArcCommand>(&command)) {
    return arc->ticks;
  }
  const auto* feed = std::get_if<FeedCommand>(&command);
  return feed != nullptr ? feed->ticks : 0;
}

// floor(1/2 + ticks * increment / 2^40), the steps of an axis after all ticks of a line.
std::int64_t steps_of(std::uint64_t ticks, std::int64_t increment) {
  const int128 product = static_cast<int128>(ticks) * increment + (int128{1} << (kIncrementBits - 1));
  return static_cast<std::int64_t>(product >> kIncrementBits);
}

}  // namespace

bool FakeCard::busy() const {
  return direct_left_ != 0 || dwell_left_ != 0 || geometry_.left != 0 || feed_.left != 0 ||
         !geometry_.commands.empty() || !feed_.commands.empty();
}

std::uint32_t FakeCard::ratio() const { return setting(reg::kHold) != 0 ? 0 : setting(reg::kRatioFeed); }

std::uint64_t FakeCard::setting64(std::uint32_t low, std::uint32_t high) const {
  return setting(low) | std::uint64_t{setting(high)} << 32;
}

void FakeCard::raise_fault(std::uint32_t bits) {
  const bool first = fault_ == 0;
  fault_ |= bits;
  if (first) {
    take_snapshot(card_map::Area::Stop);
  }
  cut();
}

void FakeCard::cut() {
  geometry_ = {};
  feed_ = {};
  dwell_left_ = 0;
  direct_left_ = 0;
  partial_.clear();
  stream_open_ = true;
  next_number_ = 0;
  ended_ = false;
}

bool FakeCard::direct_is_valid(std::uint32_t mask) const {
  if (setting64(reg::kLengthLo, reg::kLengthHi) == 0) {
    return false;
  }
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const std::uint64_t frequency = setting64(reg::frequency_lo(axis), reg::frequency_hi(axis));
    const bool impossible =
        frequency > std::uint64_t{1} << kIncrementBits || (frequency == 0 && setting(reg::count(axis)) != 0);
    if ((mask >> axis & 1U) != 0 && impossible) {
      return false;
    }
  }
  return true;
}

void FakeCard::start_direct(std::uint32_t mask) {
  if (mask == 0 || mask >> options_.axes != 0) {
    refuse(card_map::Reason::BadValue, reg::kStart, Direction::kWrite);
  }
  if (fault_ != 0) {
    refuse(card_map::Reason::Faulted, reg::kStart, Direction::kWrite);
  }
  if (busy()) {
    refuse(card_map::Reason::Busy, reg::kStart, Direction::kWrite);
  }
  if (!direct_is_valid(mask)) {
    refuse(card_map::Reason::BadValue, reg::kStart, Direction::kWrite);
  }
  direct_left_ = setting64(reg::kLengthLo, reg::kLengthHi);
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    const auto frequency = static_cast<std::int64_t>(setting64(reg::frequency_lo(axis), reg::frequency_hi(axis)));
    const std::int64_t possible = steps_of(direct_left_, frequency);
    const std::int64_t steps = std::min<std::int64_t>(possible, setting(reg::count(axis)));
    const std::int64_t moving = (mask >> axis & 1U) != 0 ? steps : 0;
    direct_steps_[axis] = setting(reg::direction(axis)) != 0 ? -moving : moving;
  }
}

void FakeCard::end_direct() {
  for (unsigned axis = 0; axis < card_map::kMaxAxes; ++axis) {
    position_[axis] += direct_steps_[axis];
  }
}

void FakeCard::run(std::uint64_t clocks) {
  while (clocks > 0) {
    const std::uint64_t used = run_some(clocks);
    clocks -= used;
    time_ += used;
  }
}

// Runs up to the next event, at most `clocks`; gives back the clocks used, 0 only if something has changed.
std::uint64_t FakeCard::run_some(std::uint64_t clocks) {
  std::uint64_t ticks = 0;
  if (direct_left_ != 0) {
    const std::uint64_t used = run_ticks(clocks, direct_left_, ticks);
    direct_left_ -= ticks;
    if (direct_left_ == 0) {
      end_direct();
    }
    return used;
  }
  if (dwell_left_ != 0) {
    const std::uint64_t used = std::min(clocks, dwell_left_);
    dwell_left_ -= used;
    return used;
  }
  load(geometry_);
  load(feed_);
  if (geometry_.left == 0 || feed_.left == 0) {
    return pass_barrier() ? 0 : clocks;
  }
  const std::uint64_t used = run_ticks(clocks, std::min(geometry_.left, feed_.left), ticks);
  geometry_.left -= ticks;
  feed_.left -= ticks;
  if (geometry_.left == 0) {
    end_path();
  }
  return used;
}

// The time base: clocks (at least 1, at most `clocks`) until `wanted` of them were enabled; `ticks` were.
std::uint64_t FakeCard::run_ticks(std::uint64_t clocks, std::uint64_t wanted, std::uint64_t& ticks) {
  const std::uint64_t share = ratio();
  if (share == 0) {
    return clocks;
  }
  const auto needed = wide::ceil_div((wide::uint128{wanted} << kRatioBits) - ratio_phase_, share);
  const auto used = static_cast<std::uint64_t>(std::min<wide::uint128>(needed, clocks));
  const auto phase = wide::uint128{used} * share + ratio_phase_;
  ticks = static_cast<std::uint64_t>(phase >> kRatioBits);
  ratio_phase_ = static_cast<std::uint64_t>(phase) & ((1U << kRatioBits) - 1);
  return used;
}

// Begins the next command if none is under way; a barrier stays in its queue.
void FakeCard::load(Queue& queue) {
  if (queue.left != 0 || queue.commands.empty() || is_barrier(queue.commands.front().command)) {
    return;
  }
  const Queued& next = queue.commands.front();
  queue.command = next.command;
  ++queue.begun;
  queue.left = ticks_of(next.command);
  queue.used -= next.halfwords;
  queue.commands.pop_front();
}

// Passes a barrier that both queues have reached; one that only one of them has reached while the other still has
// ticks is a fault. True if anything changed.
bool FakeCard::pass_barrier() {
  const auto at_barrier = [](const Queue& queue) { return queue.left == 0 && !queue.commands.empty(); };
  if ((at_barrier(geometry_) && feed_.left != 0) || (at_barrier(feed_) && geometry_.left != 0)) {
    raise_fault(field::kFaultTickMismatch);
    return true;
  }
  if (!at_barrier(geometry_) || !at_barrier(feed_)) {
    return false;
  }
  const Command barrier = geometry_.commands.front().command;
  for (Queue* queue : {&geometry_, &feed_}) {
    ++queue->begun;
    queue->used -= queue->commands.front().halfwords;
    queue->commands.pop_front();
  }
  if (const auto* dwell = std::get_if<DwellCommand>(&barrier)) {
    dwell_left_ = dwell->clocks;
  } else {
    ended_ = true;
  }
  return true;
}

void FakeCard::end_path() {
  if (const auto* line = std::get_if<LineCommand>(&geometry_.command)) {
    for (unsigned axis = 0; axis < options_.axes; ++axis) {
      position_[axis] += steps_of(line->ticks, line->increment[axis]);
    }
  } else if (const auto* arc = std::get_if<ArcCommand>(&geometry_.command)) {
    position_[arc->axis_x] += arc->end_x;
    position_[arc->axis_y] += arc->end_y;
  }
}

}  // namespace trammel::driver
