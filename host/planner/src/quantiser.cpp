#include "quantiser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "roots.hpp"
#include "trammel/card_map.hpp"

namespace trammel::planner {
namespace {

constexpr double kUpdate = card_map::constant::kUpdateClocks;
constexpr double kShortest = 4 * kUpdate;  // clocks; what is shorter makes one piece with what follows
// A card that holds for want of paths goes on with twice the stop distance and a reserve. What it needs must be there
// while the host fills a queue that is half empty: no stop distance is more than this part of full queues.
constexpr double kFillOfReach = 4;
constexpr double kReserve = card_map::constant::kUnderrunReserveTicks;
// The card goes on at a piece's last rate for so many clocks after its last tick; these ticks are the next piece's.
constexpr double kSwapClocks = 6;
constexpr double kLeastRate = 0x1p-32;
constexpr double kSteady = 1e-5;  // change of a rate that is none
constexpr double kRest = 1e-6;    // mm/s

std::uint64_t fixed64(double rate) { return static_cast<std::uint64_t>(std::min(rate, 1 - 0x1p-53) * 0x1p64); }
std::int64_t signed64(double change) { return static_cast<std::int64_t>(change * 0x1p64); }
std::uint32_t fixed32(double rate) { return static_cast<std::uint32_t>(std::clamp(rate, kLeastRate, 0.5) * 0x1p32); }
std::uint32_t ticks32(double ticks) { return static_cast<std::uint32_t>(std::min(std::ceil(ticks), 4294967295.0)); }

bool same(double a, double b) { return std::abs(a - b) <= 0.01 * std::abs(b); }

// When the distance has been gone from speed, acceleration and jerk on, of a motion that takes `duration` for `length`;
// a little outside it at the speed that it has there. Newton's method between bounds.
double time_at(double distance, double speed, double acceleration, double jerk, double duration, double length) {
  if (jerk == 0) {
    const double end = std::sqrt(std::max(0.0, speed * speed + 2 * acceleration * distance));
    const double sum = speed + end;
    return sum > 0 ? 2 * distance / sum : 0;
  }
  const auto speed_at = [&](double time) { return speed + time * (acceleration + time * jerk / 2); };
  if (distance <= 0) return speed > 0 ? distance / speed : 0;
  if (distance >= length) {
    const double end = speed_at(duration);
    return duration + (end > 0 ? (distance - length) / end : 0);
  }
  double low = 0;
  double high = duration;
  double time = duration * (distance / length);
  for (int i = 0; i < 100; ++i) {
    const double rest = distance - time * (speed + time * (acceleration / 2 + time * jerk / 6));
    (rest < 0 ? high : low) = time;
    double next = time + rest / speed_at(time);
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - time) <= 1e-15 * duration) break;
    time = next;
  }
  return time;
}

}  // namespace

Quantiser::Quantiser(PathRing& path, double clock_hz, double stop_clocks, const QueueLimits& queues, bool smooth,
                     bool classes)
    : path_(path),
      smooth_(smooth),
      classes_(classes),
      clock_hz_(clock_hz),
      stop_clocks_(stop_clocks),
      queues_(queues),
      fit_(clock_hz),
      pieces_(kPieces),
      highest_(kPieces) {}

void Quantiser::add(const Phase& phase) {
  bool waits = at_ == 0;
  for (; !moves(path_[at_].block); ++at_) waits = true;
  if (!moving_) {
    turns_ = !waits;
    moving_ = true;
    spanned_ = 0;
    // Where the density is what it is from does not matter: lengths go on from any place.
    mm_ = base_mm_ = path_[at_].begin;
    base_tick_ = tick_ = pending_.end = path_[at_].begin_ticks;
    lead_ = 0;
    rate_a_speed_ = path_[at_].density / clock_hz_;
    fit_.start(rate_a_speed_);
  } else if (phase.speed == 0) {
    turns_ = true;
  }
  const double begin = mm_;
  mm_ += phase.length;
  short_sight_ = phase.short_sight;
  for (; !path_[at_].stop && (phase.stop || path_[at_].end <= mm_); ++at_) {
    const PathEntry& block = path_[at_];
    if (!block.cut && ++spanned_ < kMostBlocks) continue;
    portion(phase, begin, block.end, block.end_ticks, true, false);
    spanned_ = 0;
    if (!block.cut) continue;
    base_mm_ = block.end;
    base_tick_ = block.end_ticks;
    change_density(path_[at_ + 1].density / clock_hz_);
  }
  PathEntry& block = path_[at_];
  if (phase.stop) {
    portion(phase, begin, mm_, block.end_ticks, true, true);
    moving_ = false;
    ++at_;
  } else {
    portion(phase, begin, mm_, end_tick(phase, block), false, false);
  }
  complete();
}

