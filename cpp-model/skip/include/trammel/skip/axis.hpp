// Adaptors of an axis and its two parts. PulsesAhead passes many ticks of the pulse generator at once. See
// horizon.hpp.
#pragma once

#include <algorithm>
#include <cstdint>

#include "trammel/model/axis.hpp"
#include "trammel/model/wait_timer.hpp"
#include "trammel/model/wide.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

class PulsesAhead {
 public:
  explicit PulsesAhead(model::PulseGenerator& block) : s_(block.state()) {}

  // Passes n ticks that make no step, n <= silent_ticks(); only when at_rest().
  void silent_ticks(std::uint64_t n) {
    const auto sum = static_cast<std::uint64_t>(s_.phase) + n * static_cast<std::uint64_t>(s_.increment);
    s_.phase = static_cast<std::int64_t>(sum & static_cast<std::uint64_t>(model::PulseGenerator::kMask));
  }

  // Passes the tick after silent_ticks() silent ones; true if its step is backwards. The step is not put in flight.
  bool step_at_once() {
    s_.phase += s_.increment;
    const bool backwards = s_.phase < 0;
    s_.phase &= model::PulseGenerator::kMask;
    return backwards;
  }

  // Places the step of a tick taken `clocks_ago` clocks ago (0: in the last one) in flight; only the outputs change.
  void place_step(std::uint64_t clocks_ago, bool backwards) {
    const unsigned event =
        backwards ? model::PulseGenerator::kStep | model::PulseGenerator::kBackwards : model::PulseGenerator::kStep;
    if (clocks_ago == 0) s_.pipe |= event << 4;
    if (clocks_ago == 1) s_.pipe |= event;
    if (clocks_ago == 2) s_.out.step = true;
    if (clocks_ago >= 2) s_.out.dir = backwards;
  }

  // The number of ticks in a row that would make no step; UINT64_MAX if none ever would.
  std::uint64_t silent_ticks() const {
    if (!s_.open || s_.increment == 0) return UINT64_MAX;
    if (s_.increment > 0) return static_cast<std::uint64_t>((model::PulseGenerator::kMask - s_.phase) / s_.increment);
    return static_cast<std::uint64_t>(s_.phase / -s_.increment);
  }

  // Ticks up to and including the one that makes the `steps`-th step from now; UINT64_MAX if there is none, or if it
  // is too far away. Only for increments that are not negative (a prescaler's).
  std::uint64_t ticks_until(std::uint64_t steps) const {
    constexpr unsigned kFirst = 24;
    if (!s_.open || s_.increment <= 0 || steps >> model::PulseGenerator::kFractionBits != 0) return UINT64_MAX;
    // ceil((steps * 2^40 - phase) / increment), the quotient in two parts.
    const auto by = static_cast<std::uint64_t>(s_.increment);
    const std::uint64_t first = (steps << kFirst) / by;
    const std::uint64_t rest = (steps << kFirst) % by << (model::PulseGenerator::kFractionBits - kFirst);
    if (first >> 46 != 0) return UINT64_MAX;
    const std::int64_t last = static_cast<std::int64_t>(rest % by) - s_.phase;
    const std::int64_t more = last > 0 ? 1 : -(-last / s_.increment);
    return (first << (model::PulseGenerator::kFractionBits - kFirst)) + rest / by + static_cast<std::uint64_t>(more);
  }

  // Passes n ticks; returns the number of their steps. None of the steps is put in flight.
  std::uint64_t pass(std::uint64_t n) {
    const model::uint128 sum = model::uint128{n} * model::uint128{static_cast<std::uint64_t>(s_.increment)} +
                               model::uint128{static_cast<std::uint64_t>(s_.phase)};
    s_.phase = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum) &
                                         static_cast<std::uint64_t>(model::PulseGenerator::kMask));
    return static_cast<std::uint64_t>(sum >> model::PulseGenerator::kFractionBits);
  }

  // True if the increment is at most one pulse per tick, in either direction; otherwise ticks must be clocked one by
  // one.
  bool within_a_pulse() const {
    return s_.increment <= model::PulseGenerator::kMask + 1 && s_.increment >= -model::PulseGenerator::kMask - 1;
  }

 private:
  model::PulseGenerator::State& s_;
};

