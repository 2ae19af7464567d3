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
    bool wait = false;  // no piece begins
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
    bool elsewhere = false;
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

  // `clock_all`: it never rests. `streaming`: it can be switched on.
  explicit Sequencer(bool clock_all = false, bool streaming = true)
      : clock_all_(clock_all),
        has_streaming_(streaming),
        geometry_(CommandFetch::Queue::Geometry, clock_all),
        feed_(CommandFetch::Queue::Feed, clock_all) {}

  // One rising edge. Between the ticks that end something only counters move.
  void clock(const Inputs& in);

  // The path is on an engine and still takes feed ticks.
  bool engine_taken() const { return path_ == Path::Engine && (!drained_ || now_ < drained_at_ + kEngineJudged); }

  // An OUTPUT, a MARK is taken in this clock.
  bool takes_output(bool drop) const { return geometry_.decoded() && geometry_.is_output() && !drop; }
  bool takes_mark(bool drop) const { return geometry_.decoded() && geometry_.is_mark() && !drop; }
  // A PROBE is decoded and no path runs; a WAIT_INPUT, a PROBE_END has begun.
  bool probe_waits() const { return geometry_.decoded() && geometry_.is_probe() && path_ == Path::None; }
  bool waits_for_input() const { return barrier_ == Barrier::Running && geometry_.is_wait(); }
  bool probe_ends() const { return barrier_ == Barrier::Running && geometry_.is_probe_end(); }
  // A geometry command is dropped in this clock.
  bool geometry_drops(const Inputs& in) const { return in.drop && geometry_.decoded() && !geometry_.is_probe_end(); }
  // A tick is taken in this clock.
  bool takes(const Inputs& in) const;
  bool piece_waits() const { return feed_.decoded() && feed_.is_feed(); }

  const Outputs& outputs() const { return out_; }
  const Record& record() const { return record_; }
  const PositionStreaming::Outputs& streaming() const { return streaming_.outputs(); }
  bool geometry_read() const { return geometry_.read(); }
  bool feed_read() const { return feed_.read(); }
  // For jumps. settled(): with these inputs, the enables and the ticks made apart, only counters move.
  bool settled(const Inputs& in) const;
  // A path takes each tick of its piece as it comes.
  bool ticking() const { return (path_ == Path::Line || path_ == Path::Engine) && !drained_ && out_.feed_active; }
  // Ticks until the path or its piece ends, the last one included.
  std::uint64_t ticks_left() const { return out_.spent || path_left_ < piece_left_ ? path_left_ : piece_left_; }
  // Clocks that a settled sequencer may jump over at most, ticks apart.
  std::uint64_t settled_clocks() const {
    return barrier_ == Barrier::Running && barrier_at_ > now_ ? barrier_at_ - now_ : kLong;
  }
  // Ticks on their way: bit k was made by an accumulation k clocks ago.
  unsigned in_flight() const {
    return (tick_arrives_ ? 1U << kArrives : 0) | (owed_ != 0 ? 1U << kOwed : 0) | (out_.tick ? 1U << kTaken : 0);
  }
  // `clocks` at once in which `ticks` are taken, none of them a last one; what is then on its way.
  void jump(std::uint64_t clocks, std::uint64_t ticks, unsigned in_flight, bool feed_enable);
  static constexpr unsigned kArrives = 3;  // clocks from an accumulation
  static constexpr unsigned kOwed = 4;
  static constexpr unsigned kTaken = 5;

  const LoadWord& load() const { return load_; }             // the load bus
  const LoadWord& feed_load() const { return feed_.bus(); }  // the feed load

 private:
  static constexpr std::uint64_t kCountMask = (std::uint64_t{1} << 40) - 1;
  // From the take of the last tick: the clock in which the end on an engine may be judged, and a direct move's.
  static constexpr std::uint64_t kEngineJudged = 2;
  static constexpr std::uint64_t kDirectJudged = 9;
  // From the clock in which both queues stand at a barrier: that in which it is decided, one before it shows.
  static constexpr std::uint64_t kBarrierBegins = 4;

  static constexpr std::uint64_t kLong = std::uint64_t{1} << 62;

  enum class Path : std::uint8_t { None, Line, Engine, Direct };
  enum class Barrier : std::uint8_t { None, Beginning, Running, Done };

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

  void clock_all(const Inputs& in);
  bool calm(const Inputs& in) const;
  Decision decide(const Inputs& in) const;
  bool judged(const Inputs& in) const;
  bool mismatches() const;
  bool ticking_path() const { return path_ == Path::Direct || (path_ != Path::None && !drained_); }
  PositionStreaming::Inputs streaming_inputs(const Inputs& in) const;
  bool barrier_over(const Inputs& in) const;
  bool path_waits() const { return geometry_.decoded() && geometry_.is_path(); }
  // A command that is taken at once.
  bool instant() const { return geometry_.decoded() && geometry_.is_instant() && !geometry_.is_probe(); }
  void stand(const Decision& d);
  void clock_path(const Inputs& in, const Decision& d);
  void clock_piece(const Decision& d);
  void clock_streaming(const Inputs& in, const Decision& d);
  void clock_barrier(const Decision& d);
  void clock_ticks(const Inputs& in, bool take);
  void clock_fetches(const Inputs& in, const Decision& d);
  void count_begun(const Inputs& in, const Decision& d, bool path_drops, bool piece_drops);
  bool drop_counts(const CommandFetch& fetch, bool dropped) const;
  bool feed_drops(const Inputs& in) const { return in.drop && feed_.decoded() && !feed_.is_probe_end(); }
  void halt(const Decision& d);
  void cut();

  bool clock_all_;
  bool has_streaming_;
  bool calm_ = false;  // as of the last clock, with inputs as these flags say
  unsigned calm_inputs_ = 0;
  std::uint64_t now_ = 0;
  CommandFetch geometry_;
  CommandFetch feed_;
  LoadWord load_;
  std::uint64_t path_count_ = 0;  // chains: count of the next path or barrier, of the next piece
  std::uint64_t piece_count_ = 0;

  Path path_ = Path::None;
  bool drained_ = false;          // its last tick is taken
  std::uint64_t path_left_ = 0;   // ticks
  std::uint64_t drained_at_ = 0;  // the clock of that take
  std::uint64_t piece_left_ = 0;
  unsigned owed_ = 0;          // ticks
  bool tick_arrives_ = false;  // owed from the next clock on

  bool geometry_stands_ = false;  // at a barrier
  bool feed_stands_ = false;
  Barrier barrier_ = Barrier::None;
  std::uint64_t barrier_at_ = 0;  // the clock in which it begins; its last one
  bool geometry_idle_ = true;
  bool path_begun_ = false;  // in the clock before
  bool piece_begun_ = false;
  bool cut_before_ = false;

  PositionStreaming streaming_;
  Outputs out_;
  Record record_;
};

}  // namespace trammel::model
