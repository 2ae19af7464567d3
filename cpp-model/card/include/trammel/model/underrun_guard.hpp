// Golden model of the under-run hold: holds the time base early enough to stop before the queued motion ends, and
// keeps a piece that would begin from rest waiting until enough is queued.
//
// It decides every 32 clocks (kRound). The queues are short if the queued ticks, of paths or of pieces, are at most
// stop distance * ratio^2 + kUnderrunReserveTicks. They are not short if the last piece ends at rest with its paths
// queued, or if a barrier came last. Commands that a probe drops are not subtracted; from then on the rule is
// suspended until the queues have been empty once. A round samples its inputs in its clocks kRatio, kFactor and
// kCount, and decides at kDecide. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

class UnderrunGuard {
 public:
  // The halfwords and commands that the command checker passes to the queues.
  struct Arrival {
    bool drop = false;
    bool geometry_commit = false;
    bool geometry_write = false;
    bool feed_commit = false;
    bool feed_write = false;
    std::uint16_t halfword = 0;

    bool any() const { return drop || geometry_commit || geometry_write || feed_commit || feed_write; }
  };
  struct Inputs {
    bool cut = false;   // a cut, or a mode without the rule: nothing is counted
    bool lost = false;  // event: queued commands will be dropped
    bool idle = false;  // nothing runs, is decoded or queued; up to four clocks late
    bool gone = false;  // the session that wrote the queued commands is gone: nothing begins or continues
    Arrival arrival;
    bool full = false;        // a queue may have no room for the next command
    LoadWord load;            // feed load
    bool take = false;        // a feed tick is taken
    bool swap = false;        // a piece began in the clock before
    bool active = false;      // a piece gives ticks
    bool decoded = false;     // a decoded piece waits to begin
    std::uint32_t ratio = 0;  // 2^-16, 0..65536
  };
  struct Outputs {
    bool hold = false;
    bool shown = false;  // it holds, or keeps a piece waiting
    std::uint32_t underruns = 0;
  };
  struct Flags {
    bool geometry_short = false;
    bool feed_short = false;
    bool covered = false;  // paths have all the ticks that pieces have, or more
    bool operator==(const Flags& o) const {
      return geometry_short == o.geometry_short && feed_short == o.feed_short && covered == o.covered;
    }
  };
  struct Pending {
    bool any = false;
    bool of_paths = false;
    bool of_pieces = false;
    bool zero = false;
    std::uint64_t ticks = 0;
  };
  static constexpr unsigned kRound = 32;
  static constexpr unsigned kPass = 4;  // clocks; each pass subtracts the ticks taken, or adds those of a command
  static constexpr unsigned kRatio = 0;
  static constexpr unsigned kFactor = 11;
  static constexpr unsigned kProduct = 21;
  static constexpr unsigned kCount = 23;
  static constexpr unsigned kDecide = 29;
  static constexpr unsigned kLag = 7;  // clocks until `idle` includes a command that arrived

