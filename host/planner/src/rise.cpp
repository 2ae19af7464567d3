#include "rise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "span_acceleration.hpp"

namespace trammel::planner {
namespace {

constexpr double kAnySpeed = std::numeric_limits<double>::infinity();

void put(std::vector<Phase>& phases, const Phase& phase) {
  if (phase.length > 0 && phase.duration > 0) phases.push_back(phase);
}

}  // namespace

Rise::Rise(std::size_t spans) {
  stretches_.reserve(spans);
  parts_.reserve(4 * spans + 4);
  bend_.reserve(spans + 1);
}

Rise::State Rise::Part::at(double time) const {
  const double end = time < duration ? from.acceleration + (to - from.acceleration) * (time / duration) : to;
  const double speed = from.speed + (from.acceleration + end) / 2 * time;
  const double length = (from.speed + (2 * from.acceleration + end) / 6 * time) * time;
  return {from.place + length, from.time + time, speed, end};
}

// Time at which the part has covered `length`, which is at most its own.
double Rise::Part::time_at(double length) const {
  return rising_time(length, from.speed, from.acceleration, (to - from.acceleration) / duration, duration);
}

// Time at which the part reaches `speed`, which is at most that at its end.
double Rise::Part::time_to(double speed) const {
  const double gain = std::max(0.0, speed - from.speed);
  const double twice = 2 * (to - from.acceleration) / duration;
  const double reached = std::sqrt(std::max(0.0, from.acceleration * from.acceleration + twice * gain));
  return 2 * gain / (from.acceleration + reached);
}

void Rise::Part::shorten(double time) {
  to = at(time).acceleration;
  duration = time;
}

double Rise::plan(SpeedWindow::Walk walk, double low, double high) {
  stretches_.clear();
  parts_.clear();
  start_ = {0, 0, low, 0};
  arrival_ = 0;
  if (!(high > low * kSameSpeed)) return 0;
  do {
    const State now = end();
    SpeedWindow::Stretch next = walk.next(now.speed, now.time);
    const double rise = next.limits.acceleration / next.limits.jerk;
    if (walk.ended()) next.end = std::max(next.end, now.place) + high * (high / next.limits.acceleration + 3 * rise);
    if (stretches_.empty() && next.arc == nullptr && ramp_length(low, high, next.limits) <= next.end) {
      lone(low, high, next.limits);
      return end().place;
    }
    if (next.arc != nullptr) {
      climb_arc(next);
    } else {
      enter(next);
      climb(kAnySpeed);
    }
  } while (!arrive(high, walk.ended()));
  return end().place;
}

// A ramp with the same limits all along.
void Rise::lone(double low, double high, const RampLimits& limits) {
  const double rise = limits.acceleration / limits.jerk;
  const double change = high - low;
  const bool full = change >= limits.acceleration * rise;
  const double bend = full ? rise : std::sqrt(change / limits.jerk);
  const double most = full ? limits.acceleration : change / bend;
  const double steady = full ? change / limits.acceleration - rise : 0;
  parts_.push_back({start_, bend, most, 0});
  parts_.push_back({end(), steady, most, 0});
  parts_.push_back({end(), bend, 0, 0});
}

// Accelerates as the last stretch allows, to its end or to the speed `top`.
void Rise::climb(double top) {
  const SpeedWindow::Stretch& stretch = stretches_.back();
  const std::size_t index = stretches_.size() - 1;
  State now = end();
  const double most = stretch.limits.acceleration;
  if (now.acceleration < most && now.place < stretch.end) {
    Part part{now, (most - now.acceleration) / stretch.limits.jerk, most, index};
    if (part.end().speed > top) part.shorten(part.time_to(top));
    if (part.end().place > stretch.end) part.shorten(part.time_at(stretch.end - now.place));
    parts_.push_back(part);
    now = end();
  }
  if (now.place >= stretch.end || now.speed >= top || now.acceleration < most) return;
  const double length = std::min(stretch.end - now.place, (top * top - now.speed * now.speed) / (2 * most));
  const double speed = std::sqrt(now.speed * now.speed + 2 * most * length);
  parts_.push_back({now, 2 * length / (now.speed + speed), most, index});
}

// Climbs in steps of speed, each with the acceleration and the jerk that are left at its highest speed.
void Rise::climb_arc(SpeedWindow::Stretch arc) {
  const SpanAcceleration acceleration(*arc.arc);
  bool entered = false;
  for (int i = 0; i < acceleration.steps(); ++i) {
    const State now = end();
    const bool last = i + 1 == acceleration.steps();
    const double top = last ? kAnySpeed : std::sqrt(acceleration.top(i));
    if (now.speed >= top) continue;
    if (entered && now.place >= arc.end) return;
    arc.limits = {acceleration.acceleration(i), std::min(acceleration.jerk(i), arc.jerk_beside)};
    arc.top = top;
    if (!entered) {
      enter(arc);
    } else {
      if (now.acceleration > arc.limits.acceleration) relax(arc.limits.acceleration, now.speed);
      stretches_.push_back(arc);
    }
    entered = true;
    climb(top);
  }
}

// Adds a stretch. At its beginning its limit of acceleration must hold already.
void Rise::enter(const SpeedWindow::Stretch& next) {
  const double most = next.limits.acceleration;
  if (end().acceleration > most) {
    turn(last_place([&](const Place& place) { return fall(place, most, true).acceleration - most; }), most, true);
  }
  stretches_.push_back(next);
}

// Lowers the acceleration to `most` by the time that `speed` is reached, unless the last stretch ends before.
void Rise::relax(double most, double speed) {
  Place place;
  if (!relaxes_in_stretch(most, speed, place)) {
    place = last_place([&](const Place& from) { return fall(from, most, true).speed - speed; });
  }
  turn(place, most, true);
}

// The place at which the acceleration must begin to fall, if it and the end of the fall are in the last stretch. At
// constant jerk the square of the acceleration is linear in the speed, so no search is needed.
bool Rise::relaxes_in_stretch(double most, double speed, Place& place) const {
  const std::size_t last = stretches_.size() - 1;
  const double jerk = stretches_[last].limits.jerk;
  for (std::size_t i = parts_.size(); i-- > 0 && parts_[i].stretch == last;) {
    const Part& part = parts_[i];
    const double left = speed - part.from.speed;
    const double room = most * most + 2 * jerk * left - part.from.acceleration * part.from.acceleration;
    if (room < 0 || !(part.duration > 0)) continue;
    const double own = (part.to - part.from.acceleration) / part.duration;
    const double time = part.time_to(part.from.speed + room / (2 * (jerk + own)));
    place = {i, std::min(time, part.duration)};
    return fall(place, most, false).place <= stretches_[last].end;
  }
  return false;
}

// Ends the rise at the speed `high`, if this is possible within the stretches; `anywhere`: also after them.
bool Rise::arrive(double high, bool anywhere) {
  const State last = end();
  if (!anywhere && (last.speed < high || last.place < arrival_)) return false;
  const Place place = last_place([&](const Place& from) { return fall(from, 0, false).speed - high; });
  arrival_ = fall(place, 0, false).place;
  if (!anywhere && arrival_ > last.place) return false;
  turn(place, 0, false);
  return true;
}

// The last place at which `excess` is not above 0; it rises along the way.
template <typename Excess>
Rise::Place Rise::last_place(Excess excess) const {
  std::size_t above = parts_.size();  // `excess` is above 0 where this part and all later ones begin
  std::size_t part = above - 1;
  for (std::size_t step = 1; part > 0 && excess({part, 0}) > 0; step *= 2) {
    above = part;
    part -= std::min(step, part);
  }
  while (above - part > 1) {
    const std::size_t middle = part + (above - part) / 2;
    (excess({middle, 0}) > 0 ? above : part) = middle;
  }
  return {part, highest(0, parts_[part].duration, [&](double time) { return excess({part, time}); })};
}

// Lowers the acceleration to `to`, from the place on. `bounded`: to the end of the last stretch at most.
Rise::State Rise::fall(const Place& place, double to, bool bounded, std::vector<Part>* parts) const {
  State now = parts_[place.part].at(place.time);
  for (std::size_t i = parts_[place.part].stretch; now.acceleration > to; ++i) {
    while (i + 1 < stretches_.size() && stretches_[i + 1].limits.jerk == stretches_[i].limits.jerk) ++i;
    const SpeedWindow::Stretch& stretch = stretches_[i];
    const bool last = i + 1 == stretches_.size();
    Part part{now, (now.acceleration - to) / stretch.limits.jerk, to, i};
    const bool crosses = part.end().place > stretch.end && (bounded || !last);
    if (crosses) {
      const double left = stretch.end - now.place;
      part.shorten(left > 0 ? part.time_at(left) : 0);
    }
    // On an arc, the jerk of the next step holds from that step's speed on.
    const bool rises = !last && stretches_[i + 1].arc == stretch.arc && part.end().speed > stretch.top;
    if (rises) part.shorten(part.time_to(stretch.top));
    if (parts != nullptr) parts->push_back(part);
    now = part.end();
    if (!(crosses || rises) || last) break;
  }
  return now;
}

void Rise::turn(const Place& place, double to, bool bounded) {
  bend_.clear();
  fall(place, to, bounded, &bend_);
  Part& part = parts_[place.part];
  part.to = part.at(place.time).acceleration;
  part.duration = place.time;
  parts_.resize(place.part + 1);
  parts_.insert(parts_.end(), bend_.begin(), bend_.end());
}

void Rise::rising(std::vector<Phase>& phases) const {
  for (const Part& part : parts_) {
    const double jerk = (part.to - part.from.acceleration) / part.duration;
    put(phases, {part.end().place - part.from.place, part.duration, part.from.speed, part.from.acceleration, jerk});
  }
}

void Rise::falling(std::vector<Phase>& phases) const {
  for (std::size_t i = parts_.size(); i-- > 0;) {
    const Part& part = parts_[i];
    const State end = part.end();
    const double jerk = (part.to - part.from.acceleration) / part.duration;
    put(phases, {end.place - part.from.place, part.duration, end.speed, -part.to, jerk});
  }
}

}  // namespace trammel::planner
