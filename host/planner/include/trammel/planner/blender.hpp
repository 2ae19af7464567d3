// G64 P: replaces corners by arcs that are tangent to both motions. Used between reader and BlockBuilder: pulls from
// the reader and holds one motion. Not thread-safe. Computes with + - * / and square roots only, so that every host
// gets the same result.
//
// A blend deviates from the programmed path by at most P: this is the distance from the corner to the blend, and no
// other point of either path is farther from the other path. A blend replaces at most half of each motion, so it
// depends on these two motions only. Outputs that the program switches at a corner are switched where its blend begins.
// (Up to eight output words; a corner with more is kept.) The blend of two lines is an arc in their plane. The blend of
// lines and arcs in one main plane is an arc in that plane. Axes other than X, Y and Z move evenly along the blend;
// their deviation is not limited.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::planner {

struct CornerSide;
class CornerTime;
struct Fillet;

// The treatment of a corner under G64 P.
enum class Corner : std::uint8_t {
  kNone,      // no corner, or no tolerance was given
  kBlended,   // replaced by the motion itself, which is the blend
  kReversal,  // less than a degree off a reversal
  kNoCurve,   // no tangent arc: a helix, an arc outside the other motion's plane, or too little room
  // The blend would deviate by less than a quarter of a pulse and by no more than junction_deviation, so that the
  // corner allows its speed; or its radius would be below three pulses.
  kInvisible,
  // Passing the corner at the speed that its rules allow takes less time than the blend.
  kFaster,
};
inline constexpr std::size_t kCorners = 6;

// An arc in any plane of three axes: centre + radius (cos(angle) first + sin(angle) second), angle 0 .. sweep.
struct SpaceArc {
  std::array<std::uint8_t, 3> axes{};
  std::array<double, 3> centre{};  // mm, machine coordinates
  std::array<double, 3> first{};   // unit vectors, at right angles
  std::array<double, 3> second{};
  double radius = 0;
  double sweep = 0;
};

// A motion with the result of blending. Blends are arcs; they belong to the line whose end they replace.
struct PathMotion : gcode::Motion {
  gcode::Coordinates programmed{};  // end point of the program; of a blend: its own end
  bool rapid = false;
  // A blend of two lines outside the main planes: an arc that `space` alone describes.
  bool tilted = false;
  SpaceArc space;
  double distance = 0;            // mm, of a blend: its distance from the corner
  Corner corner = Corner::kNone;  // kBlended: this is a blend. else the treatment of the corner at its end
};

class Blender {
 public:
  // Reader and machine must outlive the blender.
  Blender(gcode::Reader& reader, const machine::Machine& machine, const gcode::Coordinates& start);
  ~Blender();

  // False when the reader's next() is false and no held motion is left.
  bool next(PathMotion& motion);
  // After a probe: the machine is at `here`, not at the probe's target.
  void resume_at(const gcode::Coordinates& here) { here_ = here; }
  // Before the first next(): disables blends.
  void keep_corners() { keep_corners_ = true; }

 private:
  using Vector = std::array<double, 3>;  // X Y Z
  // A motion as programmed, with the shares of it that blends replace.
  struct Way {
    PathMotion motion;
    gcode::Coordinates start{};
    double length = 0;        // mm, of X, Y and Z; 0: none of these moves, or blends are not allowed
    double taken_before = 0;  // share of the motion at its beginning, 0 to 1/2
    double taken_behind = 0;  // share at its end
    // kArc
    double radius_start = 0;
    double radius_end = 0;
    double angle_start = 0;
    double sweep = 0;
    bool flat = false;  // X, Y and Z move in the arc's plane only
  };
  // A plane through a corner.
  struct Frame {
    Vector first;  // unit vectors, at right angles
    Vector second;
    std::array<std::size_t, 2> letters{};  // of a main plane: X, Y and Z as 0, 1 and 2
    bool main = false;
  };
  // Directions before and after the corner, unit vectors.
  struct Turn {
    Vector from;
    Vector to;
    double sine;  // of half the angle between them
  };

  bool pull(Way& way);
  void measure(Way& way) const;
  void measure_arc(Way& way) const;
  CornerSide corner_side(const Way& way, const Vector& going, bool at_end) const;
  Corner blend(Way& from, Way& to, PathMotion& made) const;
  bool find_frame(const Way& from, const Way& to, const Turn& turn, Frame& frame) const;
  Vector direction(const Way& way, bool at_end) const;
  static double curvature(const Way& way, bool at_end);
  static double slack(const Way& way);
  static bool can_lose(const Way& way, double share);
  static gcode::Coordinates point(const Way& way, double share);
  void make(const Way& from, const Way& to, const Frame& frame, const Turn& turn, const Fillet& curve,
            PathMotion& made) const;
  static void trim(Way& way);
  double at(const gcode::Coordinates& coordinates, std::size_t letter) const {
    return space_[letter] == kNone ? 0 : coordinates[space_[letter]];
  }

  static constexpr std::size_t kNone = ~std::size_t{0};
  static constexpr std::size_t kMaxOutputs = 8;

  gcode::Reader& reader_;
  std::size_t axes_;
  std::array<std::size_t, 3> space_{kNone, kNone, kNone};  // axis indices of X, Y and Z
  double finest_ = 0;                                      // highest steps/mm of X, Y and Z
  double junction_deviation_;                              // mm
  std::unique_ptr<CornerTime> time_;
  bool keep_corners_ = false;
  gcode::Coordinates here_;
  // [first_]: the motion whose end may still be replaced; the other one: the motion after it.
  std::array<Way, 2> ways_;
  std::size_t first_ = 0;
  bool held_ = false;
  std::array<PathMotion, kMaxOutputs> outputs_;    // switched between the two motions
  std::array<PathMotion, kMaxOutputs + 2> given_;  // what next() returns, in order
  std::size_t given_first_ = 0;
  std::size_t given_count_ = 0;
};

}  // namespace trammel::planner