  // All that the next clock() depends on besides its inputs.
  struct State {
    bool lost = false;
    bool unknown = false;   // `lost` was set when the counts of the next decision were compared
    bool inside = false;    // part of a command has arrived
    unsigned since = kLag;  // clocks since the last command came
    unsigned round = 0;
    // queued ticks
    std::int64_t paths = 0;
    std::int64_t pieces = 0;
    std::uint64_t owed = 0;  // ticks taken but not yet subtracted
    unsigned index = 0;      // index of the halfword that arrives next
    Pending arriving;
    Pending pending;
    bool at_rest = false;     // the last piece ends at rest
    bool at_barrier = false;  // a barrier came last
    Flags flags;
    // the stop distances of the next piece and of the piece in force
    std::uint32_t next = 0;
    bool next_whole = true;  // both halfwords have arrived
    bool half = false;
    std::uint32_t distance = 0;
    bool ruled = false;  // the distance in force is not 0
    bool due = false;    // `next` must become the distance in force
    // the limit
    std::uint32_t ratio = 0;   // 256ths
    std::uint32_t factor = 0;  // 256ths
    std::uint64_t product = 0;
    // the piece in force and the next one
    bool ends = false;     // the piece in force ends at rest
    bool covered = false;  // paths for all its ticks are queued
    bool from_rest_before = false;
    bool decoded_before = false;
    bool judged = false;   // the next piece is the one that is judged
    bool doubled = false;  // judged against twice the ticks of a stop
    bool enough = false;   // enough is queued for the next piece
    bool waits = false;
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    const bool follow = follows(in.active);
    const bool from_rest = !in.active || state_.ends;
    const bool swap_from_rest = state_.from_rest_before;
    switch (state_.round) {
      case kRatio:
        if (!state_.out.hold) state_.ratio = in_256ths(in.ratio);
        break;
      case kFactor:
        state_.judged = state_.decoded_before && follow;
        state_.doubled = state_.judged && !in.full;
        state_.factor = factor(in.ratio == 0, in.full);
        break;
      case kDecide:
        decide(in, follow);
        break;
      default:
        break;
    }
    const bool still = state_.round > kFactor && state_.round <= kProduct;
    if (state_.round == kProduct) state_.product = product();
    if (!still && (state_.due || follow)) take_distance();
    if (in.swap) {
      state_.due = state_.due || swap_from_rest || !next_zero();
      state_.ends = next_zero();
      state_.covered = state_.judged = state_.enough = state_.waits = false;
    }
    count(in);
    if (in.load.to(feed_target::kStopDistance)) load(in.load.word);
    state_.from_rest_before = from_rest;
    state_.decoded_before = in.decoded;
    forget(in);
    if (in.cut) cut();
    state_.out.shown = state_.out.hold || state_.waits;
    state_.round = (state_.round + 1) % kRound;
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // True if a decoded piece must not begin.
  bool waits(bool active) const { return (!active || state_.ends) && !next_zero() && !state_.enough && !state_.lost; }

  // The quantities that the next round samples and decides, for the present state.
  bool follows(bool active) const { return !active || (state_.ends && state_.covered); }
  bool next_zero() const { return state_.next_whole && state_.next == 0; }
  // The square of the ratio, rounded up. 0 at rest if no more commands can come; doubled during a hold and for a
  // piece that begins.
  std::uint32_t factor(bool standing, bool full) const {
    const std::uint32_t square = (state_.ratio * state_.ratio + 255) / 256;
    if (standing && full) return 0;
    return state_.out.hold || state_.doubled ? 2 * square : square;
  }
  std::uint64_t product() const { return std::uint64_t{state_.distance} * state_.factor / 256; }
  std::int64_t reserved() const {
    return static_cast<std::int64_t>(state_.product) + card_map::constant::kUnderrunReserveTicks;
  }
  Flags compared(std::uint64_t owed) const {
    const auto gone = static_cast<std::int64_t>(owed);
    return {state_.paths - gone <= reserved(), state_.pieces - gone <= reserved(), state_.paths >= state_.pieces};
  }
  bool judged_short() const {
    const bool geometry = state_.flags.geometry_short && !(state_.at_rest && state_.flags.covered);
    return !state_.at_barrier && !state_.lost && !state_.unknown &&
           (geometry || (state_.flags.feed_short && !state_.at_rest));
  }
  bool holds(bool is_short, bool follow, bool full, bool gone) const {
    if (state_.out.hold && gone) return true;
    return is_short && (state_.out.hold || (!state_.doubled && (!follow || (state_.judged && full))));
  }
  // True if the piece that is judged must wait for more commands.
  bool waits_for_more(bool is_short, bool gone) const { return is_short || (gone && state_.ruled); }
  static std::uint32_t in_256ths(std::uint32_t ratio) { return (ratio + 255) / 256; }

