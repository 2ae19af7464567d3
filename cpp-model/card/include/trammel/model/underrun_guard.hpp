// Golden model of the under-run hold: holds the time base early enough to stand before what is queued ends, and keeps a
// piece that would begin from rest waiting for as much.
//
// Every 32 clocks (kRound) it decides: short is where the queued ticks, of paths or of pieces, are at most
// stop distance * ratio^2 + kUnderrunReserveTicks; but not where the last piece ends at rest with its paths queued, nor
// where a barrier came last. What a probe drops is not counted off: from then on there is no rule until nothing is
// queued once. What a round looks at is taken at its clocks kRatio, kFactor, kCount; it decides at
// kDecide. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

class UnderrunGuard {
 public:
  // What the command checker lets into the queues.
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
    bool cut = false;   // and where there is no rule: nothing is counted
    bool lost = false;  // event: what is queued will be dropped
    bool idle = false;  // nothing runs, is decoded or queued; up to four clocks late
    Arrival arrival;
    bool full = false;        // a queue may have no room for the next command
    LoadWord load;            // feed load
    bool take = false;        // a feed tick is taken
    bool swap = false;        // a piece began in the clock before
    bool active = false;      // a piece gives ticks
    bool decoded = false;     // a piece waits
    std::uint32_t ratio = 0;  // 2^-16, 0..65536
  };
  struct Outputs {
    bool hold = false;
    bool shown = false;  // it holds, or keeps a piece waiting
    std::uint32_t underruns = 0;
  };
  static constexpr std::uint64_t kAnyTicks = std::numeric_limits<std::uint64_t>::max();

  // One rising edge.
  void clock(const Inputs& in) {
    const bool follow = follows(in.active);
    const bool from_rest = !in.active || ends_;
    const bool swap_from_rest = from_rest_before_;
    switch (round_) {
      case kRatio:
        if (!out_.hold) ratio_ = in_256ths(in.ratio);
        break;
      case kFactor:
        judged_ = decoded_before_ && follow;
        factor_ = factor(in.ratio == 0, in.full);
        break;
      case kDecide:
        decide(in, follow);
        break;
      default:
        break;
    }
    const bool still = round_ > kFactor && round_ <= kProduct;
    if (round_ == kProduct) product_ = product();
    if (!still && (due_ || follow)) take_distance();
    if (in.swap) {
      due_ = due_ || swap_from_rest || !next_zero();
      ends_ = next_zero();
      covered_ = judged_ = enough_ = waits_ = false;
    }
    count(in);
    if (in.load.to(feed_target::kStopDistance)) load(in.load.word);
    from_rest_before_ = from_rest;
    decoded_before_ = in.decoded;
    forget(in);
    if (in.cut) cut();
    out_.shown = out_.hold || waits_;
    round_ = (round_ + 1) % kRound;
  }

  const Outputs& outputs() const { return out_; }

  // A piece that is decoded must not begin.
  bool waits(bool active) const { return (!active || ends_) && !next_zero() && !enough_ && !lost_; }

  // With these inputs nothing changes but counts, as long as fewer ticks are taken than ticks_to_change().
  bool settled(const Inputs& in) const {
    const bool follow = follows(in.active);
    if (unknown_ != lost_) return false;
    if (lost_ && (in.lost || in.idle || since_ < kLag)) return false;
    if (in.lost || in.cut || in.swap || in.load.valid || in.arrival.any() || pending_.any) return false;
    if (due_ || (follow && (distance_ != next_ || ruled_ == next_zero()))) return false;
    if (decoded_before_ != in.decoded || from_rest_before_ != (!in.active || ends_)) return false;
    if (judged_ != (in.decoded && follow) || (flags_.covered && !covered_ && !unknown_)) return false;
    if ((!out_.hold && ratio_ != in_256ths(in.ratio)) || factor_ != factor(in.ratio == 0, in.full)) return false;
    if (product_ != product() || !(flags_ == compared(owed_))) return false;
    const bool is_short = ruled_ && judged_short();
    return out_.hold == holds(is_short, follow, in.full) && enough_ == (judged_ && !is_short) &&
           waits_ == (judged_ && !in.active && is_short);
  }
  std::uint64_t ticks_to_change() const {
    std::uint64_t least = kAnyTicks;
    for (const std::int64_t queued : {paths_, pieces_}) {
      const std::int64_t beyond = queued - static_cast<std::int64_t>(owed_) - reserved();
      if (beyond > 0 && static_cast<std::uint64_t>(beyond) < least) least = static_cast<std::uint64_t>(beyond);
    }
    return least;
  }
  // `clocks` at once, in which `ticks` are taken; bit k of `taken`: one in the clock before the last k.
  void jump(std::uint64_t clocks, std::uint64_t ticks, unsigned taken) {
    const std::uint64_t to_pass = kPass - 1 - round_ % kPass;
    round_ = static_cast<unsigned>((round_ + clocks) % kRound);
    std::uint64_t owed = owed_ + ticks;
    if (lost_) owed = 0;
    if (clocks > to_pass) {
      const std::uint64_t all = owed;
      owed = 0;
      for (unsigned k = 0; k < round_ % kPass; ++k) owed += taken >> k & 1;
      paths_ -= static_cast<std::int64_t>(all - owed);
      pieces_ -= static_cast<std::int64_t>(all - owed);
    }
    owed_ = owed;
  }

 private:
  static constexpr unsigned kRound = 32;
  static constexpr unsigned kPass = 4;  // ticks taken leave the counts, and a command's are added, once in a pass
  static constexpr unsigned kRatio = 0;
  static constexpr unsigned kFactor = 11;
  static constexpr unsigned kProduct = 21;
  static constexpr unsigned kCount = 23;
  static constexpr unsigned kDecide = 29;

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

  static std::uint32_t in_256ths(std::uint32_t ratio) { return (ratio + 255) / 256; }
  bool follows(bool active) const { return !active || (ends_ && covered_); }
  bool next_zero() const { return next_whole_ && next_ == 0; }

  // Of the square, rounded up; none where it stands and no more will come, twice while it holds.
  std::uint32_t factor(bool standing, bool full) const {
    const std::uint32_t square = (ratio_ * ratio_ + 255) / 256;
    if (standing && full) return 0;
    return out_.hold ? 2 * square : square;
  }
  std::uint64_t product() const { return std::uint64_t{distance_} * factor_ / 256; }
  std::int64_t reserved() const {
    return static_cast<std::int64_t>(product_) + card_map::constant::kUnderrunReserveTicks;
  }
  Flags compared(std::uint64_t owed) const {
    const auto gone = static_cast<std::int64_t>(owed);
    return {paths_ - gone <= reserved(), pieces_ - gone <= reserved(), paths_ >= pieces_};
  }

  bool judged_short() const {
    const bool geometry = flags_.geometry_short && !(at_rest_ && flags_.covered);
    return !at_barrier_ && !lost_ && !unknown_ && (geometry || (flags_.feed_short && !at_rest_));
  }
  bool holds(bool is_short, bool follow, bool full) const {
    return is_short && (out_.hold || !follow || (judged_ && full));
  }
  void decide(const Inputs& in, bool follow) {
    const bool is_short = ruled_ && judged_short();
    const bool held = out_.hold;
    out_.hold = holds(is_short, follow, in.full);
    if (out_.hold && !held) ++out_.underruns;
    enough_ = judged_ && !is_short;
    waits_ = judged_ && !in.active && is_short;
    covered_ = covered_ || (flags_.covered && !lost_ && !unknown_);
  }

  void take_distance() {
    distance_ = next_;
    ruled_ = !next_zero();
    due_ = false;
  }
  void load(std::uint16_t word) {
    next_ = next_ >> 16 | std::uint32_t{word} << 16;
    next_whole_ = half_;
    half_ = !half_;
  }

  void count(const Inputs& in) {
    owed_ += in.take ? 1U : 0U;
    if (round_ % kPass == kPass - 1) {
      if (pending_.any) {
        add();
      } else {
        paths_ -= static_cast<std::int64_t>(owed_);
        pieces_ -= static_cast<std::int64_t>(owed_);
        owed_ = 0;
      }
    }
    // Ticks that a pass leaves for the next one are still in the counts.
    if (round_ == kCount) flags_ = compared(0);
    if (in.arrival.any()) arrive(in.arrival);
  }
  void add() {
    pending_.any = false;
    at_barrier_ = pending_.of_paths && pending_.of_pieces;
    if (!pending_.of_paths) at_rest_ = pending_.zero;
    if (at_barrier_) return;
    (pending_.of_paths ? paths_ : pieces_) += static_cast<std::int64_t>(pending_.ticks);
  }

  // While what is queued is not known nothing counts. It is nothing at last when nothing runs and no command came for
  // longer than it takes to show.
  void forget(const Inputs& in) {
    const bool shows = since_ >= kLag && !inside_;
    unknown_ = lost_ || (unknown_ && round_ != kDecide);
    if (lost_) {
      paths_ = pieces_ = 0;
      owed_ = 0;
      pending_.any = false;
      at_rest_ = at_barrier_ = false;
    }
    lost_ = in.lost || (lost_ && !(in.idle && shows));
    const Arrival& a = in.arrival;
    const bool ends = a.drop || a.geometry_commit || a.feed_commit;
    inside_ = (inside_ || a.geometry_write || a.feed_write) && !ends;
    since_ = ends ? 0 : since_ + (since_ < kLag ? 1 : 0);
  }

  // The count lies in halfwords 1 to 3 of what is stored, a piece's stop distance in 10 and 11.
  void arrive(const Arrival& a) {
    if (a.geometry_write || a.feed_write) {
      if (index_ >= 1 && index_ <= 3)
        arriving_.ticks = (index_ == 1 ? 0 : arriving_.ticks) | std::uint64_t{a.halfword} << 16 * (index_ - 1);
      if (index_ == 10 || index_ == 11) arriving_.zero = a.halfword == 0 && (index_ == 10 || arriving_.zero);
      ++index_;
    }
    if (a.geometry_commit || a.feed_commit) {
      arriving_.any = true;
      arriving_.of_paths = a.geometry_commit;
      arriving_.of_pieces = a.feed_commit;
      pending_ = arriving_;
    }
    if (a.drop || a.geometry_commit || a.feed_commit) index_ = 0;
  }

  void cut() {
    paths_ = pieces_ = 0;
    owed_ = 0;
    pending_.any = false;
    index_ = 0;
    at_rest_ = at_barrier_ = false;
    next_ = 0;
    next_whole_ = true;
    half_ = false;
    due_ = ruled_ = ends_ = covered_ = judged_ = enough_ = waits_ = false;
    out_.hold = false;
    lost_ = inside_ = false;
  }

  static constexpr unsigned kLag = 7;
  bool lost_ = false;
  bool unknown_ = false;   // was lost while the counts were compared that are decided on next
  bool inside_ = false;    // of a command on its way in
  unsigned since_ = kLag;  // clocks since the last command came
  unsigned round_ = 0;
  // queued ticks
  std::int64_t paths_ = 0;
  std::int64_t pieces_ = 0;
  std::uint64_t owed_ = 0;  // taken, not yet taken away from them
  unsigned index_ = 0;      // of the halfword that arrives next
  Pending arriving_;
  Pending pending_;
  bool at_rest_ = false;     // the last piece ends at rest
  bool at_barrier_ = false;  // a barrier came last
  Flags flags_;
  // the stop distance of the next piece, and the one in force
  std::uint32_t next_ = 0;
  bool next_whole_ = true;  // both halfwords are there
  bool half_ = false;
  std::uint32_t distance_ = 0;
  bool ruled_ = false;  // it is not 0
  bool due_ = false;
  // the limit
  std::uint32_t ratio_ = 0;   // 256ths
  std::uint32_t factor_ = 0;  // 256ths
  std::uint64_t product_ = 0;
  // the piece in force and the next one
  bool ends_ = false;     // ends at rest
  bool covered_ = false;  // all its ticks have their paths
  bool from_rest_before_ = false;
  bool decoded_before_ = false;
  bool judged_ = false;  // the next piece is what is judged
  bool enough_ = false;  // for it
  bool waits_ = false;
  Outputs out_;
};

}  // namespace trammel::model
