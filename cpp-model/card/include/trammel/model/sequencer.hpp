// Golden model of the sequencers: what is queued becomes decoded, what is decoded begins, what runs counts ticks.
//
// Geometry and feed each decode one command ahead. A path runs for its N ticks, a piece for its own; every tick taken
// counts both down, and the last one of either swaps in what is decoded. A tick made by the feed generator (in direct
// mode: an enabled clock) is owed from two clocks on until a path can take it. A path on an engine is over when
// that has finished its path ticks, a direct move when no axis is live. A barrier (DWELL, END) begins when both queues
// stand at it; a WAIT_INPUT ends with its input, a PROBE_END when it may. In position streaming a line with nothing
// behind it goes on beyond its ticks (it is stale), and so does a piece (it is spent). A halt ends path and piece;
// while commands are dropped, each is over as it is decoded, and counts as begun. Everything decided in clock c shows
// at c+1; other times stand with their constants. Not thread-safe; no errors are reported.
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
    bool wait = false;         // no piece begins
    bool shut = false;         // no tick is taken
    bool closing = false;      // a cut is due: no path begins
    bool drives_wait = false;  // no tick is taken, nor made
    // position streaming
    Setting setting;
    bool arrives = false;  // a halfword of a command comes in
    bool arrived = false;  // it is whole, or dropped
    bool at_rest = true;   // of what runs behind the sequencers
    // probe
    bool halt = false;         // event: path and piece end here
    bool drop = false;         // commands up to PROBE_END are not carried out
    bool probe_taken = false;  // the PROBE that is decoded
    bool met = false;          // the condition decoded last
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
    std::uint8_t engine = card_map::engine::kLines;  // what the path runs on; sampled with swap, holds
    bool direct = false;
    bool feed_enable = false;
    bool feed_clear = true;
    bool feed_swap = false;  // a piece begins
    bool mismatch = false;   // events
    bool incomplete = false;
    bool over = false;  // a path has ended; on lines its last tick was taken
    bool path_active = false;
    bool feed_active = false;
    bool stale = false;   // the line has given its ticks and goes on
    bool spent = false;   // so has the piece
    bool moving = false;  // the piece has given ticks, or took over from one that had
    std::uint8_t piece_class = card_map::constant::kClassFeed;  // of the last piece; a direct move's is feed
    std::uint8_t slew_shift = 0;  // of the last piece: doublings of the slew; a direct move has none
    bool silent = false;          // the last piece's ticks make no steps
    bool ended = false;
    bool idle = true;  // nothing runs, is decoded or queued
    std::uint32_t geometry_begun = 0;
    std::uint32_t feed_begun = 0;
  };
  // For the record of steps: what shows since the last clock.
  struct Record {
    bool command = false;  // a geometry command has begun
    bool direct = false;   // a direct move has begun
  };
  enum class Path : std::uint8_t { None, Line, Engine, Direct };
  enum class Barrier : std::uint8_t { None, Beginning, Running, Done };
  // From the end of a silent piece, and of what the engines make of it, to the end of the silence: a step comes to the
  // axes' gate 10 clocks after its tick is taken, an engine's 3 clocks after engine_done shows.
  static constexpr unsigned kSettleClocks = 16;
  // All that the next clock() depends on beside its inputs.
  struct State {
    CommandFetch geometry{CommandFetch::Queue::Geometry};
    CommandFetch feed{CommandFetch::Queue::Feed};
    PositionStreaming streaming;
    std::uint64_t now = 0;
    LoadWord load;
    std::uint64_t path_count = 0;  // chains: count of the next path or barrier, of the next piece
    std::uint64_t piece_count = 0;
    Path path = Path::None;
    bool drained = false;          // its last tick is taken
    std::uint64_t path_left = 0;   // ticks
    std::uint64_t drained_at = 0;  // the clock of that take
    std::uint64_t piece_left = 0;
    unsigned settled = 0;          // clocks
    unsigned owed = 0;             // ticks
    bool tick_arrives = false;     // owed from the next clock on
    bool geometry_stands = false;  // at a barrier
    bool feed_stands = false;
    Barrier barrier = Barrier::None;
    std::uint64_t barrier_at = 0;  // the clock in which it begins; its last one
    bool geometry_idle = true;
    bool path_begun = false;  // in the clock before
    bool piece_begun = false;
    Outputs out;
    Record record;
  };

  // `streaming`: it can be switched on.
  explicit Sequencer(bool streaming = true) : has_streaming_(streaming) {}

  // One rising edge.
  void clock(const Inputs& in);

  // The path is on an engine and still takes feed ticks.
  bool engine_taken() const {
    return state_.path == Path::Engine && (!state_.drained || state_.now < state_.drained_at + kEngineJudged);
  }

  // An OUTPUT, a MARK, a PWM is taken in this clock.
  bool takes_output(bool drop) const { return state_.geometry.decoded() && state_.geometry.is_output() && !drop; }
  bool takes_mark(bool drop) const { return state_.geometry.decoded() && state_.geometry.is_mark() && !drop; }
  bool takes_pwm(bool drop) const { return state_.geometry.decoded() && state_.geometry.is_pwm() && !drop; }
  // A PROBE is decoded and no path runs; a WAIT_INPUT, a PROBE_END has begun.
  bool probe_waits() const {
    return state_.geometry.decoded() && state_.geometry.is_probe() && state_.path == Path::None;
  }
  bool waits_for_input() const { return state_.barrier == Barrier::Running && state_.geometry.is_wait(); }
  bool probe_ends() const { return state_.barrier == Barrier::Running && state_.geometry.is_probe_end(); }
  // A geometry command is dropped in this clock.
  bool geometry_drops(const Inputs& in) const {
    return in.drop && state_.geometry.decoded() && !state_.geometry.is_probe_end();
  }
  // A tick is taken in this clock.
  bool takes(const Inputs& in) const;
  // Ticks made, owed and taken: a part of clock().
  void clock_ticks(const Inputs& in, bool take);
  // Ticks that the path under way has not taken yet; 0 where none is.
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
  // A path takes each tick of its piece as it comes.
  bool ticking() const {
    return (state_.path == Path::Line || state_.path == Path::Engine) && !state_.drained && state_.out.feed_active;
  }
  // Ticks until the path or its piece ends, the last one included.
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
  // A command that is taken at once.
  bool instant() const {
    return state_.geometry.decoded() && state_.geometry.is_instant() && !state_.geometry.is_probe();
  }
  bool feed_drops(const Inputs& in) const { return in.drop && state_.feed.decoded() && !state_.feed.is_probe_end(); }
  bool has_streaming() const { return has_streaming_; }

 private:
  static constexpr std::uint64_t kCountMask = (std::uint64_t{1} << 40) - 1;
  // From the take of the last tick: the clock in which the end on an engine may be judged, and a direct move's.
  static constexpr std::uint64_t kEngineJudged = 2;
  static constexpr std::uint64_t kDirectJudged = 9;
  // From the clock in which both queues stand at a barrier: that in which it is decided, one before it shows.
  static constexpr std::uint64_t kBarrierBegins = 4;

  // What this clock decides.
  struct Decision {
    bool take = false;
    bool path_ends = false;  // its last tick is taken
    bool path_over = false;  // on an engine or direct: finished after that
    bool path_begins = false;
    bool period = false;   // the last tick of a period is taken
    bool goes_on = false;  // and nothing follows, or nothing has yet
    bool piece_ends = false;
    bool piece_begins = false;
    bool piece_goes_on = false;
    bool barrier_begins = false;
    bool barrier_ends = false;
    bool barrier_done = false;  // ended in the clock before: both queues go on
    bool at_probe_end = false;
    bool path_dropped = false;  // the geometry command that is decoded, whatever it is
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
