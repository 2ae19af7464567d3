// Computes the motion of feed pieces from parts of the speed plan's phases. One class is for trapezoid plans, whose
// acceleration may jump, one for S-curves. Internal to the planner.
#pragma once

#include <cstdint>

#include "feed_motion.hpp"
#include "tick_scale.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

// Ticks of the next piece that pass at the rate of the piece before, because the card continues at that rate for some
// clocks.
struct Lead {
  double ticks = 0;
  double ahead = 0;  // of these, the ticks by which the motion is ahead of its speed profile

  // The part of the lead that falls into a piece of this many ticks: at most half of them, so that the rest can have
  // the piece's own rate.
  double within(double piece_ticks) const { return ticks < piece_ticks / 2 ? ticks : piece_ticks / 2; }
};

// The part of a phase in one stretch of equal density of ticks. Places are in mm from the phase's beginning. The ends
// of the ticks may lie outside the phase by a fraction of a tick, or by the ticks that a block has in excess of its
// length.
struct PhasePart {
  double from = 0;  // beginning of the first tick
  double to = 0;    // end of the last tick
  double end = 0;   // end of the part in the plan
  std::uint64_t ticks = 0;
  bool stop = false;     // the program stops at its end
  bool turns = false;    // the phase begins at rest: at a stop without a wait, or in mid path
  bool through = false;  // the phase continues after the part
};

// Successive phases, each too short for a piece of its own.
struct Pending {
  std::uint64_t end = 0;    // tick; without such phases: the end of the last piece
  FeedMotion motion;        // its acceleration and jerk are not used
  double acceleration = 0;  // of the last phase, mm/s^2
};

class PieceShaper {
 public:
  virtual ~PieceShaper() = default;

  // Call before the first part after a stop.
  virtual void start(const TickScale& scale) = 0;
  // `ahead`: Lead::ahead in ticks of the new scale.
  virtual void change_density(const TickScale& scale, double ahead) = 0;
  // Whether the end of a phase at a block's border is the tick of the border.
  virtual bool ends_at_corner(const Phase& phase) const = 0;
  // The end tick of a phase that ends at `exact` in the plan, from the same origin. The caller rounds it down.
  virtual double end_tick(const Phase& phase, double exact) const = 0;
  // Whether the pending phases get no piece and are left to the piece that begins with the next part.
  virtual bool drops(const Pending& pending) const = 0;
  // Call once per part, in order, even without ticks. `late`: ticks by which the part ends after its end in the plan.
  virtual void advance(const Phase& phase, const PhasePart& part, double late) = 0;
  // The motion of the last part, which must have ticks, after the first `lead` of them.
  virtual FeedMotion motion(const Phase& phase, const PhasePart& part, double lead, double ahead) const = 0;
  // The rate at which pending phases begin, if this part, with `motion`, is the first of them.
  virtual double pending_rate(const Phase& phase, const PhasePart& part, const FeedMotion& motion) const = 0;
  // Whether one piece for both would have more acceleration than it may.
  virtual bool keeps_apart(const Pending& pending, const Phase& phase) const = 0;
  // The pending phases as one piece of `ticks`.
  virtual FeedMotion joined(const Pending& pending, double ticks, const Lead& lead) const = 0;
};

}  // namespace trammel::planner
