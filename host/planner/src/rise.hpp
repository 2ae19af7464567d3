// The fastest rise of the speed along stretches with different limits: as much acceleration as each stretch allows,
// changed by its jerk at most, and none at either end. Along a backward walk it is the fastest fall. Uses + - * / and
// sqrt only: the same on every host. Internal to the planner.
#pragma once

#include <cstddef>
#include <vector>

#include "speed_window.hpp"

namespace trammel::planner {

class Rise {
 public:
  // Two speeds up to this ratio are the same, and the way between them has no length. A speed is only known up to
  // rounding, and the length of a short ramp is proportional to the square root of the difference. For two speeds that
  // differ by an ulp, the length would be rounding alone: still 200 nm at 100 mm/s and 30,000 mm/s^3.
  static constexpr double kSameSpeed = 1 + 0x1p-30;

  explicit Rise(std::size_t spans);

  // Plans from `low` to `high` along the walk and returns the length. The limits of the last span continue after its
  // end.
  double plan(SpeedWindow::Walk walk, double low, double high);
  // Appends the phases of the last plan, if its walk was forward.
  void rising(std::vector<Phase>& phases) const;
  // Appends them if its walk was backward.
  void falling(std::vector<Phase>& phases) const;

 private:
  struct State {
    double place = 0;
    double time = 0;
    double speed = 0;
    double acceleration = 0;  // not below 0
  };
  // A part with constant jerk.
  struct Part {
    State from;
    double duration = 0;
    double to = 0;  // acceleration at the end
    std::size_t stretch = 0;

    State at(double time) const;
    State end() const { return at(duration); }
    double time_at(double length) const;
    double time_to(double speed) const;
    void shorten(double time);
  };
  struct Place {
    std::size_t part = 0;
    double time = 0;
  };

  State end() const { return parts_.empty() ? start_ : parts_.back().end(); }
  void climb(double top);
  void climb_arc(SpeedWindow::Stretch arc);
  void enter(const SpeedWindow::Stretch& next);
  void relax(double most, double speed);
  bool relaxes_in_stretch(double most, double speed, Place& place) const;
  bool arrive(double high, bool anywhere);
  void lone(double low, double high, const RampLimits& limits);
  State fall(const Place& place, double to, bool bounded, std::vector<Part>* parts = nullptr) const;
  template <typename Excess>
  Place last_place(Excess excess) const;
  void turn(const Place& place, double to, bool bounded);

  std::vector<SpeedWindow::Stretch> stretches_;
  std::vector<Part> parts_;
  std::vector<Part> bend_;
  State start_;
  double arrival_ = 0;  // arrive() need not try again before this place
};

}  // namespace trammel::planner
