// The path operations of LinuxCNC's planner module on a card: each becomes a line of G-code, and run::Runner plans and
// streams them as they come. While no operation has come for a moment the motion ends at rest, before the card could
// run dry, and the next operation begins a new run from there. One thread.
//
// Coordinates: the card counts pulses and LinuxCNC says where it takes the machine to stand (TRAMMEL_SET_POSE, at
// rest). The difference is kept in whole pulses; a pose within 0.75 pulses of where the card stands changes nothing, so
// that jogs, which end between two pulses, do not let it drift.
//
// Soft limits are LinuxCNC's, and the card's own guard; those of the machine file are not looked at here, since they
// are in other coordinates.
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
  // `card` is open on `bus` and stands; region, card and bus must outlive it. Throws std::invalid_argument for a
  // machine whose kinematics are not cartesian: LinuxCNC's trivkins is all that the planner module takes.
  PathServer(trammel_region& region, driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine,
             PathUnits units);
  ~PathServer() override;

  // Runs what the ring brings. `meanwhile` is called about once a millisecond, also while the card moves; when it gives
  // false, the motion is stopped on the path and serve() returns with the card at rest. Throws driver::LinkError, and
  // what `meanwhile` throws. Faults of the card end the path and show in write_status().
  void serve(const std::function<bool()>& meanwhile) override;
  // The part of the status that tells of path operations, and TRAMMEL_STATUS_AT_REST among its flags.
  void write_status(trammel_status& status) const override;
  // Other step times or scales: only outside serve(). Where the machine stands is asked again.
  void set_machine(const machine::Machine& machine);

 private:
  friend class PathLines;
  struct Segment {
    std::size_t line = 0;  // of the run
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
  planner::PathTicks ticks_;  // of the motions so far
  const std::function<bool()>* meanwhile_ = nullptr;
  bool ending_ = false;  // `meanwhile` has said so

  std::unique_ptr<PathProgress> progress_;  // of the run under way, as the next four
  std::deque<Segment> under_way_;           // read, and not passed
  bool probing_ = false;
  bool probe_met_ = false;
  bool stop_asked_ = false;

  double feed_scale_ = -1;  // in force; below 0: none yet
  double rapid_scale_ = -1;
  bool holding_ = false;
  driver::Snapshot now_;
  std::uint64_t beat_ = 0;       // of the planner module; 0: none yet
  std::uint64_t last_came_ = 0;  // card clock at which operations came last
  std::uint64_t last_beat_ = 0;  // and the beat then
  std::uint64_t speed_time_ = 0;
  Pose speed_at_{};
  trammel_status report_{};
};

}  // namespace trammel::linuxcnc
