// Golden model of the card's core: everything between the inner register port and the pins, cycle by cycle.
//
// clock() is one rising edge. It reports steps as they appear: a step at the pins in the cycle of its leading edge, a
// step of the path before it enters the shaper. Not thread-safe; only the constructor reports errors.
#pragma once

#include <cstdint>

#include "trammel/model/captures.hpp"
#include "trammel/model/card_inputs.hpp"
#include "trammel/model/command_checker.hpp"
#include "trammel/model/emergency_stop.hpp"
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
  std::uint32_t engines = RegisterFile::kDefaultEngines;  // mask of the engines that are built in
  unsigned ports = 1;                                     // 1 .. 4
  unsigned inputs = 4;                                    // 1 .. 32; only for cards with path commands
  unsigned outputs = 4;
  unsigned captures = 4;             // 1 .. 4 units; only for cards with captures
  std::uint16_t output_idle = 0;     // strap: levels of the outputs in reset
  std::uint32_t idle_level = 0;      // strap: {second pins, first pins}, `axes` bits each
  bool emergency_stop_level = true;  // strap: the level at its pin that means stop
  std::uint32_t build_id = 0;
  bool build_dirty = false;
  std::uint32_t board_id = 0;
};

class CoreModel {
 public:
  using Config = CardConfig;

  // The inner register port.
  struct Inputs {
    bool rst = false;  // registered: takes effect one clock later
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint8_t port = 0;
    std::uint32_t address = 0;  // bytes, 12 bits
    std::uint32_t data = 0;
    bool of_session = true;  // as in PortArbiter::Access
    bool new_session = false;
    std::uint32_t pins = 0;       // inputs of the card
    bool emergency_stop = false;  // level at its pin
  };
  struct Answer {
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };
  // The pins, and the signals that the core shows in addition to the port (observe_o; positions: position()).
  struct Outputs {
    std::uint32_t step = 0;  // pins, a bit per axis
    std::uint32_t dir = 0;
    std::uint32_t output = 0;  // outputs of the card
    bool irq = false;
    bool tick = false;  // event in the feed domain: a tick was taken
    bool path_tick = false;
    bool path_swap = false;  // event in the feed domain: a path begins
    bool feed_swap = false;
    std::uint32_t path_step = 0;  // a bit per axis
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

  // All that the next clock() depends on besides its inputs, and the record of steps.
  struct State {
    RegisterFile registers;
    CommandChecker checker;
    HalfwordQueue geometry_queue;
    HalfwordQueue feed_queue;
    QueueWatermarks watermarks;
    CardInputs inputs;
    EmergencyStop emergency_stop;
    MotionCore motion;
    Captures captures;
    std::uint64_t cycles = 0;
    bool reset_due = false;
    StepRecord record{};
    Answer answer{};
    Outputs out{};
    RegisterFile::Inputs
        shown{};  // inputs of the register file; requests and other one-clock fields are set only during their clock
  };

  // One rising edge.
  void clock(const Inputs& in) { clock_parts(in, ClockEach()); }
  template <class ClockPart>
  void clock_parts(const Inputs& in, const ClockPart& clock_part);

  const State& state() const { return state_; }
  State& state() { return state_; }
  // The inputs of the parts.
  MotionCore::Inputs motion_inputs() const;
  CardInputs::Inputs pin_inputs(std::uint32_t pins) const { return {pins, state_.registers.outputs().setting}; }
  EmergencyStop::Inputs emergency_inputs(bool pin) const;
  QueueWatermarks::Inputs watermark_inputs() const;
  Captures::Inputs capture_inputs() const;
  // Copies the outputs of the parts to the outputs of the core.
  void show();

  const Answer& answer() const { return state_.answer; }
  const Outputs& outputs() const { return state_.out; }
  std::uint32_t position(unsigned axis) const { return state_.motion.position(axis); }
  const Config& config() const { return config_; }
  std::uint64_t cycles() const { return state_.cycles; }
  bool has_emergency_stop() const { return card_map::has_engine(config_.engines, card_map::engine::kEmergencyStop); }
  // output_levels(): levels of the outputs without PWM pulses; output_pins(): levels at their pins.
  std::uint16_t output_levels() const { return state_.motion.output_levels(state_.emergency_stop.latched()); }
  std::uint16_t output_pins() const { return state_.motion.output_pins(state_.emergency_stop.latched()); }
  void set_steps(CardSteps* steps) { state_.record.set_steps(steps); }  // nullptr: none; not owned

 private:
  void reset(bool emergency_stop);
  CommandChecker::Inputs checker_inputs(bool cut) const;
  void request(const Inputs& access, bool probe, bool rest, std::uint8_t captures) {
    state_.shown.request = access.request;
    state_.shown.write = access.write;
    state_.shown.partial = access.partial;
    state_.shown.port = access.port;
    state_.shown.address = access.address;
    state_.shown.data = access.data;
    state_.shown.of_session = access.of_session;
    state_.shown.new_session = access.new_session;
    state_.shown.probe = probe;
    state_.shown.rest = rest;
    state_.shown.captures = captures;
  }
  void show_registers();
  void record(bool cut);

  Config config_;
  State state_;
};

// The queues see the checker's outputs from before the edge, and the checker sees the queues' rooms from before the
// edge.
template <class ClockPart>
void CoreModel::clock_parts(const Inputs& in, const ClockPart& clock_part) {
  const bool reset_now = state_.reset_due;
  state_.reset_due = in.rst;
  if (reset_now) return reset(in.emergency_stop);
  ++state_.cycles;
  const bool cut = state_.motion.stop().cut;
  const MotionCore::Inputs motion = motion_inputs();
  const CardInputs::Inputs pins = pin_inputs(in.pins);
  const EmergencyStop::Inputs emergency = emergency_inputs(in.emergency_stop);
  const QueueWatermarks::Inputs watermarks = watermark_inputs();
  Captures::Inputs captures = capture_inputs();
  const std::uint8_t asks = state_.captures.asks(captures);
  captures.captured = state_.registers.captured(asks);
  captures.queued = state_.registers.queued(state_.shown.passed);
  captures.full = state_.registers.state().queue.full();
  request(in, state_.motion.probe_asks(motion), state_.motion.rests(motion), asks);
  const CommandChecker::Outputs was = state_.checker.outputs();
  const bool geometry_read = state_.motion.sequencer().geometry_read();
  const bool feed_read = state_.motion.sequencer().feed_read();
  clock_part(state_.checker, checker_inputs(cut));
  clock_part(state_.geometry_queue,
             {false, cut, was.geometry_write, was.halfword, was.geometry_commit, was.drop, geometry_read});
  clock_part(state_.feed_queue, {false, cut, was.feed_write, was.halfword, was.feed_commit, was.drop, feed_read});
  clock_part(state_.registers, state_.shown);
  request({}, false, false, 0);
  clock_part(state_.watermarks, watermarks);
  clock_part(state_.motion, motion);
  clock_part(state_.captures, captures);
  clock_part(state_.inputs, pins);
  if (has_emergency_stop()) clock_part(state_.emergency_stop, emergency);
  record(cut);
  show();
}

}  // namespace trammel::model