// Where ticks become longer, those that pass at the old rate put the motion ahead of its time. Its speed is still that
// of its time: what it is ahead by counts as gone.
void Quantiser::change_density(double rate_a_speed) {
  const double change = rate_a_speed / rate_a_speed_;
  rate_a_speed_ = rate_a_speed;
  ahead_ = change < 1 ? std::max(0.0, lead_ - kSwapClocks * end_rate_ * change) : 0;
  fit_.change_density(rate_a_speed_, ahead_);
}

// The tick at which a phase ends at mm_, in the block or where it begins.
std::uint64_t Quantiser::end_tick(const Phase& phase, const PathEntry& block) const {
  // A phase that ends with a block does so at its tick: the next one may be for the next block's limits alone, and
  // what rounding leaves beyond a cut is no piece.
  constexpr double kSame = 1e-9;  // mm
  const bool corner = smooth_ || (phase.acceleration < 0 && phase.next > 0);
  std::uint64_t tick = 0;
  if ((corner || block.cut) && block.end - mm_ < kSame) {
    tick = block.end_ticks;
  } else if ((corner || block.begin == base_mm_) && mm_ - block.begin < kSame) {
    tick = block.begin_ticks;
  } else {
    const double exact = (mm_ - base_mm_) * rate_a_speed_ * clock_hz_;
    const double from_base = smooth_ ? exact + 0.5 : fit_.end_tick(phase, exact);
    tick = base_tick_ + static_cast<std::uint64_t>(std::max(0.0, from_base));
  }
  // Where a block has more ticks than its length, those before it keep at least one for the piece behind.
  return std::clamp(tick, pending_.end, std::max(pending_.end, block.end_ticks));
}

// Of a phase that begins at `begin`, from the last portion's end to `end`, which is about at `end_tick`.
void Quantiser::portion(const Phase& phase, double begin, double end, std::uint64_t end_tick, bool last, bool stop) {
  const auto place = [&](std::uint64_t tick) {
    const double ticks =
        tick < base_tick_ ? -static_cast<double>(base_tick_ - tick) : static_cast<double>(tick - base_tick_);
    return base_mm_ + ticks / (rate_a_speed_ * clock_hz_) - begin;
  };
  // Less than two updates of a ramp are not worth a piece: the next one begins earlier.
  const double change = std::abs(pending_.motion.end_rate - pending_.motion.rate);
  const bool brief = pending_.motion.clocks < 2 * kUpdate && change > kSteady * pending_.motion.rate;
  if (smooth_ && end_tick > pending_.end && brief) pending_.end = tick_;
  const double from = place(pending_.end);
  const std::uint64_t ticks = end_tick > pending_.end ? end_tick - pending_.end : 0;
  if (!smooth_) {
    const double late = (place(end_tick) - (end - begin)) * rate_a_speed_ * clock_hz_;
    fit_.advance(phase, end - begin, static_cast<double>(ticks), late, mm_ - end > 1e-9);
  }
  Motion motion;
  if (ticks != 0) {
    bool empty = pending_.end == tick_;
    const auto behind = [&](double lead) {
      if (!smooth_) return ramp(phase, static_cast<double>(ticks), lead);
      const double gone = lead / (rate_a_speed_ * clock_hz_);
      return motion_of(phase, from + gone, place(end_tick), static_cast<double>(ticks) - lead, stop);
    };
    motion = behind(empty ? std::min(lead_, static_cast<double>(ticks) / 2) : 0);
    const bool whole = motion.clocks >= kShortest || (empty && last);
    // One piece for both would have more than the smaller acceleration.
    const bool apart = !smooth_ && pending_.acceleration * phase.acceleration > 0 &&
                       !same(pending_.acceleration, phase.acceleration) && pending_.motion.clocks >= kUpdate;
    if (!empty && (whole || apart)) {
      put_pending(false);
      empty = true;
      motion = behind(std::min(lead_, static_cast<double>(ticks) / 2));
    }
    if (whole) {
      put(motion, end_tick, stop);
      return;
    }
    pending_.acceleration = phase.acceleration;
    if (empty) pending_.motion.rate = smooth_ ? motion.rate : behind(0).rate;
    pending_.motion.end_rate = motion.end_rate;
    pending_.motion.clocks = motion.clocks + (empty ? 0 : pending_.motion.clocks);
    pending_.end = end_tick;
  }
  if (pending_.end != tick_) {
    if (last || pending_.motion.clocks >= kShortest) put_pending(stop);
  } else if (stop && last_ != first_) {
    piece(last_ - 1).stop = true;
  }
}

