// The motion of feed pieces in S-curve plans, whose acceleration has no jumps. Internal to the planner.
#pragma once

#include "piece_shaper.hpp"

namespace trammel::planner {

class SCurvePieces final : public PieceShaper {
 public:
  void start(const TickScale& scale) override { scale_ = scale; }
  void change_density(const TickScale& scale, double /*ahead*/) override { scale_ = scale; }
  bool ends_at_corner(const Phase& /*phase*/) const override { return true; }
  double end_tick(const Phase& phase, double exact) const override;
  bool drops(const Pending& pending) const override;
  void advance(const Phase& /*phase*/, const PhasePart& /*part*/, double /*late*/) override {}
  FeedMotion motion(const Phase& phase, const PhasePart& part, double lead, double ahead) const override;
  // In smooth motion this is the rate after the lead.
  double pending_rate(const Phase& /*phase*/, const PhasePart& /*part*/, const FeedMotion& motion) const override {
    return motion.rate;
  }
  bool keeps_apart(const Pending& /*pending*/, const Phase& /*phase*/) const override { return false; }
  FeedMotion joined(const Pending& pending, double ticks, const Lead& lead) const override;

 private:
  FeedMotion even(const Phase& phase, double from, double to, double ticks) const;
  FeedMotion bent(const Phase& phase, const PhasePart& part, double from, double ticks) const;

  TickScale scale_;
};

}  // namespace trammel::planner
