// Golden model of the sequencers: they decode queued commands, begin decoded ones, and count the ticks of those that
// run.
//
// Geometry and feed each decode one command ahead. A path runs for its N ticks, a piece for its own number. Every
// tick taken counts both down, and the last tick of either swaps in the decoded successor. A tick made by the feed
// generator (in direct mode: an enabled clock) is owed from two clocks later on until a path can take it. A path on
// an engine ends when the engine has finished its path ticks; a direct move ends when no axis is live. A barrier
// (DWELL, END) begins when both queues have reached it; a WAIT_INPUT ends with its input, a PROBE_END as soon as it
// may. In position streaming a line without a successor continues beyond its ticks (it is stale), and so does a piece
// (it is spent). A halt ends path and piece. While commands are dropped, each one ends as it is decoded, and counts
// as begun. Decisions of clock c show at c+1; the constants below give the other times. Not thread-safe; no errors
// are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/command_fetch.hpp"
#include "trammel/model/position_streaming.hpp"

namespace trammel::model {

class Sequencer {
 public:
  struct Inputs {
    bool cut = false;
    // queues
    bool geometry_empty = true;
    bool feed_empty = true;
    std::uint16_t geometry_word = 0;
    std::uint16_t feed_word = 0;
    bool wait = false;         // no piece may begin
    bool shut = false;         // no tick may be taken
    bool closing = false;      // a cut is due: no path may begin
    bool drives_wait = false;  // no tick may be taken or made
    // position streaming
    Setting setting;
    bool arrives = false;  // a halfword of a command arrives
    bool arrived = false;  // the command is complete, or dropped
    bool at_rest = true;   // all blocks behind the sequencers are at rest
    // probe
    bool halt = false;         // event: path and piece end here
    bool drop = false;         // commands up to PROBE_END are not executed
    bool probe_taken = false;  // the decoded PROBE is taken
    bool met = false;          // the condition decoded last is met
    bool stays = false;        // PROBE_END must wait
    // direct loader
    bool direct_go = false;
    std::uint8_t direct_mask = 0;
    LoadWord direct_load;
    // time
    bool enable = false;
    bool feed_tick = false;
    // path engines and axes
    bool engine_ready = true;
    bool payload_ready = true;
    bool shadows_free = true;  // the axes' increments may be loaded
    bool engine_done = false;
    bool missed_end = false;
    bool axes_live = false;
  };
  struct Outputs {
    bool tick = false;                               // a tick was taken
    bool swap = false;                               // a path begins
    std::uint8_t active = 0;                         // axes of a path whose generators step; sampled with swap, holds
    std::uint8_t engine = card_map::engine::kLines;  // engine of the path; sampled with swap, holds
    bool direct = false;
    bool feed_enable = false;
    bool feed_clear = true;
    bool feed_swap = false;  // a piece begins
    bool mismatch = false;   // event: one queue is at a barrier, the other still has ticks
    bool incomplete = false;
    bool over = false;  // event: a path has ended; of a line, the last tick was taken
    bool path_active = false;
    bool feed_active = false;
    bool stale = false;                                         // the line has given its ticks and continues
    bool spent = false;                                         // the piece has given its ticks and continues
    bool moving = false;                                        // the piece has given ticks, or follows one that had
    std::uint8_t piece_class = card_map::constant::kClassFeed;  // of the last piece; a direct move's is feed
    std::uint8_t slew_shift = 0;  // of the last piece: doublings of the slew; a direct move has none
    bool silent = false;          // the last piece's ticks make no steps
    bool ended = false;
    bool idle = true;  // nothing runs, is decoded or queued
    std::uint32_t geometry_begun = 0;
    std::uint32_t feed_begun = 0;
  };
  // For the record of steps: events since the last clock.
  struct Record {
    bool command = false;  // a geometry command has begun
    bool direct = false;   // a direct move has begun
  };
  enum class Path : std::uint8_t { None, Line, Engine, Direct };
  enum class Barrier : std::uint8_t { None, Beginning, Running, Done };
  // Clocks from the end of a silent piece, and of the steps that the engines make of it, to the end of the silence. A
  // step reaches the axes' gate 10 clocks after its tick is taken; an engine's step 3 clocks after engine_done shows.
  static constexpr unsigned kSettleClocks = 16;
  // All that the next clock() depends on besides its inputs.
  struct State {
    CommandFetch geometry{CommandFetch::Queue::Geometry};
    CommandFetch feed{CommandFetch::Queue::Feed};
    PositionStreaming streaming;
    std::uint64_t now = 0;
    LoadWord load;
    std::uint64_t path_count = 0;   // shift chain: tick count of the next path or barrier
    std::uint64_t piece_count = 0;  // shift chain: tick count of the next piece
    Path path = Path::None;
    bool drained = false;          // the last tick of the path is taken
    std::uint64_t path_left = 0;   // ticks that the path has still to take
    std::uint64_t drained_at = 0;  // clock in which the last tick was taken
    std::uint64_t piece_left = 0;
    unsigned settled = 0;          // clocks
    unsigned owed = 0;             // ticks that were made but not taken
    bool tick_arrives = false;     // a tick is owed from the next clock on
    bool geometry_stands = false;  // geometry has reached a barrier
    bool feed_stands = false;      // feed has reached a barrier
    Barrier barrier = Barrier::None;
    std::uint64_t barrier_at = 0;  // clock in which the barrier begins, then the last clock of the barrier
    bool geometry_idle = true;
    bool path_begun = false;   // a path began in the previous clock
    bool piece_begun = false;  // a piece began in the previous clock
    Outputs out;
    Record record;
  };

  // `streaming`: the card has position streaming.
  explicit Sequencer(bool streaming = true) : has_streaming_(streaming) {}