Quantiser::Motion Quantiser::steady(double rate, double end_rate, double ticks) {
  Motion motion;
  motion.rate = rate;
  motion.end_rate = end_rate;
  motion.acceleration = (end_rate - rate) * (end_rate + rate) / (2 * ticks);
  motion.clocks = 2 * ticks / (rate + end_rate);
  return motion;
}

// Of constant acceleration; `lead` ticks are gone when it begins.
Quantiser::Motion Quantiser::steady_behind(double lead, double rate, double end_rate, double ticks) const {
  const double ahead = std::min(ahead_, lead);
  const double begin =
      std::sqrt(rate * rate + (end_rate - rate) * (end_rate + rate) * ((lead - ahead) / (ticks - ahead)));
  return steady(begin, end_rate, ticks - lead);
}

Quantiser::Motion Quantiser::ramp(const Phase& phase, double ticks, double lead) const {
  const double rest = std::sqrt(std::abs(phase.acceleration) * rate_a_speed_ / clock_hz_);
  const double most = std::max(fit_.rate(), fit_.end_rate());
  const double least = most > 0 ? std::min(rest, most) : rest;
  return steady_behind(lead, std::max(fit_.rate(), least), std::max(fit_.end_rate(), least), ticks);
}

// `from` and `to`: mm from where the phase begins; a part of a tick outside it, or one block's ticks too many.
Quantiser::Motion Quantiser::motion_of(const Phase& phase, double from, double to, double ticks, bool stop) const {
  if (phase.jerk == 0) {
    const auto rate_at = [&](double place) {
      return rate_a_speed_ * std::sqrt(std::max(0.0, phase.speed * phase.speed + 2 * phase.acceleration * place));
    };
    const double rate = rate_at(std::min(from, to));
    const double end_rate = rate_at(to);
    const double rest = std::sqrt(std::abs(phase.acceleration) * rate_a_speed_ / clock_hz_);
    const double most = std::max(rate, end_rate);
    const double least = most > 0 ? std::min(rest, most) : rest;
    return steady(std::max(rate, least), std::max(end_rate, least), ticks);
  }
  // A stop in mid path, for a window that is too short, is at a whole tick, too: the part of a tick beside it would
  // take as long as thousands of updates.
  const double tick = 1 / (rate_a_speed_ * clock_hz_);
  const bool rests = stop || (to > phase.length - tick && end_speed(phase) < kRest);
  const bool rested = phase.speed == 0 && turns_ && from < tick;
  const auto when = [&](double place) {
    return time_at(place, phase.speed, phase.acceleration, phase.jerk, phase.duration, phase.length);
  };
  double begin = rested ? 0 : when(from);
  const double end = rests ? phase.duration : when(to);
  const auto rate_at = [&](double time) {
    return std::max(0.0, phase.speed + time * (phase.acceleration + time * phase.jerk / 2)) * rate_a_speed_;
  };
  Motion motion;
  motion.rate = rate_at(begin);
  motion.end_rate = rate_at(end);
  // Its jerk is no guide far outside the phase, where it would end the feed before the ticks end.
  const auto astray = [](double rate, double right) { return std::abs(rate - right) > right / 2; };
  const double left = end_speed(phase) * rate_a_speed_;
  if (!rests && end > phase.duration && astray(motion.end_rate, left)) {
    return steady(phase.speed * rate_a_speed_, left, ticks);
  }
  if (begin < 0 && astray(motion.rate, phase.speed * rate_a_speed_)) {
    begin = 0;
    motion.rate = rate_at(begin);
  }
  motion.acceleration = (phase.acceleration + begin * phase.jerk) * rate_a_speed_ / clock_hz_;
  motion.jerk = phase.jerk * rate_a_speed_ / clock_hz_ / clock_hz_;
  motion.clocks = (end - begin) * clock_hz_;
  // At rest the tick next to it, which would take three times as long, is at the floor.
  const double floor = cube_root(4.5 * std::abs(motion.jerk));
  motion.rests = rests;
  if (rests) {
    motion.end_rate = std::max(motion.end_rate, floor);
    motion.clocks = std::max(motion.clocks - 2 / floor, ticks / std::max(motion.rate, floor));
  } else if (rested && motion.rate < floor) {
    begin_at(floor, ticks, motion);
  }
  return motion;
}

