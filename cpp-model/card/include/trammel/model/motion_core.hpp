// Golden model of the motion core: sequencers, time, path engines, axes and the stop control between the queues and the
// pins. One rising edge moves everything from what stood before it. Not thread-safe; no errors are reported.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trammel/model/axis.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/direct_loader.hpp"
#include "trammel/model/feed_generator.hpp"
#include "trammel/model/path_commands.hpp"
#include "trammel/model/path_engines.hpp"
#include "trammel/model/probe.hpp"
#include "trammel/model/sequencer.hpp"
#include "trammel/model/step_record.hpp"
#include "trammel/model/stop_control.hpp"
#include "trammel/model/time_base.hpp"
#include "trammel/model/underrun_guard.hpp"
#include "trammel/model/wait_timer.hpp"

namespace trammel::model {

class MotionCore {
 public:
  struct Inputs {
    Setting setting;
    bool abort = false;
    std::uint32_t clear_fault = 0;
    bool probe_clear = false;
    // queues
    bool geometry_empty = true;
    bool feed_empty = true;
    std::uint16_t geometry_word = 0;
    std::uint16_t feed_word = 0;
    UnderrunGuard::Arrival arrival;
    bool full = false;  // a queue may have no room for the next command
    // direct mode
    bool start = false;
    std::uint8_t start_mask = 0;
    std::uint32_t loader_data = 0;
    std::uint16_t pins = 0;  // inputs of the card
  };
  // A bit for each axis.
  struct Outputs {
    std::uint32_t step = 0;  // pins
    std::uint32_t dir = 0;
    std::uint32_t path_step = 0;
    std::uint32_t path_dir = 0;
    std::uint32_t live = 0;
    std::uint32_t axis_busy = 0;
    std::uint32_t step_fault = 0;
    std::uint32_t engine_step = 0;  // of path_step: those that came from a path engine
    bool busy = false;
  };

  // `idle_level`: {second pins, first pins}, `axes` bits each. `clock_all`: no block ever rests. `engines`: what is
  // built in, what is beside the path engines.
  MotionCore(unsigned axes, std::uint32_t idle_level, bool clock_all = false, std::uint32_t engines = 0,
             const PathCommands::Config& pins = {});

  // One rising edge.
  void clock(const Inputs& in);

  // Clocks at once without host inputs and with the queues as they are, `limit` at most, from step to step (see
  // jump.hpp); the state is that after as many calls of clock(). `cycle`: edges so far. 0 where it is not worth it.
  std::uint64_t jump(std::uint64_t limit, const Inputs& in, std::uint64_t cycle, StepRecord& record);

  const Outputs& outputs() const { return out_; }
  const Sequencer& sequencer() const { return sequencer_; }
  const StopControl::Outputs& stop() const { return stop_.outputs(); }
  const DirectLoader::Outputs& loader() const { return loader_.outputs(); }
  const UnderrunGuard::Outputs& underrun() const { return guard_.outputs(); }
  const TimeBase::Outputs& time() const { return time_base_.outputs(); }
  const FeedGenerator::Outputs& feed() const { return feed_.outputs(); }
  const PathCommands& commands() const { return commands_; }
  const Probe& probe() const { return probe_; }
  // The probe's edge is taken in this clock, and with these inputs.
  bool probe_trips(const Inputs& in) const { return probe_.trips(probe_inputs(in)); }
  const PathEngines::Outputs& engines() const { return engines_.outputs(); }
  bool chord_tick() const { return engines_.chord_tick(); }
  std::uint32_t position(unsigned axis) const { return axes_[axis].shaper().outputs().position; }

 private:
  friend class Jump;

  // STATUS.busy falls when nothing has run for this many clocks.
  static constexpr unsigned kBusyClocks = 11;

  void clock_axes(const Inputs& in, bool cut);
  void clock_commands(const Inputs& in, bool cut);
  void clock_busy();
  void show_axis(unsigned n);
  bool may_jump(const Inputs& in) const;
  // The guard counts; in position streaming it does not.
  bool guards() const { return has_guard_ && !sequencer_.streaming().on; }
  // Clocks for which the ratio is known ahead, 0 where it is not.
  std::uint64_t ratio_known_for() const {
    return time_base_.clocks_ahead(stop_.outputs().hold, sequencer_.outputs().piece_class);
  }
  Probe::Inputs probe_inputs(const Inputs& in) const;
  Sequencer::Inputs sequencer_inputs(const Inputs& in) const;
  UnderrunGuard::Inputs guard_inputs(const Inputs& in, const Sequencer::Inputs& sequencer_in) const;

  bool clock_all_;
  bool has_guard_;
  std::uint32_t restless_ = ~0U;  // axes that the next clock moves whatever it brings
  StopControl stop_;
  UnderrunGuard guard_;
  DirectLoader loader_;
  Sequencer sequencer_;
  TimeBase time_base_;
  FeedGenerator feed_;
  PathEngines engines_;
  WaitTimer wait_timer_;
  PathCommands commands_;
  Probe probe_;
  std::vector<Axis> axes_;
  bool axes_live_ = false;  // a clock late
  bool running_ = false;    // a clock late
  bool probing_ = false;    // a clock late
  unsigned busy_left_ = 0;  // clocks
  Outputs out_;
};

}  // namespace trammel::model
