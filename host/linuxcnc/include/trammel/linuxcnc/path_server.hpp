// Executes the path operations of LinuxCNC's planner module on a card. Each operation becomes a line of G-code;
// run::Runner plans and streams the lines as they arrive. If no operation arrives for a moment, the motion ends at rest
// before the card could run out of commands, and the next operation starts a new run from there. Used by one thread.
//
// Coordinates: the card counts pulses, and LinuxCNC gives the pose at which it assumes the machine to be
// (TRAMMEL_SET_POSE, at rest). The difference is kept in whole pulses. A pose within 0.75 pulses of the card's position
// changes nothing, so jogs, which end between two pulses, do not make the difference drift.
//
// LinuxCNC and the card itself enforce soft limits; those of the machine file are not used here, because they are in
// other coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "trammel/driver/card.hpp"
#include "trammel/linuxcnc/path_line.hpp"
#include "trammel/linuxcnc/path_queue.hpp"
#include "trammel/linuxcnc/path_side.hpp"
#include "trammel/run/attentive_bus.hpp"
#include "trammel/run/machine_position.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::linuxcnc {

class PathLines;
class PathProgress;

class PathServer final : public PathSide {
 public:
  // `card` is open on `bus` and at rest; region, card and bus must outlive the server. Throws std::invalid_argument for
  // a machine whose kinematics are not cartesian, because the planner module supports only LinuxCNC's trivkins.
  PathServer(trammel_region& region, driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine,
             PathUnits units);
  ~PathServer() override;

  // Executes the operations of the ring. `meanwhile` is called about once per millisecond, also while the card moves.
  // When it returns false, the motion is stopped on the path and serve() returns with the card at rest. Throws
  // driver::LinkError, and exceptions of `meanwhile`. A fault of the card ends the path and is reported by
  // write_status().
  void serve(const std::function<bool()>& meanwhile) override;
  // Writes the status of the path operations, and TRAMMEL_STATUS_AT_REST in the flags.
  void write_status(trammel_status& status) const override;
  // Sets new step times or scales: only outside serve(). The next operations need a new pose.
  void set_machine(const machine::Machine& machine);

 private:
  friend class PathLines;
  struct Segment {
    std::size_t line = 0;  // line of the run
    std::uint64_t number = 0;
    std::int32_t id = 0;
    Pose end{};
  };

  void turn();
  void look();
  void note_came();
  void follow_segments();
  void measure_speed(const driver::Snapshot& now);
  void stop_if_asked(const driver::Snapshot& now);
  void begin_overrides();
  void apply_overrides();
  void end_overrides();
  void set_ratio(driver::PieceClass piece_class, double scale);
  void set_hold(bool hold);
  void idle();
  void set_pose(const Pose& pose);
  void run_section();
  void end_section();
  void note_end(const run::Outcome& outcome);
  void refuse(std::int32_t id, const std::string& text);

  trammel_region& region_;
  driver::Card& card_;
  run::AttentiveBus& bus_;
  PathUnits units_;
  machine::Machine machine_;
  PathQueue queue_;
  std::unique_ptr<run::MachinePosition> position_;
  planner::PathTicks ticks_;  // tick counts of the motions so far
  const std::function<bool()>* meanwhile_ = nullptr;
  bool ending_ = false;  // `meanwhile` has returned false

  std::unique_ptr<PathProgress> progress_;  // of the current run, as the next four
  std::deque<Segment> under_way_;           // segments that were read and have not ended
  bool probing_ = false;
  bool probe_met_ = false;
  bool stop_asked_ = false;

  double feed_scale_ = -1;  // scale in force; below 0: none yet
  double rapid_scale_ = -1;
  bool holding_ = false;
  driver::Snapshot now_;
  std::uint64_t beat_ = 0;       // last beat of the planner module; 0: none yet
  std::uint64_t last_came_ = 0;  // card time at which operations last arrived
  std::uint64_t last_beat_ = 0;  // beat at that time
  std::uint64_t speed_time_ = 0;
  Pose speed_at_{};
  trammel_status report_{};
};

}  // namespace trammel::linuxcnc