// From the rate that the stop before ends at, to the end's rate, with the jerk that makes the ticks: a little less
// acceleration at the end keeps it below the planned one. Not where the ticks are too few.
void Quantiser::begin_at(double rate, double ticks, Motion& motion) {
  constexpr double kLess = 0.001;
  const double gain = motion.end_rate - rate;
  double acceleration = motion.acceleration + motion.clocks * motion.jerk;
  // ticks = (rate + gain / 2) t - (acceleration t - gain) t / 6
  const double linear = rate + gain * 2 / 3;
  for (int i = 0; i < 9; ++i, acceleration *= 1 - kLess) {
    const double square = linear * linear - acceleration * ticks * 2 / 3;
    if (!(gain > 0) || !(square > 0)) return;
    const double clocks = 2 * ticks / (linear + std::sqrt(square));
    const double jerk = 2 * (acceleration - gain / clocks) / clocks;
    if (jerk > motion.jerk) continue;
    motion = {rate, acceleration - jerk * clocks, jerk, clocks, motion.end_rate};
    return;
  }
}

void Quantiser::put_pending(bool stop) {
  const double ticks = static_cast<double>(pending_.end - tick_);
  const double lead = std::min(lead_, ticks / 2);
  const Motion& all = pending_.motion;  // of smooth motion the rate is that behind the lead
  put(smooth_ ? steady(all.rate, all.end_rate, ticks - lead) : steady_behind(lead, all.rate, all.end_rate, ticks),
      pending_.end, stop);
}

// The highest or lowest rate lies inside where the acceleration changes its sign.
double Quantiser::turning_rate(const Motion& motion) {
  if (motion.jerk == 0) return motion.rate;
  const double time = -motion.acceleration / motion.jerk;
  if (!(time > 0 && time < motion.clocks)) return motion.rate;
  return motion.rate + motion.acceleration * time / 2;
}

void Quantiser::put(const Motion& motion, std::uint64_t end_tick, bool stop) {
  while (!moves(path_[timed_].block)) ++timed_;
  Piece& put = piece(last_++);
  put = Piece{};
  put.block = timed_;
  put.begin = tick_;
  put.stop = stop;
  put.clocks = motion.clocks;
  const double turning = turning_rate(motion);
  put.most = std::max({motion.rate, motion.end_rate, turning});
  driver::FeedCommand& command = put.command;
  command.ticks = end_tick - tick_;
  const bool one_rate = motion.clocks < kUpdate;
  const double lead = std::min(lead_, static_cast<double>(command.ticks) / 2);
  const double rate = one_rate ? (static_cast<double>(command.ticks) - lead) / motion.clocks
                               : motion.rate + kUpdate / 2 * motion.acceleration + kUpdate * kUpdate / 6 * motion.jerk;
  command.rate = fixed64(std::max(rate, kLeastRate));
  // In less than an update it comes to nothing; the motion's acceleration has no jump there all the same.
  command.acceleration = one_rate && !smooth_ ? 0 : signed64(kUpdate * (motion.acceleration + kUpdate * motion.jerk));
  command.jerk = one_rate ? 0 : signed64(kUpdate * kUpdate * motion.jerk);
  if (classes_ && path_[timed_].block.rapid) command.piece_class = driver::PieceClass::kRapid;
  // Smooth motion does not reach it before the piece is over.
  const double spare = smooth_ && !motion.rests && motion.jerk != 0
                           ? 4 * std::abs(kUpdate * (motion.acceleration + motion.clocks * motion.jerk))
                           : 0;
  command.floor = fixed32(std::min({motion.rate, motion.end_rate, turning, rate}) - spare);
  if (motion.rests && motion.jerk != 0) command.floor = fixed32(std::min(motion.end_rate, put.most));
  time_blocks(motion, lead, end_tick, stop);
  tick_ = pending_.end = end_tick;
  lead_ = overshoot(command, motion, lead);
  ahead_ = 0;
  end_rate_ = motion.end_rate;
}

