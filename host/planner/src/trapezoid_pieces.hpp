// The motion of feed pieces in trapezoid plans, whose acceleration may jump. Internal to the planner.
#pragma once

#include "piece_shaper.hpp"
#include "tick_fit.hpp"

namespace trammel::planner {

class TrapezoidPieces final : public PieceShaper {
 public:
  explicit TrapezoidPieces(double clock_hz) : fit_(clock_hz) {}

  void start(const TickScale& scale) override;
  void change_density(const TickScale& scale, double ahead) override;
  bool ends_at_corner(const Phase& phase) const override { return phase.acceleration < 0 && phase.next > 0; }
  double end_tick(const Phase& phase, double exact) const override { return fit_.end_tick(phase, exact); }
  bool drops(const Pending& /*pending*/) const override { return false; }
  void advance(const Phase& phase, const PhasePart& part, double late) override;
  FeedMotion motion(const Phase& phase, const PhasePart& part, double lead, double ahead) const override;
  double pending_rate(const Phase& phase, const PhasePart& part, const FeedMotion& motion) const override;
  bool keeps_apart(const Pending& pending, const Phase& phase) const override;
  FeedMotion joined(const Pending& pending, double ticks, const Lead& lead) const override;

 private:
  TickFit fit_;
  TickScale scale_;
};

}  // namespace trammel::planner