  // One rising edge.
  void clock(const Inputs& in);

  // True if the path is on an engine and still takes feed ticks.
  bool engine_taken() const {
    return state_.path == Path::Engine && (!state_.drained || state_.now < state_.drained_at + kEngineJudged);
  }

  // True if an OUTPUT, a MARK or a PWM is taken in this clock.
  bool takes_output(bool drop) const { return state_.geometry.decoded() && state_.geometry.is_output() && !drop; }
  bool takes_mark(bool drop) const { return state_.geometry.decoded() && state_.geometry.is_mark() && !drop; }
  bool takes_pwm(bool drop) const { return state_.geometry.decoded() && state_.geometry.is_pwm() && !drop; }
  // True if a PROBE is decoded and no path runs; if a WAIT_INPUT has begun; if a PROBE_END has begun.
  bool probe_waits() const {
    return state_.geometry.decoded() && state_.geometry.is_probe() && state_.path == Path::None;
  }
  bool waits_for_input() const { return state_.barrier == Barrier::Running && state_.geometry.is_wait(); }
  bool probe_ends() const { return state_.barrier == Barrier::Running && state_.geometry.is_probe_end(); }
  // True if a geometry command is dropped in this clock.
  bool geometry_drops(const Inputs& in) const {
    return in.drop && state_.geometry.decoded() && !state_.geometry.is_probe_end();
  }
  // True if a tick is taken in this clock.
  bool takes(const Inputs& in) const;
  // The part of clock() that counts ticks made, owed and taken.
  void clock_ticks(const Inputs& in, bool take);
  // Ticks that the path under way has still to take; 0 if there is none.
  std::uint64_t ticks_to_come() const { return unfinished() ? state_.path_left & kCountMask : 0; }
  bool unfinished() const { return state_.path != Path::None && !state_.drained; }
  bool piece_silent() const { return (state_.feed.flags() & card_map::constant::kPieceSilent) != 0; }
  bool piece_waits() const { return state_.feed.decoded() && state_.feed.is_feed(); }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  const Record& record() const { return state_.record; }
  const PositionStreaming::Outputs& streaming() const { return state_.streaming.outputs(); }
  bool geometry_read() const { return state_.geometry.read(); }
  bool feed_read() const { return state_.feed.read(); }
  // True if a path takes each tick of its piece as it comes.
  bool ticking() const {
    return (state_.path == Path::Line || state_.path == Path::Engine) && !state_.drained && state_.out.feed_active;
  }
  // Ticks until the path or its piece ends, including the last one.
  std::uint64_t ticks_left() const {
    return state_.out.spent || state_.path_left < state_.piece_left ? state_.path_left : state_.piece_left;
  }

  const LoadWord& load() const { return state_.load; }             // the load bus
  const LoadWord& feed_load() const { return state_.feed.bus(); }  // the feed load

  bool mismatches() const;
  bool ticking_path() const { return state_.path == Path::Direct || (state_.path != Path::None && !state_.drained); }
  PositionStreaming::Inputs streaming_inputs(const Inputs& in) const;
  bool barrier_over(const Inputs& in) const;
  bool path_waits() const { return state_.geometry.decoded() && state_.geometry.is_path(); }
  // True if a command is decoded that is taken at once.
  bool instant() const {
    return state_.geometry.decoded() && state_.geometry.is_instant() && !state_.geometry.is_probe();
  }
  bool feed_drops(const Inputs& in) const { return in.drop && state_.feed.decoded() && !state_.feed.is_probe_end(); }
  bool has_streaming() const { return has_streaming_; }

 private:
  static constexpr std::uint64_t kCountMask = (std::uint64_t{1} << 40) - 1;
  // Clocks from the take of the last tick to the judgement of the end: of a path on an engine, of a direct move.
  static constexpr std::uint64_t kEngineJudged = 2;
  static constexpr std::uint64_t kDirectJudged = 9;
  // Clocks from the one in which both queues have reached a barrier to that of the decision, one before it shows.
  static constexpr std::uint64_t kBarrierBegins = 4;

  // The decisions of this clock.
  struct Decision {
    bool take = false;
    bool path_ends = false;  // the last tick of the path is taken
    bool path_over = false;  // a path on an engine or a direct move has finished after its last tick
    bool path_begins = false;
    bool period = false;   // the last tick of a period is taken
    bool goes_on = false;  // with period: no path follows yet, so the line continues
    bool piece_ends = false;
    bool piece_begins = false;
    bool piece_goes_on = false;
    bool barrier_begins = false;
    bool barrier_ends = false;
    bool barrier_done = false;  // the barrier ended in the previous clock: both queues continue
    bool at_probe_end = false;
    bool path_dropped = false;  // the decoded geometry command, of any kind, is dropped
    bool piece_dropped = false;
    bool payload_ready = false;
    bool piece_runs = false;
    bool direct = false;  // a direct move is under way
  };

  Decision decide(const Inputs& in) const;
  bool judged(const Inputs& in) const;
  void stand(const Decision& d);
  void clock_path(const Inputs& in, const Decision& d);
  void clock_piece(const Decision& d);
  void clock_silence(const Inputs& in, const Decision& d);
  void clock_streaming(const Inputs& in, const Decision& d);
  void clock_barrier(const Decision& d);
  void clock_fetches(const Inputs& in, const Decision& d);
  void count_begun(const Inputs& in, const Decision& d, bool path_drops, bool piece_drops);
  bool drop_counts(const CommandFetch& fetch, bool dropped) const;
  void halt(const Decision& d);
  void cut();

  bool has_streaming_;

  State state_;
};

}  // namespace trammel::model
