// Golden model of the card's core: everything between the inner register port and the pins, cycle by cycle.
//
// clock() is one rising edge. Steps are reported as they appear: at the pins in the cycle of their leading edge, on the
// path before the shapers. Not thread-safe; no errors are reported beside the constructor's.
#pragma once

#include <cstdint>

#include "trammel/model/command_checker.hpp"
#include "trammel/model/halfword_queue.hpp"
#include "trammel/model/motion_core.hpp"
#include "trammel/model/queue_watermarks.hpp"
#include "trammel/model/register_file.hpp"
#include "trammel/model/step_record.hpp"

namespace trammel::model {

struct CardConfig {
  unsigned axes = 4;               // 1 .. 8
  unsigned geometry_depth = 4096;  // halfwords
  unsigned feed_depth = 2560;
  std::uint32_t clock_hz = 1'000'000;
  std::uint32_t engines = RegisterFile::kDefaultEngines;  // what is built in
  unsigned ports = 1;                                     // 1 .. 4
  unsigned inputs = 4;                                    // 1 .. 16, of a card with path commands
  unsigned outputs = 4;
  std::uint16_t output_idle = 0;  // strap: levels of the outputs in reset
  std::uint32_t idle_level = 0;   // strap: {second pins, first pins}, `axes` bits each
  std::uint32_t build_id = 0;
  bool build_dirty = false;
  std::uint32_t board_id = 0;
};

class CoreModel {
 public:
  using Config = CardConfig;

  // The inner register port.
  struct Inputs {
    bool rst = false;  // registered: it takes effect a clock later
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint8_t port = 0;
    std::uint32_t address = 0;  // bytes, 12 bits
    std::uint32_t data = 0;
    std::uint16_t pins = 0;  // inputs of the card
  };
  struct Answer {
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };
  // Pins, and what the core shows of itself beside the port (observe_o; positions: position()).
  struct Outputs {
    std::uint32_t step = 0;  // pins, by axis
    std::uint32_t dir = 0;
    std::uint32_t output = 0;  // outputs of the card
    bool irq = false;
    bool tick = false;  // feed domain, as path_swap
    bool path_tick = false;
    bool path_swap = false;
    bool feed_swap = false;
    std::uint32_t path_step = 0;  // by axis
    std::uint32_t path_dir = 0;
    std::uint32_t geometry_room = 0;
    std::uint32_t feed_room = 0;
    std::uint32_t status = 0;
    std::uint32_t fault = 0;
    std::uint32_t geometry_begun = 0;
    std::uint32_t feed_begun = 0;
    std::uint32_t ratio = 0;
    std::uint32_t rate = 0;
    bool operator==(const Outputs& o) const;
  };

  // Throws std::invalid_argument for numbers out of range.
  explicit CoreModel(const Config& config);

  // All that the next clock() depends on beside its inputs, and the record of steps.
  struct State {
    RegisterFile registers;
    CommandChecker checker;
    HalfwordQueue geometry_queue;
    HalfwordQueue feed_queue;
    QueueWatermarks watermarks;
    MotionCore motion;
    std::uint64_t cycles = 0;
    bool reset_due = false;
    StepRecord record{};
    Answer answer{};
    Outputs out{};
    RegisterFile::Inputs shown{};  // to the register file; a request and the probe's edge only within a clock
  };

  // One rising edge.
  void clock(const Inputs& in) { clock_parts(in, ClockEach()); }
  template <class ClockPart>
  void clock_parts(const Inputs& in, const ClockPart& clock_part);

  const State& state() const { return state_; }
  State& state() { return state_; }
  // What the parts see.
  MotionCore::Inputs motion_inputs(std::uint16_t pins) const;
  QueueWatermarks::Inputs watermark_inputs() const;
  // Takes the parts' outputs over into the core's.
  void show();

  const Answer& answer() const { return state_.answer; }
  const Outputs& outputs() const { return state_.out; }
  std::uint32_t position(unsigned axis) const { return state_.motion.position(axis); }
  const Config& config() const { return config_; }
  std::uint64_t cycles() const { return state_.cycles; }
  void set_steps(CardSteps* steps) { state_.record.set_steps(steps); }  // nullptr: none; not owned

 private:
  void reset();
  CommandChecker::Inputs checker_inputs(bool cut) const;
  void request(const Inputs& access, bool probe) {
    state_.shown.request = access.request;
    state_.shown.write = access.write;
    state_.shown.partial = access.partial;
    state_.shown.port = access.port;
    state_.shown.address = access.address;
    state_.shown.data = access.data;
    state_.shown.probe = probe;
  }
  void show_registers();
  void record(bool cut);

  Config config_;
  State state_;
};

// The queues take the checker's outputs as they stood before the edge, the checker the queues' rooms.
template <class ClockPart>
void CoreModel::clock_parts(const Inputs& in, const ClockPart& clock_part) {
  const bool reset_now = state_.reset_due;
  state_.reset_due = in.rst;
  if (reset_now) return reset();
  ++state_.cycles;
  const bool cut = state_.motion.stop().cut;
  const MotionCore::Inputs motion = motion_inputs(in.pins);
  const QueueWatermarks::Inputs watermarks = watermark_inputs();
  request(in, state_.motion.probe_trips(motion));
  const CommandChecker::Outputs was = state_.checker.outputs();
  const bool geometry_read = state_.motion.sequencer().geometry_read();
  const bool feed_read = state_.motion.sequencer().feed_read();
  clock_part(state_.checker, checker_inputs(cut));
  clock_part(state_.geometry_queue,
             {false, cut, was.geometry_write, was.halfword, was.geometry_commit, was.drop, geometry_read});
  clock_part(state_.feed_queue, {false, cut, was.feed_write, was.halfword, was.feed_commit, was.drop, feed_read});
  clock_part(state_.registers, state_.shown);
  request({}, false);
  clock_part(state_.watermarks, watermarks);
  clock_part(state_.motion, motion);
  record(cut);
  show();
}

}  // namespace trammel::model