 private:
  void decide(const Inputs& in, bool follow) {
    const bool is_short = state_.ruled && judged_short();
    const bool held = state_.out.hold;
    state_.out.hold = holds(is_short, follow, in.full, in.gone);
    if (state_.out.hold && !held) ++state_.out.underruns;
    state_.enough = state_.judged && !waits_for_more(is_short, in.gone);
    state_.waits = state_.judged && !in.active && waits_for_more(is_short, in.gone);
    state_.covered = state_.covered || (state_.flags.covered && !state_.lost && !state_.unknown);
  }

  void take_distance() {
    state_.distance = state_.next;
    state_.ruled = !next_zero();
    state_.due = false;
  }
  void load(std::uint16_t word) {
    state_.next = state_.next >> 16 | std::uint32_t{word} << 16;
    state_.next_whole = state_.half;
    state_.half = !state_.half;
  }

  void count(const Inputs& in) {
    state_.owed += in.take ? 1U : 0U;
    if (state_.round % kPass == kPass - 1) {
      if (state_.pending.any) {
        add();
      } else {
        state_.paths -= static_cast<std::int64_t>(state_.owed);
        state_.pieces -= static_cast<std::int64_t>(state_.owed);
        state_.owed = 0;
      }
    }
    // The counts still include the ticks that the next pass subtracts.
    if (state_.round == kCount) state_.flags = compared(0);
    if (in.arrival.any()) arrive(in.arrival);
  }
  void add() {
    state_.pending.any = false;
    state_.at_barrier = state_.pending.of_paths && state_.pending.of_pieces;
    if (!state_.pending.of_paths) state_.at_rest = state_.pending.zero;
    if (state_.at_barrier) return;
    (state_.pending.of_paths ? state_.paths : state_.pieces) += static_cast<std::int64_t>(state_.pending.ticks);
  }

  // Nothing counts while the content of the queues is unknown. It is known to be nothing when nothing runs and no
  // command has come for longer than a command takes to show.
  void forget(const Inputs& in) {
    const bool shows = state_.since >= kLag && !state_.inside;
    state_.unknown = state_.lost || (state_.unknown && state_.round != kDecide);
    if (state_.lost) {
      state_.paths = state_.pieces = 0;
      state_.owed = 0;
      state_.pending.any = false;
      state_.at_rest = state_.at_barrier = false;
    }
    state_.lost = in.lost || (state_.lost && !(in.idle && shows));
    const Arrival& a = in.arrival;
    const bool ends = a.drop || a.geometry_commit || a.feed_commit;
    state_.inside = (state_.inside || a.geometry_write || a.feed_write) && !ends;
    state_.since = ends ? 0 : state_.since + (state_.since < kLag ? 1 : 0);
  }

  // The count is in halfwords 1 to 3 of a stored command, the stop distance of a piece in halfwords 10 and 11.
  void arrive(const Arrival& a) {
    if (a.geometry_write || a.feed_write) {
      if (state_.index >= 1 && state_.index <= 3)
        state_.arriving.ticks = (state_.index == 1 ? 0 : state_.arriving.ticks) | std::uint64_t{a.halfword}
                                                                                      << 16 * (state_.index - 1);
      if (state_.index == 10 || state_.index == 11)
        state_.arriving.zero = a.halfword == 0 && (state_.index == 10 || state_.arriving.zero);
      ++state_.index;
    }
    if (a.geometry_commit || a.feed_commit) {
      state_.arriving.any = true;
      state_.arriving.of_paths = a.geometry_commit;
      state_.arriving.of_pieces = a.feed_commit;
      state_.pending = state_.arriving;
    }
    if (a.drop || a.geometry_commit || a.feed_commit) state_.index = 0;
  }

  void cut() {
    state_.paths = state_.pieces = 0;
    state_.owed = 0;
    state_.pending.any = false;
    state_.index = 0;
    state_.at_rest = state_.at_barrier = false;
    state_.next = 0;
    state_.next_whole = true;
    state_.half = false;
    state_.due = state_.ruled = state_.ends = state_.covered = state_.judged = state_.enough = state_.waits = false;
    state_.out.hold = false;
    state_.lost = state_.inside = false;
  }

  State state_;
};

}  // namespace trammel::model
