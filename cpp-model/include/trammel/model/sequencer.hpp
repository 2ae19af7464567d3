// Golden model of the sequencer: which tick is taken when, which command runs, where both queues meet, what stops.
//
// A path begins with a swap and has N ticks; the clock of its last one swaps the next path in where it is decoded and
// the present one is a line. Arcs drain first: their path ticks come later than the feed ticks. Direct moves go on
// until no axis is live. A tick is taken in clock c, shows at the output in c+1 and makes a step there three clocks
// later. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/model/barrier.hpp"
#include "trammel/model/command_fetch.hpp"
#include "trammel/model/tick_counter.hpp"
#include "trammel/model/tick_gate.hpp"

namespace trammel::model {

class Sequencer {
 public:
  struct Inputs {
    bool reset = false;
    bool abort = false;
    // queues
    bool geometry_empty = true;
    bool feed_empty = true;
    std::uint16_t geometry_word = 0;
    std::uint16_t feed_word = 0;
    // direct move
    std::uint16_t direct_word = 0;
    std::uint8_t direct_axis = 0;
    bool direct_increment = false;
    bool direct_steps = false;
    bool direct_length = false;
    bool direct_go = false;
    std::uint8_t direct_mask = 0;
    // time
    bool enable = false;
    bool feed_tick = false;
    // engines
    bool axes_live = false;
    bool prescaler_step = false;
    bool engine_ready = false;
    bool engine_at_end = false;
    bool faulted = false;

    // True when only `enable` may differ.
    bool same_but_enable(const Inputs& o) const {
      return feed_tick == o.feed_tick && geometry_empty == o.geometry_empty && feed_empty == o.feed_empty &&
             geometry_word == o.geometry_word && feed_word == o.feed_word && engine_ready == o.engine_ready &&
             engine_at_end == o.engine_at_end && prescaler_step == o.prescaler_step && axes_live == o.axes_live &&
             faulted == o.faulted && direct_go == o.direct_go && direct_increment == o.direct_increment &&
             direct_steps == o.direct_steps && direct_length == o.direct_length && direct_word == o.direct_word &&
             direct_axis == o.direct_axis && direct_mask == o.direct_mask && abort == o.abort && reset == o.reset;
    }
  };
  struct Outputs {
    bool tick = false;
    bool swap = false;
    std::uint8_t active = 0;  // axes; sampled with swap, holds
    bool prescaler = false;   // the path is an arc; sampled with swap, holds
    bool arc_start = false;
    bool direct = false;
    bool feed_enable = false;
    bool feed_clear = true;
    bool feed_swap = false;
    bool mismatch = false;
    bool incomplete = false;
    bool path_active = false;
    bool feed_active = false;
    bool ended = false;
    bool idle = true;  // nothing runs, is decoded or queued
    std::uint8_t geometry_number = 0;
    std::uint8_t feed_number = 0;
  };

  // One rising edge. Between two ticks of a path only the generator's enable moves.
  void clock(const Inputs& in) {
    if (calm_ == kCalm && in.same_but_enable(last_in_)) {
      out_.feed_enable = in.enable && out_.feed_active && taking_ && go_;
      return;
    }
    work(in);
  }

  const Outputs& outputs() const { return out_; }
  bool geometry_read() const { return geometry_.read(); }
  bool feed_read() const { return feed_.read(); }
  bool path_tick() const { return path_gate_.tick(); }
  bool go() const { return go_; }
  // The load bus of geometry and direct moves, and that of the feed generator.
  const LoadBus& load() const { return load_; }
  const LoadBus& feed_load() const { return feed_.load(); }

  // For the record of steps: what happened in the last clock.
  bool took() const { return took_; }            // a tick was taken
  bool began_command() const { return began_; }  // a geometry command was taken up
  bool began_direct() const { return began_direct_; }

  // Nothing is on its way: without a tick, an input that changes or an access, clock() changes nothing but a dwell's
  // count.
  bool quiet(const Inputs& in) const;
  // A path runs on feed ticks and takes each at once: ticks up to silent_ticks() change no more than the counters.
  bool cruising() const { return taking_ && out_.feed_active && go_ && !out_.direct && !drain_; }
  // Cruising, or no tick can come.
  bool cruising_or_still() const { return cruising() || !(out_.feed_enable || out_.direct || drain_); }
  std::uint64_t silent_ticks() const;
  // `ticks` of them at once; `feed_enable`: the generator's enable behind them.
  void take_silently(std::uint64_t ticks, bool feed_enable) {
    path_left_.advance(ticks);
    if (out_.feed_active) feed_left_.advance(ticks);
    out_.feed_enable = feed_enable;
  }

  // A dwell counts; clocks of it before its end comes near; and those clocks at once.
  bool dwelling() const { return barrier_.counting(); }
  std::uint64_t dwell_clocks() const;
  void dwell(std::uint64_t clocks) { path_left_.advance(clocks); }

 private:
  // Quiet clocks with the same inputs behind which nothing but the enable moves any more.
  static constexpr int kCalm = 2;

  struct Wires;
  void work(const Inputs& in);
  void step_path(const Inputs& in, const Wires& w);
  void step_feed(const Inputs& in, const Wires& w);
  void step_faults(const Inputs& in, bool event);
  void shift_count(std::uint64_t& chain, std::uint16_t word) { chain = chain >> 16 | std::uint64_t{word} << 32; }

  CommandFetch geometry_;
  CommandFetch feed_;
  LoadBus load_;
  TickGate gate_;
  PathTickGate path_gate_;
  TickCounter path_left_;
  TickCounter feed_left_;
  Barrier barrier_;
  std::uint64_t path_chain_ = 0;  // next count (40 bits) and number (8 bits)
  std::uint64_t feed_chain_ = 0;

  bool idle_ = true;  // no path
  bool taking_ = false;
  bool drain_ = false;  // the last tick is taken, the engine still works
  bool arc_ = false;
  bool settled_ = false;
  int settle_ = 0;
  bool geometry_at_ = false;
  bool feed_at_ = false;
  bool geometry_idle_ = true;
  bool source_tick_ = false;
  bool go_ = true;
  bool fault_seen_ = false;
  bool abort_due_ = false;
  bool took_ = false;
  bool began_ = false;
  bool began_direct_ = false;
  int calm_ = 0;
  Inputs last_in_;
  Outputs out_;
};

}  // namespace trammel::model
