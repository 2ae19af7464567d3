// Circles, ellipses and their arcs from the deviation F = A x^2 + B y^2 - N, with x and y relative to the centre.
// Circle: A = B = 1, N = radius^2. Ellipse: A = b^2, B = a^2, N = a^2 b^2. With GX = 2 A x, a step of s in x adds
// s*GX + A to F, and 2 A s to GX; the same holds for y. So steps need additions only. Source: Goldberg & Goldberg,
// "XY Interpolation Algorithms", which mentions the ellipse but does not derive it. The end follows the rule of
// arc_end.hpp. No errors are reported; not thread-safe.
//
// Widths. On a walk |x| <= a + 2 and |y| <= b + 2, a >= b without loss of generality.
//  circle:  F between the neighbours of the curve: |F| <= 2 (2 (R + 2) + 1), for a diagonal candidate; gradients
//           2 (R + 2); N <= R^2 + 2R. R <= 2^30: every value < 2^63, so 64 bits hold it.
//  ellipse: |GX| <= 2 b^2 (a + 2), |GY| <= 2 a^2 (b + 2), so candidates of F stay within 4 * 2 a^2 (b + 2); terms of
//           the first F: b^2 (a + 2)^2. a, b <= 2^30: terms < 2^121, candidates < 2^94: 128 bits hold them.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/interpolation/arc_end.hpp"
#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

template <class Word>
struct Conic {
  Word a = 1;
  Word b = 1;
  Word n = 0;
  Word deviation(const Point& p) const { return a * p.x * p.x + b * p.y * p.y - n; }
};

// The conic of `arc`, for points relative to its centre.
template <class Word>
Conic<Word> conic_of(const Arc& arc) {
  if (arc.is_circle()) {
    const Word x = arc.start.x - arc.centre.x;
    const Word y = arc.start.y - arc.centre.y;
    return {1, 1, x * x + y * y};
  }
  const Word a = static_cast<Word>(arc.semi_x) * arc.semi_x;
  const Word b = static_cast<Word>(arc.semi_y) * arc.semi_y;
  return {b, a, a * b};
}

// The inputs of a rule: F, the gradients (GX, GY) = (2 A x, 2 B y), and half of their second differences.
template <class Word>
struct ConicState {
  Word f;
  Word gradient_x;
  Word gradient_y;
  Word half_x;  // A
  Word half_y;  // B
  bool clockwise;

  // The directions of the curve here. Zero counts as positive; counter-clockwise is up on the right.
  std::int8_t direction_x() const { return (gradient_y < 0) == clockwise ? std::int8_t{-1} : std::int8_t{1}; }
  std::int8_t direction_y() const { return (gradient_x < 0) == clockwise ? std::int8_t{1} : std::int8_t{-1}; }
  Word change_x(std::int8_t s) const { return half_x + (s < 0 ? -gradient_x : gradient_x); }
  Word change_y(std::int8_t s) const { return half_y + (s < 0 ? -gradient_y : gradient_y); }
};

// Table 2. Index: bit 3 D (1 = clockwise with x right and y up; the paper's text says the reverse), bit 2 F >= 0,
// bit 1 GX >= 0, bit 0 GY >= 0.
struct SteerTable {
  static constexpr bool kDiagonal = false;
  static constexpr std::array<std::array<std::int8_t, 2>, 16> kSteps{{{0, -1},
                                                                      {-1, 0},
                                                                      {1, 0},
                                                                      {0, 1},
                                                                      {1, 0},
                                                                      {0, -1},
                                                                      {0, 1},
                                                                      {-1, 0},
                                                                      {-1, 0},
                                                                      {0, 1},
                                                                      {0, -1},
                                                                      {1, 0},
                                                                      {0, 1},
                                                                      {1, 0},
                                                                      {-1, 0},
                                                                      {0, -1}}};
  template <class Word>
  static Step choose(const ConicState<Word>& s) {
    const unsigned row =
        (s.clockwise ? 8u : 0u) | (s.f >= 0 ? 4u : 0u) | (s.gradient_x >= 0 ? 2u : 0u) | (s.gradient_y >= 0 ? 1u : 0u);
    return {{kSteps[row][0], kSteps[row][1], 0, 0}};
  }
};

