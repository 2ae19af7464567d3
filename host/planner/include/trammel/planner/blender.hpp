// G64 P: corners become arcs that are tangent to both motions. Sits between reader and BlockBuilder, pulls, and holds
// one motion. Not thread-safe; computed in + - * / and square roots alone.
//
// A blend leaves the programmed path by at most P: that is how far the corner lies from it, and no other point of
// either path is farther from the other one. It takes at most half of either motion, so that what it does depends on
// these two alone. Outputs that are switched at a corner are switched where its blend begins (eight words; a corner
// with more is kept). Two lines make an arc in their plane, lines and arcs in one main plane an arc in that. Axes other
// than X, Y and Z go evenly along it; how far they stray does not count.
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

// What becomes of a corner under G64 P.
enum class Corner : std::uint8_t {
  kNone,       // there is none, or none was asked for
  kBlended,    // by the motion itself, which is the blend
  kReversal,   // less than a degree off
  kNoCurve,    // a helix, an arc outside the other motion's plane, or no room for an arc
  kInvisible,  // the blend would keep within a quarter of a pulse and the corner's rules allow its speed, or turns
               // within three
  kFaster,     // the corner's rules allow a speed at which it takes less time than the blend
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

// A motion with what blending makes of it. Blends are arcs, and count as of the line whose end they round.
struct PathMotion : gcode::Motion {
  gcode::Coordinates programmed{};  // where the program wants it to end; a blend's: where it ends
  bool rapid = false;
  bool tilted = false;  // a blend of lines in another plane than the main ones: an arc for which `space` says all
  SpaceArc space;
  double distance = 0;            // mm, a blend's from the corner
  Corner corner = Corner::kNone;  // kBlended: a blend. Else what became of the corner at its end
};

class Blender {
 public:
  // Reader and machine must outlive the blender.
  Blender(gcode::Reader& reader, const machine::Machine& machine, const gcode::Coordinates& start);
  ~Blender();

  // False where the reader's is, when all that was held is given.
  bool next(PathMotion& motion);
  // Behind a probe: the machine stands somewhere else than its target.
  void resume_at(const gcode::Coordinates& here) { here_ = here; }
  // Before the first next(): no blends.
  void keep_corners() { keep_corners_ = true; }

 private:
  using Vector = std::array<double, 3>;  // X Y Z
  // A motion as it is programmed, with what was taken of it.
  struct Way {
    PathMotion motion;
    gcode::Coordinates start{};
    double length = 0;        // of X, Y and Z; 0: none of these moves, or it is no motion
    double taken_before = 0;  // share
    double taken_behind = 0;
    // kArc
    double radius_start = 0;
    double radius_end = 0;
    double angle_start = 0;
    double sweep = 0;
    bool flat = false;  // no way of X, Y and Z outside its plane
  };
  // A plane through a corner.
  struct Frame {
    Vector first;  // unit vectors, at right angles
    Vector second;
    std::array<std::size_t, 2> letters{};  // of a main plane: X, Y and Z by 0, 1 and 2
    bool main = false;
  };
  struct Turn {
    Vector from;
    Vector to;
    double sine;  // of half the angle
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
  double finest_ = 0;                                      // steps/mm, of these
  double junction_deviation_;                              // mm
  std::unique_ptr<CornerTime> time_;
  bool keep_corners_ = false;
  gcode::Coordinates here_;
  std::array<Way, 2> ways_;  // the one that may lose its end, and the one behind it
  std::size_t first_ = 0;
  bool held_ = false;
  std::array<PathMotion, kMaxOutputs> outputs_;    // between the two
  std::array<PathMotion, kMaxOutputs + 2> given_;  // to be given, in order
  std::size_t given_first_ = 0;
  std::size_t given_count_ = 0;
};

}  // namespace trammel::planner
