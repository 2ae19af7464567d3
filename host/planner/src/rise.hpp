// The quickest rise of the speed along stretches whose limits change: as much acceleration as each has, changed by its
// jerk at most, and none at either end. The way backwards it is the quickest fall. + - * / and sqrt: the same on every
// host. Internal to the planner.
#pragma once

#include <cstddef>
#include <vector>

#include "speed_window.hpp"

namespace trammel::planner {

class Rise {
 public:
  // Up to this ratio two speeds are the same, and the way between them has no length. A speed is only known to its
  // rounding, and the length of a short ramp goes with the square root of the difference: of two speeds that differ by
  // an ulp it would be rounding alone, at 100 mm/s and 30,000 mm/s^3 yet 200 nm.
  static constexpr double kSameSpeed = 1 + 0x1p-30;

  explicit Rise(std::size_t spans);

  // From `low` to `high` on the way, seen from its beginning; the last span's limits go on behind its end. Its length.
  double plan(SpeedWindow::Walk walk, double low, double high);
  // Of the last one, which was the way forwards: puts its phases behind others.
  void rising(std::vector<Phase>& phases) const;
  // The same where it was the way backwards.
  void falling(std::vector<Phase>& phases) const;

 private:
  struct State {
    double place = 0;
    double time = 0;
    double speed = 0;
    double acceleration = 0;  // not below 0
  };
  // The acceleration changes evenly.
  struct Part {
    State from;
    double duration = 0;
    double to = 0;  // acceleration
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
  double arrival_ = 0;  // not tried again before there
};

}  // namespace trammel::planner
