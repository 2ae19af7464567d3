// Golden model of the whole card: the block models, wired as the card is, cycle by cycle the same at every pin.
//
// clock() is one rising edge. run(n) is n edges without bus traffic and goes from tick to tick where nothing else
// happens; it leaves exactly the state that n calls of clock() leave. Steps are reported as they appear: at the pins in
// the cycle of their leading edge, on the path before the shapers. Not thread-safe; no errors are reported beside the
// constructor's.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "trammel/model/axi4_lite_port.hpp"
#include "trammel/model/axis.hpp"
#include "trammel/model/command_door.hpp"
#include "trammel/model/deviation_accumulator.hpp"
#include "trammel/model/direct_loader.hpp"
#include "trammel/model/feed_generator.hpp"
#include "trammel/model/halfword_queue.hpp"
#include "trammel/model/register_file.hpp"
#include "trammel/model/sequencer.hpp"
#include "trammel/model/small_blocks.hpp"
#include "trammel/model/time_base.hpp"

namespace trammel::model {

// Receives steps in order of time.
class CardSteps {
 public:
  virtual ~CardSteps() = default;
  // A step at the pins of `axis`; `cycle` counts rising edges since reset, that of the leading edge included.
  virtual void pin_step(std::uint64_t cycle, unsigned axis, int direction) = 0;
  // A step of the path. `command`: number in the stream, from 0 at reset or abort, not wrapped, barriers and feed
  // pieces counted; 0 in direct mode. `tick`: of its path, from 1; feed ticks of a line (enabled clocks in direct
  // mode), path ticks of an arc.
  virtual void path_step(std::uint64_t command, std::uint64_t tick, unsigned axis, int direction) = 0;
};

class CardModel {
 public:
  static constexpr unsigned kMaxAxes = 8;

  struct Config {
    unsigned axes = 4;               // 1 .. 8
    unsigned geometry_depth = 4096;  // halfwords
    unsigned feed_depth = 2560;
    std::uint32_t clock_hz = 1'000'000;
  };
  // Pins of the AXI4-Lite port, as the card has them; see Axi4LitePort.
  struct Inputs {
    bool rst = false;  // registered: it takes effect a clock later
    bool awvalid = false;
    bool wvalid = false;
    bool bready = false;
    bool arvalid = false;
    bool rready = false;
    std::uint8_t wstrb = 0;
    std::uint32_t awaddr = 0;
    std::uint32_t araddr = 0;
    std::uint32_t wdata = 0;
  };
  // What the card shows of itself beside the bus.
  struct Outputs {
    std::uint32_t step = 0;  // pins, by axis
    std::uint32_t dir = 0;
    bool irq = false;
    bool tick = false;
    bool path_tick = false;
    bool path_swap = false;
    bool feed_swap = false;
    std::uint32_t path_step = 0;  // by axis
    std::uint32_t path_dir = 0;
    std::uint32_t geometry_room = 0;
    std::uint32_t feed_room = 0;
    std::uint32_t status = 0;  // {incomplete, ended, feed active, path active, direct, busy}
    std::uint32_t fault = 0;
    std::uint32_t running = 0;  // {feed, geometry}
    std::uint32_t ratio = 0;
    std::uint32_t rate = 0;
    bool operator==(const Outputs& o) const;
  };

  // Throws std::invalid_argument for numbers out of range.
  explicit CardModel(const Config& config);

  // One rising edge.
  void clock(const Inputs& in);
  // `clocks` rising edges with all valid and ready inputs low.
  void run(std::uint64_t clocks);

  const Axi4LitePort::Outputs& bus() const { return port_.outputs(); }
  const Outputs& outputs() const { return out_; }
  std::uint32_t position(unsigned axis) const { return axes_[axis].shaper().outputs().position; }
  unsigned axes() const { return config_.axes; }
  std::uint64_t cycles() const { return cycles_; }
  void set_steps(CardSteps* steps) { steps_ = steps; }  // nullptr: none; not owned

 private:
  struct Take {
    std::uint64_t cycle = 0;
    std::uint64_t command = 0;
    std::uint64_t tick = 0;
  };

  // The axes' outputs, a bit for each.
  struct AxisBits {
    std::uint32_t step = 0;
    std::uint32_t dir = 0;
    std::uint32_t path_step = 0;
    std::uint32_t path_dir = 0;
    std::uint32_t live = 0;
    std::uint32_t busy = 0;
    std::uint32_t fault = 0;

    void show(std::uint32_t bit, const Axis::Outputs& axis) {
      set(step, bit, axis.shaper.step);
      set(dir, bit, axis.shaper.dir);
      set(path_step, bit, axis.path_step);
      set(path_dir, bit, axis.path_dir);
      set(live, bit, axis.live);
      set(busy, bit, axis.shaper.busy);
      set(fault, bit, axis.shaper.fault);
    }
    static void set(std::uint32_t& word, std::uint32_t bit, bool value) { word = value ? word | bit : word & ~bit; }
  };

  void reset();
  void gather_register_inputs();
  std::uint32_t faults_now() const;
  std::uint32_t watched() const;
  void clock_host(const Inputs& in);
  void clock_axes();
  void clock_time();
  void clock_commands(bool geometry_read, bool feed_read);
  Sequencer::Inputs sequencer_inputs() const;
  void show();
  void record();
  void report_path_steps(std::uint32_t steps);
  void report_pin_step(unsigned axis);
  void refresh_settings();

  bool may_jump() const;
  std::uint64_t accumulations_in(std::uint64_t clocks) const;
  std::uint64_t clock_of(std::uint64_t accumulation) const;
  std::uint64_t silent_ticks() const;
  std::uint64_t jump(std::uint64_t limit);
  void land(std::uint64_t clocks, std::uint64_t ticks, bool feed_enable);

  Config config_;
  CardSteps* steps_ = nullptr;
  std::uint64_t cycles_ = 0;
  bool reset_due_ = false;

  Axi4LitePort port_;
  RegisterFile registers_;
  CommandDoor door_;
  HalfwordQueue geometry_queue_;
  HalfwordQueue feed_queue_;
  DirectLoader loader_;
  Sequencer sequencer_;
  TimeBase time_base_;
  FeedGenerator feed_;
  PulseGenerator prescaler_;
  DeviationAccumulator accumulator_;
  ArcRouter router_;
  HoldTimer hold_timer_;
  BusyTimer busy_timer_;
  std::vector<Axis> axes_;
  std::array<Axis::Inputs, kMaxAxes> axis_in_{};
  std::array<std::uint32_t, kMaxAxes> shown_position_{};
  AxisBits axis_state_;
  std::uint32_t restless_ = 0;  // axes that the next clock moves whatever it brings
  std::uint32_t ext_step_ = 0;  // steps of the accumulator that the axes took in this clock
  bool any_live_ = false;
  bool faulted_ = false;
  bool running_ = false;

  RegisterFile::Inputs register_in_;
  TimeBase::Inputs time_in_;
  std::uint32_t watched_ = 0;
  int awake_ = 0;  // clocks for which the host side is clocked whatever it says

  // Record of steps.
  std::uint64_t accepted_ = 0;                  // commands that the door let in
  std::deque<std::uint64_t> geometry_numbers_;  // of those in the geometry queue
  std::uint64_t command_ = 0;
  std::uint64_t path_taken_ = 0;  // ticks of the path
  std::uint64_t arc_taken_ = 0;   // path ticks of the arc
  bool arc_ = false;
  std::array<Take, 8> takes_{};
  std::size_t take_index_ = 0;

  Outputs out_;
};

}  // namespace trammel::model
