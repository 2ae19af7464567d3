// From motions to blocks: pulses, length, limits. Checks the program against machine and card: soft limits, the range
// of the position counters, dwells. Pulls from the reader and holds one motion. Not thread-safe.
//
// The pulses of a joint are the rounded absolute target, half away from zero, so that errors do not add up. Lengths and
// limits are those of the path before rounding. Limits of velocity, acceleration and jerk are divided by max_override,
// its square and its cube; acceleration is also reduced by hold_reserve. A feed counts along X Y Z; if none of these
// moves, along U V W, then A B C, then E (as in LinuxCNC).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "trammel/gcode/reader.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/blender.hpp"
#include "trammel/planner/block.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::planner {

class Detours;

class BlockBuilder {
 public:
  // `start`: position of the machine, as the reader was told. Reader and machine must outlive the builder. Throws
  // driver::ArgumentError for step times that the card cannot keep.
  BlockBuilder(gcode::Reader& reader, const machine::Machine& machine, const CardLimits& card,
               const gcode::Coordinates& start = {});
  ~BlockBuilder();

  // Gets the next block. Returns false after the kEnd block and at the first error (what reader, machine or card do not
  // allow); error() then describes it. Switched outputs belong to the next block; if one output is switched several
  // times before it, the last time counts. A motion without a step gives no block: the next line begins where that
  // motion began, and has its corners as Block::detour.
  bool next(Block& block);
  const std::optional<gcode::Error>& error() const { return error_; }

  // Whether a probe is next. next() has then given all blocks before the probe, and returns false until begin_probe().
  // It then gives one block, the motion to the probe's target, and returns false again until resume_at() gives the
  // machine's position.
  bool at_probe() const { return probe_ != Probe::kNone; }
  const gcode::Motion& begin_probe();
  void resume_at(const Pulses& here);

  const Pulses& start() const { return start_; }
  // From the next block on, a motion of an axis without max_jerk is refused.
  void require_jerk() { jerk_required_ = true; }
  // Before the first block: G64 P makes no blends. For programs of which every line ends in a stop.
  void keep_corners() { blender_.keep_corners(); }

 private:
  struct Axis {
    double velocity;      // mm/s
    double acceleration;  // mm/s^2
    double jerk;          // mm/s^3
    double lowest;        // mm, soft limits
    double highest;
    bool linear;          // X, Y or Z
    unsigned feed_group;  // whose feed counts along it: 0 X Y Z, 1 U V W, 2 A B C, 3 E
  };
  // Limits of a joint of the card. Velocity, acceleration and jerk are infinite if only its axes have limits.
  struct JointRates {
    double pulses;        // per second, the most that the shaper makes without a pause
    double velocity;      // mm/s
    double acceleration;  // mm/s^2
    double jerk;          // mm/s^3
  };
  // Limits that hold in every direction of an arc's plane.
  struct PlaneLimits {
    double velocity;      // mm/s
    double pulse_speed;   // mm/s
    double acceleration;  // mm/s^2
    double jerk;          // mm/s^3
  };
  enum class Probe : std::uint8_t { kNone, kReached, kBegun, kPlanned };

  bool build(Block& block);
  bool next_probe(Block& block);
  void switch_outputs();
  bool set_targets(Block& block);
  bool build_line(Block& block);
  Heading heading_of(const Block& block) const;
  void follow_detour(Block& block, bool any);
  bool build_arc(Block& block);
  bool build_generator_arc(Block& block, const kinematics::PlaneMap& plane) const;
  bool build_accumulator_arc(Block& block, const kinematics::PlaneMap& plane);
  bool build_chords(Block& block);
  bool build_tilted(Block& block);
  bool build_dwell(Block& block);
  double measure_line(Block& block, const gcode::Coordinates& way) const;
  static void limit_speed(Block& block, double speed, SpeedLimit limit);
  void limit_line(Block& block) const;
  void limit_joints(Block& block) const;
  double finest_in_plane(const Block& block) const;
  double joint_share(const Block& block, std::size_t joint) const;
  PlaneLimits plane_limits(const Block& block) const;
  void limit_arc(Block& block, double unevenness, double share) const;
  double measure_arc(Block& block) const;
  void limit_further(Block& block) const;
  static Direction tangent(const Block& block, double share);
  void limit_pulses(Block& block) const;
  void apply_feed(Block& block, double feed_length) const;
  std::size_t joint_count() const { return kinematics_.joints(); }
  bool check(std::size_t axis, double mm);
  bool check_arc(const Block& block);
  bool refuse(gcode::ErrorCode code, std::string message);

  gcode::Reader& reader_;
  const machine::Machine& machine_;
  CardLimits card_;
  std::size_t axis_count_;
  bool jerk_required_ = false;
  kinematics::Kinematics kinematics_;
  std::array<Axis, card_map::kMaxAxes> axes_{};
  std::array<JointRates, card_map::kMaxAxes> joints_{};
  Blender blender_;
  PathMotion motion_;
  Pulses start_{};
  Pulses here_{};
  gcode::Coordinates exact_{};   // position of the program, unrounded
  gcode::Coordinates anchor_{};  // end of the last block, unrounded
  std::unique_ptr<Detours> detours_;
  driver::OutputCommand outputs_;  // for the next block
  Probe probe_ = Probe::kNone;
  std::optional<gcode::Error> error_;
};

}  // namespace trammel::planner
