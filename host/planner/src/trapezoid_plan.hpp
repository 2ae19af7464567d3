// The speed plan whose acceleration may jump: as fast as every span and corner allows with the acceleration of each
// span, over a view of `window` spans. When the window is full, it makes a backward pass over v^2, and a forward pass
// over the first sixteenth, which then leaves the window. Internal to the planner.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "span_acceleration.hpp"
#include "trammel/planner/speed_plan.hpp"

namespace trammel::planner {

class TrapezoidPlan final : public SpeedPlan {
 public:
  explicit TrapezoidPlan(std::size_t window);

  bool full() const override { return count_ == nodes_.size() || due_ != 0 || given_ != made_; }
  void push(const Span& span) override;
  void finish() override;
  bool next(Phase& phase) override;

 private:
  // Squares of speeds.
  struct Node {
    double length;
    SpanAcceleration acceleration;
    double top;
    double exit;    // the most at its end
    double entry;   // the most at its start that keeps all later limits; below 0: not known yet
    bool in_sight;  // `entry` does not depend on the window's end
  };
  Node& node(std::size_t i) { return nodes_[(first_ + i) % nodes_.size()]; }
  void look_back();
  void plan_first();
  struct Part {
    double length;
    double from;
    double to;
    double acceleration;
  };
  void add_span(const Node& at, double end, bool in_sight);
  void add(const Part& part, bool in_sight);
  void give_pending(double next_acceleration);

  std::vector<Node> nodes_;
  std::size_t chunk_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  std::size_t due_ = 0;  // spans whose phases must be taken before the next push
  bool finished_ = false;
  double speed_ = 0;  // square, at the beginning of the first span
  Phase pending_;     // may continue in the next span
  // Of one span: the ramp up, then the ramp down in reverse order.
  std::array<Part, 2 * SpanAcceleration::kMaxSteps> parts_{};
  std::size_t count_parts_ = 0;
  std::array<Phase, 2 * SpanAcceleration::kMaxSteps + 2> phases_;
  std::size_t made_ = 0;  // number of valid phases_
  std::size_t given_ = 0;
};

}  // namespace trammel::planner