// Takes the x step, the y step or both, whichever leaves the smallest |F|. A tie with the diagonal step chooses the
// diagonal; otherwise x comes before y. On or outside the curve the axis that moves away from its zero is excluded if
// its gradient is the larger one; without this, walks on needle ellipses run away.
struct MinDeviationRule {
  static constexpr bool kDiagonal = true;
  template <class Word>
  static Step choose(const ConicState<Word>& s) {
    const std::int8_t step_x = s.direction_x();
    const std::int8_t step_y = s.direction_y();
    const Word f_x = s.f + s.change_x(step_x);
    const Word f_y = s.f + s.change_y(step_y);
    const Word f_both = f_x + f_y - s.f;
    const bool x_outward = (step_x > 0) == (s.gradient_x >= 0);
    const bool outside = s.f >= 0;
    const Word size_x = magnitude(s.gradient_x);
    const Word size_y = magnitude(s.gradient_y);
    // Whole expressions instead of short circuits, because a branch predictor cannot predict the outcomes.
    const bool x_allowed = !(outside & x_outward & (size_x > size_y));
    const bool y_allowed = !(outside & !x_outward & (size_y > size_x));
    const Word size_both = magnitude(f_both);
    const Word size_f_x = magnitude(f_x);
    const bool not_y = x_allowed & (size_f_x < size_both);
    const Word best = not_y ? size_f_x : size_both;
    const bool not_x = y_allowed & (magnitude(f_y) < best);
    return {{static_cast<std::int8_t>(step_x * !not_x), static_cast<std::int8_t>(step_y * (not_x | !not_y)), 0, 0}};
  }

 private:
  template <class Word>
  static Word magnitude(Word value) {
    return value < 0 ? -value : value;
  }
};

template <class Rule, class Word>
class ConicArc {
 public:
  explicit ConicArc(const Arc& arc) : ConicArc(arc, conic_of<Word>(arc)) {}

  // Walks about the arc's centre on a curve other than the arc's own, as STEER does from a start off the circle.
  ConicArc(const Arc& arc, const Conic<Word>& conic)
      : centre_(arc.centre),
        at_{arc.start.x - arc.centre.x, arc.start.y - arc.centre.y},
        state_{conic.deviation(at_), 2 * conic.a * at_.x, 2 * conic.b * at_.y, conic.a, conic.b, arc.clockwise},
        end_(at_, {arc.end.x - arc.centre.x, arc.end.y - arc.centre.y}, arc.clockwise, extent(arc)) {}

  bool done() const { return end_.at_end(at_); }
  // Not to be called when done.
  Step next() {
    const bool straight = end_.finishing(at_, state_.direction_x(), state_.direction_y());
    const Step step = straight ? end_.straight(at_, Rule::kDiagonal) : Rule::choose(state_);
    const Point from = at_;
    apply(step);
    if (!straight) end_.moved(from, at_);
    ++time_;
    return step;
  }
  Position position() const { return {centre_.x + at_.x, centre_.y + at_.y, 0, 0}; }
  Deviation deviation() const { return state_.f; }
  // Unit: steps.
  std::uint64_t time() const { return time_; }
  bool exhausted() const { return end_.exhausted(); }

 private:
  static std::int64_t extent(const Arc& arc) {
    if (!arc.is_circle()) return arc.semi_x + arc.semi_y;
    // |x| + |y| of a point is at least its distance from the centre, so twice the sum covers half width plus half
    // height.
    const std::int64_t x = arc.start.x - arc.centre.x;
    const std::int64_t y = arc.start.y - arc.centre.y;
    return 2 * ((x < 0 ? -x : x) + (y < 0 ? -y : y));
  }

  // Products with -1, 0 or 1 instead of branches, for the same reason as above.
  void apply(const Step& step) {
    const Word x = step.direction[0];
    const Word y = step.direction[1];
    state_.f += x * state_.gradient_x + x * x * state_.half_x;
    state_.f += y * state_.gradient_y + y * y * state_.half_y;
    state_.gradient_x += 2 * x * state_.half_x;
    state_.gradient_y += 2 * y * state_.half_y;
    at_.x += step.direction[0];
    at_.y += step.direction[1];
  }

  Point centre_;
  Point at_;
  ConicState<Word> state_;
  ArcEnd end_;
  std::uint64_t time_ = 0;
};

using SteerCircle = ConicArc<SteerTable, std::int64_t>;
using SteerEllipse = ConicArc<SteerTable, Deviation>;
using MinDeviationCircle = ConicArc<MinDeviationRule, std::int64_t>;
using MinDeviationEllipse = ConicArc<MinDeviationRule, Deviation>;

}  // namespace trammel::interpolation
