// Lines by minimum deviation: the longest axis steps every time; each other axis steps if that brings it nearer to
// the line, so it stays within half a pulse of the line. In a plane these are 8 directions. Units: pulses. No errors
// are reported; not thread-safe.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/interpolation/curve.hpp"
#include "trammel/interpolation/step_lines.hpp"

namespace trammel::interpolation {

// Two axes. F = |dx|*y - |dy|*x; |F| <= max(|dx|, |dy|) / 2 between steps, |2F + ...| < 2^32.
class MinDeviationLine {
 public:
  explicit MinDeviationLine(const Line& line)
      : walk_(line), x_longer_(walk_.length_x() >= walk_.length_y()), left_(longest()) {}

  bool done() const { return left_ == 0; }
  // Not to be called when done.
  Step next() {
    // The other axis steps too when it lags by half a pulse or more.
    const std::int64_t shorter = x_longer_ ? walk_.length_y() : walk_.length_x();
    lag_ += shorter;
    const bool both = 2 * lag_ >= longest() && shorter != 0;
    lag_ -= -static_cast<std::int64_t>(both) & longest();
    others_ += both;
    --left_;
    const auto step_x = static_cast<std::int8_t>(x_longer_ || both ? walk_.sign_x() : 0);
    const auto step_y = static_cast<std::int8_t>(!x_longer_ || both ? walk_.sign_y() : 0);
    return {{step_x, step_y, 0, 0}};
  }
  Position position() const {
    const std::int64_t made = longest() - left_;
    return x_longer_ ? walk_.at(made, others_) : walk_.at(others_, made);
  }
  // Except for the sign, the lag of the shorter axis is the deviation.
  Deviation deviation() const { return x_longer_ ? -lag_ : lag_; }
  // Unit: steps.
  std::uint64_t time() const { return static_cast<std::uint64_t>(longest() - left_); }
  std::uint64_t total_time() const { return static_cast<std::uint64_t>(longest()); }

 private:
  std::int64_t longest() const { return x_longer_ ? walk_.length_x() : walk_.length_y(); }

  PlaneWalk walk_;
  bool x_longer_;
  std::int64_t left_;
  std::int64_t lag_ = 0;     // pulses * longest()
  std::int64_t others_ = 0;  // steps made by the shorter axis
};

// 2 to 4 axes; there is no single F.
class MinDeviationSpaceLine {
 public:
  explicit MinDeviationSpaceLine(const Line& line) : axes_(line.axes), position_(line.start) {
    for (unsigned a = 0; a < axes_; ++a) {
      const std::int64_t displacement = line.end[a] - line.start[a];
      sign_[a] = displacement < 0 ? std::int8_t{-1} : std::int8_t{1};
      length_[a] = sign_[a] * displacement;
      if (length_[a] > longest_) longest_ = length_[a];
    }
  }

  bool done() const { return made_ == longest_; }
  // Not to be called when done.
  Step next() {
    Step step;
    for (unsigned a = 0; a < axes_; ++a) {
      lag_[a] += length_[a];
      if (length_[a] == 0 || 2 * lag_[a] < longest_) continue;
      lag_[a] -= longest_;
      step.direction[a] = sign_[a];
      position_[a] += sign_[a];
    }
    ++made_;
    return step;
  }
  const Position& position() const { return position_; }
  // Unit: steps.
  std::uint64_t time() const { return static_cast<std::uint64_t>(made_); }
  std::uint64_t total_time() const { return static_cast<std::uint64_t>(longest_); }

 private:
  unsigned axes_;
  Position position_;
  std::array<std::int64_t, kMaxAxes> length_{};
  std::array<std::int64_t, kMaxAxes> lag_{};  // pulses * longest_
  std::array<std::int8_t, kMaxAxes> sign_{};
  std::int64_t longest_ = 0;
  std::int64_t made_ = 0;
};

}  // namespace trammel::interpolation