// Ticks, and the part of one, that the card goes beyond the piece's last one before the next piece's rate is in force,
// when it began `lead` ticks into it: rate, acceleration and jerk as they are sent, update by update.
double Quantiser::overshoot(const driver::FeedCommand& piece, const Motion& motion, double lead) {
  constexpr double kUnit = 0x1p-64;
  const double rate = static_cast<double>(piece.rate) * kUnit;
  const double acceleration = static_cast<double>(piece.acceleration) * kUnit;
  const double jerk = static_cast<double>(piece.jerk) * kUnit;
  const double floor = static_cast<double>(piece.floor) * 0x1p-32;
  const double ticks = static_cast<double>(piece.ticks) - lead;
  const auto gone = [&](double clocks) {
    const double updates = std::floor(clocks / kUpdate);
    const double before = updates - 1;
    const double now = rate + updates * (acceleration + before / 2 * jerk);
    const double whole = updates * (rate + before / 2 * (acceleration + (updates - 2) / 3 * jerk));
    return kUpdate * whole + (clocks - kUpdate * updates) * std::max(now, floor);
  };
  // The first clock in which the last tick has come: from near it, then clock by clock.
  double clocks = std::floor(motion.clocks);
  for (int i = 0; i < 4; ++i) {
    const double step = std::floor((ticks - gone(clocks)) / motion.end_rate);
    if (step == 0) break;
    clocks = std::max(0.0, clocks + step);
  }
  for (int i = 0; i < 16 && clocks > 0 && gone(clocks - 1) >= ticks; ++i) --clocks;
  for (int i = 0; i < 16 && gone(clocks) < ticks; ++i) ++clocks;
  const double beyond = gone(clocks + kSwapClocks) - ticks;
  const double expected = kSwapClocks * motion.end_rate;
  return beyond >= 0 && beyond <= expected + 1 + motion.end_rate ? beyond : expected;
}

// Durations and speeds of the blocks that the piece from tick_ to `end_tick` covers; the first `lead` ticks pass at the
// rate of the piece before.
void Quantiser::time_blocks(const Motion& motion, double lead, std::uint64_t end_tick, bool stop) {
  const double swap = lead > 0 ? kSwapClocks : 0;
  const double ticks = static_cast<double>(end_tick - tick_);
  double before = -swap;
  block_rate_ = std::max(block_rate_, motion.rate);
  for (bool more = true; more;) {
    PathEntry& block = path_[timed_];
    block.short_sight = short_sight_ || (block_clocks_ != 0 && block.short_sight);
    const bool ends = block.end_ticks <= end_tick;
    const double share = ends ? static_cast<double>(block.end_ticks - tick_) : ticks;
    Instant at{motion.clocks, motion.end_rate};
    if (share <= lead) {
      at = {swap * (share / lead - 1), motion.rate};
    } else if (share < ticks) {
      at = instant(motion, share - lead, ticks - lead);
    }
    block_rate_ = std::max(block_rate_, at.rate);
    const double turning = motion.acceleration + before * motion.jerk > 0 ? turning_rate(motion) : 0;
    if (motion.acceleration + at.clocks * motion.jerk < 0) block_rate_ = std::max(block_rate_, turning);
    block_clocks_ += at.clocks - before;
    before = at.clocks;
    if (!ends) break;
    block.seconds = block_clocks_ / clock_hz_;
    block.speed = block_rate_ * clock_hz_ / block.density;
    block.end_speed = block.stop ? 0 : at.rate * clock_hz_ / block.density;
    block.timed = true;
    block_clocks_ = 0;
    block_rate_ = block.stop ? 0 : at.rate;
    more = share < ticks && !block.stop;
    ++timed_;
  }
  if (stop) block_rate_ = 0;
}

// Where `distance` of the motion's `ticks` are over.
Quantiser::Instant Quantiser::instant(const Motion& motion, double distance, double ticks) {
  const double time = time_at(distance, motion.rate, motion.acceleration, motion.jerk, motion.clocks, ticks);
  return {time, motion.rate + time * (motion.acceleration + time * motion.jerk / 2)};
}

bool Quantiser::ready() const {
  return path_[path_.begin()].timed && (completed_ == last_ || piece(completed_).block > path_.begin());
}

std::uint64_t Quantiser::count(std::uint64_t index) const {
  std::uint64_t next = first_;
  while (next != completed_ && piece(next).block == index) ++next;
  return next - first_;
}

bool Quantiser::take(std::uint64_t index, driver::FeedCommand& command) {
  if (first_ == completed_ || piece(first_).block != index) return false;
  command = piece(first_++).command;
  return true;
}