// True if no step is in flight.
inline bool at_rest(const model::PulseGenerator& block) { return block.state().pipe == 0 && !block.state().out.step; }

// With `tick` every clock is a tick: the horizon ends before the tick that makes a step.
inline std::uint64_t horizon(const model::PulseGenerator& block, const model::PulseGenerator::Inputs& in) {
  if (!at_rest(block) || in.clear || in.swap || in.chord || in.load_increment || in.load_count) return 0;
  if (!in.tick) return kForever;
  auto copy = block;
  const PulsesAhead ahead(copy);
  return ahead.within_a_pulse() && block.state().open ? ahead.silent_ticks() : 0;
}
inline void advance(model::PulseGenerator& block, const model::PulseGenerator::Inputs& in, std::uint64_t clocks) {
  if (in.tick) PulsesAhead(block).silent_ticks(clocks);
}

// True if no step waits and no pulse is about to begin. Without a new step the position stays and no fault can come.
inline bool no_step_waits(const model::StepShaper& block) {
  const model::StepShaper::State& s = block.state();
  return s.waiting == 0 && s.lead == 0 && !s.waited && !s.out.fault;
}

inline std::uint64_t horizon(const model::StepShaper& block, const model::StepShaper::Inputs& in) {
  const model::StepShaper::State& s = block.state();
  if (in.step || in.mode != s.mode) return 0;
  if (!s.out.busy) return kForever;
  using Phase = model::StepShaper::Phase;
  if (s.out.fault || s.lead != 0 || s.waiting != 0 || s.phase == Phase::kSetup) return 0;
  // A clock that begins with left == 0 shows the next phase. A pulse of length 0 shows in the first clock of its
  // space.
  return s.pulse == (s.phase == Phase::kHigh) ? s.left : 0;
}
inline void advance(model::StepShaper& block, const model::StepShaper::Inputs&, std::uint64_t clocks) {
  model::StepShaper::State& s = block.state();
  if (s.out.busy) s.left -= static_cast<std::uint32_t>(clocks);
}
// Passes this many clocks, one horizon after the other; only without a step and while no_step_waits().
inline void pass(model::StepShaper& block, const model::StepShaper::Inputs& in, std::uint64_t clocks) {
  while (clocks != 0) {
    const std::uint64_t some = std::min(clocks, horizon(block, in));
    if (some == 0)
      block.clock(in);
    else
      advance(block, in, some);
    clocks -= some == 0 ? 1 : some;
  }
}

inline std::uint64_t horizon(const model::Axis& axis, const model::Axis::Inputs& in) {
  const model::Axis::State& s = axis.state();
  if (in.cut || in.tick || in.swap || in.engine_step || in.load.valid || in.chord_load || in.chord_swap ||
      in.setting.set || s.path_step || !at_rest(s.generator))
    return 0;
  model::StepShaper::Inputs shaper = s.times;
  shaper.wait_tick = in.wait_tick;
  return horizon(s.shaper, shaper);
}
inline void advance(model::Axis& axis, const model::Axis::Inputs&, std::uint64_t clocks) {
  advance(axis.state().shaper, axis.state().times, clocks);
}

// Ends before the next tick. If a limit was lowered below the count, clock() corrects that.
inline std::uint64_t horizon(const model::WaitTimer& timer, const model::Setting& in) {
  const model::WaitTimer::State& s = timer.state();
  if (in.set || s.tick || s.count + 1 >= s.limit) return 0;
  return s.limit - 1 - s.count;
}
inline void advance(model::WaitTimer& timer, const model::Setting&, std::uint64_t clocks) {
  timer.state().count += static_cast<std::uint32_t>(clocks);
}
// Any number of clocks without a setting, ticks included.
inline void pass(model::WaitTimer& timer, std::uint64_t clocks) {
  if (clocks == 0) return;
  timer.clock({});  // handles a limit that was lowered below the count
  if (clocks == 1) return;
  model::WaitTimer::State& s = timer.state();
  s.count = static_cast<std::uint32_t>((s.count + (clocks - 1)) % s.limit);
  s.tick = s.count == 0;
}

}  // namespace trammel::skip
