// From parts of the speed plan's phases to the motion of feed pieces: one class for speeds whose acceleration may jump,
// one for S-curves. Internal to the planner.
#pragma once

#include <cstdint>

#include "feed_motion.hpp"
#include "tick_scale.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

// Ticks of the next piece that pass at the rate of the one before: the card goes on at it for some clocks.
struct Lead {
  double ticks = 0;
  double ahead = 0;  // of these, those for which the speed's time does not pass

  // What of it falls into a piece of so many ticks: half of them at most, so that the rest can have the piece's rate.
  double within(double piece_ticks) const { return ticks < piece_ticks / 2 ? ticks : piece_ticks / 2; }
};

// Of a phase, what lies in one stretch of equal ticks. Places in mm from the phase's begin; the ticks' ends may lie a
// part of a tick outside the phase, and one block's ticks too many.
struct PhasePart {
  double from = 0;  // of the first tick
  double to = 0;    // of the last tick's end
  double end = 0;   // as the plan has it
  std::uint64_t ticks = 0;
  bool stop = false;     // the program stops at its end
  bool turns = false;    // the phase begins at a stop that nothing waits at, or at rest in mid path
  bool through = false;  // the phase goes on behind
};

// Phases too short for a piece each.
struct Pending {
  std::uint64_t end = 0;    // tick; where there are none: that of the piece before
  FeedMotion motion;        // its acceleration and jerk are not used
  double acceleration = 0;  // of the last phase, mm/s^2
};

class PieceShaper {
 public:
  virtual ~PieceShaper() = default;

  // Before the first part behind a stop.
  virtual void start(const TickScale& scale) = 0;
  // `ahead`: Lead::ahead in ticks of the new scale.
  virtual void change_density(const TickScale& scale, double ahead) = 0;
  // Whether a phase that ends or begins with a block does so at the block's tick.
  virtual bool ends_at_corner(const Phase& phase) const = 0;
  // Ticks from the same place as `exact`, where a phase ends that the plan ends at `exact`; rounded down by the caller.
  virtual double end_tick(const Phase& phase, double exact) const = 0;
  // Whether the pending phases are left to the piece that begins with this part.
  virtual bool drops(const Pending& pending) const = 0;
  // Each part once, in order, also one without ticks; `late`: ticks by which it ends behind the plan.
  virtual void advance(const Phase& phase, const PhasePart& part, double late) = 0;
  // Of the last part, which has ticks, behind `lead` of these.
  virtual FeedMotion motion(const Phase& phase, const PhasePart& part, double lead, double ahead) const = 0;
  // The rate with which pending phases begin, of which the part with `motion` is the first.
  virtual double pending_rate(const Phase& phase, const PhasePart& part, const FeedMotion& motion) const = 0;
  // Whether one piece for both would have more acceleration than it may.
  virtual bool keeps_apart(const Pending& pending, const Phase& phase) const = 0;
  // The pending phases as one piece of `ticks`.
  virtual FeedMotion joined(const Pending& pending, double ticks, const Lead& lead) const = 0;
};

}  // namespace trammel::planner
