// Golden model of the card's core: everything between the inner register port and the pins, cycle by cycle.
//
// clock() is one rising edge; run(n) is n edges without requests, which goes from step to step where nothing else
// happens, and leaves exactly the state that n calls of clock() leave. Steps are reported as they appear: at the pins
// in the cycle of their leading edge, on the path before the shapers. Not thread-safe; no errors are reported beside
// the constructor's.
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
  // Model alone: clocks every block in every clock, the reference for the one that lets idle blocks rest.
  bool clock_all = false;
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

  // One rising edge.
  void clock(const Inputs& in);

  // `clocks` edges without requests, with these levels at the inputs.
  void run(std::uint64_t clocks, std::uint16_t pins = 0);
  // Edges at once without requests, `limit` at most; 0 where it is not worth it.
  std::uint64_t jump(std::uint64_t limit, std::uint16_t pins = 0);

  const Answer& answer() const { return answer_; }
  const Outputs& outputs() const { return out_; }
  std::uint32_t position(unsigned axis) const { return motion_.position(axis); }
  const Config& config() const { return config_; }
  std::uint64_t cycles() const { return cycles_; }
  void set_steps(CardSteps* steps) { record_.set_steps(steps); }  // nullptr: none; not owned

 private:
  void reset();
  MotionCore::Inputs motion_inputs(std::uint16_t pins) const;
  QueueWatermarks::Inputs watermark_inputs() const;
  void clock_commands(bool cut);
  void clock_registers(const Inputs& in, bool probe);
  void gather();
  std::uint64_t watched() const;
  void show();
  void record(bool cut);

  Config config_;
  std::uint64_t cycles_ = 0;
  bool reset_due_ = false;

  RegisterFile registers_;
  CommandChecker checker_;
  HalfwordQueue geometry_queue_;
  HalfwordQueue feed_queue_;
  QueueWatermarks watermarks_;
  MotionCore motion_;
  RegisterFile::Inputs register_in_;  // but for the port's: what stood as it was last awake
  std::uint64_t watched_ = 0;
  int awake_ = 0;  // clocks for which the register file is clocked whatever it says

  StepRecord record_;
  Answer answer_;
  Outputs out_;
};

}  // namespace trammel::model