// Stop distances: a piece is complete when all is known that follows within T_s, or to the stop.
void Quantiser::complete() {
  while (completed_ != last_) {
    if (seen_ == completed_) see_next();
    while (seen_ != last_ && !piece(seen_ - 1).stop && seen_clocks_ < stop_clocks_) see_next();
    const bool known = piece(seen_ - 1).stop || seen_clocks_ >= stop_clocks_;
    if (!known && last_ - completed_ < kPieces / 2) return;
    complete_first();
  }
}

void Quantiser::force() {
  if (last_ - completed_ < 2) throw std::logic_error("the ring of blocks is full, and no piece is complete");
  complete_first();
}

void Quantiser::see_next() {
  const Piece& next = piece(seen_);
  while (highest_last_ != highest_first_ && piece(highest_[slot(highest_last_ - 1)]).most <= next.most) --highest_last_;
  highest_[slot(highest_last_++)] = seen_;
  seen_clocks_ = seen_ == completed_ ? 0 : seen_clocks_ + next.clocks;
  ++seen_;
}

// Ticks that are queued behind a piece's begin when queues are full; where less is known than fits, the rest is taken
// to be as long.
double Quantiser::reach(const Piece& first) {
  const std::uint64_t pieces = std::min(queues_.pieces, last_ - completed_);
  const Piece& last = piece(completed_ + pieces - 1);
  const double ticks = static_cast<double>(last.begin + last.command.ticks - first.begin);
  return std::min(path_reach(first), ticks * static_cast<double>(queues_.pieces) / static_cast<double>(pieces));
}

// By the paths. The commands of a block have equal ticks, and its pieces begin anywhere in it.
double Quantiser::path_reach(const Piece& first) {
  const auto fit = static_cast<double>(queues_.halfwords);
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
  const auto before = [](std::uint64_t at, std::uint64_t from) { return static_cast<double>(at - from); };
  const PathEntry& begin = path_[first.block];
  const double gone = share(before(first.begin, begin.begin_ticks), before(begin.end_ticks, begin.begin_ticks)) *
                      static_cast<double>(begin.halfwords);
  reached_ = std::max(reached_, first.block);
  while (reached_ + 1 != path_.end() && before(path_[reached_ + 1].queued, begin.queued) - gone < fit) ++reached_;
  const PathEntry& end = path_[reached_];
  const double known = std::min(fit, before(end.queued + end.halfwords, begin.queued) - gone);
  const double part = known - (before(end.queued, begin.queued) - gone);
  const double ticks = before(end.begin_ticks, begin.begin_ticks) - before(first.begin, begin.begin_ticks) +
                       part / static_cast<double>(end.halfwords) * before(end.end_ticks, end.begin_ticks);
  return ticks * fit / known;
}

// While a piece that begins in the block is in force, all up to the stop is queued: the pieces come before the only
// path. What follows may come in part; a stop distance beyond the stop would make the card hold until the rest is
// there.
bool Quantiser::ends_queued(const PathEntry& entry) {
  const Geometry geometry = entry.block.geometry;
  return entry.stop && (geometry == Geometry::kLine || geometry == Geometry::kArc ||
                        (geometry == Geometry::kArcChord && entry.block.parts == 1));
}

void Quantiser::complete_first() {
  Piece& first = piece(completed_);
  const std::uint64_t highest = highest_[slot(highest_first_)];
  const double rate = piece(highest).most;
  // At least 1: 0 says that the piece ends at rest.
  if (!first.stop) {
    double wanted = std::ceil(stop_clocks_ * rate);
    // A stop that begins in the piece goes on at its rates, and to the program's own stop at most.
    if (const Piece& last = piece(seen_ - 1); last.stop) {
      const std::uint64_t behind = last.begin + last.command.ticks - first.begin - first.command.ticks;
      wanted = std::min(wanted, std::ceil(stop_clocks_ * first.most) + static_cast<double>(behind));
    }
    wanted = std::min(wanted, reach(first) / kFillOfReach - kReserve);
    first.command.stop_distance = wanted > 1 && !ends_queued(path_[first.block]) ? ticks32(wanted) : 1;
  }
  if (highest == completed_) ++highest_first_;
  ++completed_;
  seen_clocks_ -= completed_ < seen_ ? piece(completed_).clocks : seen_clocks_;
}

}  // namespace trammel::planner
