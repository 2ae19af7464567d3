// Golden model of the capture units, rtl/io/captures.sv. A unit asks for its snapshot at the first raw change of its
// input after quiet. When the filter passes the change, the snapshot becomes a capture; when the input becomes quiet
// at its old level, the unit withdraws the request. A capture stays with its unit or goes to the queue. Every input
// of clock c takes effect at c + 1, except in asks(), which belongs to clock c itself. Not thread-safe; no errors are
// reported.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class Captures {
 public:
  static constexpr unsigned kUnits = 4;  // at most

  struct Inputs {
    std::uint32_t raw = 0;
    std::uint32_t levels = 0;
    std::uint32_t quiet = 0;
    std::uint8_t captured = 0;  // events, a bit per unit: the snapshot that the unit asked for is in its area
    std::uint8_t queued = 0;    // events, a bit per unit: the queue has taken the unit's capture
    bool full = false;          // with queued: the queue was full and the capture is lost
    Setting setting;
  };
  // Searching: waits until the input is quiet at a level whose edge counts. Ready: waits for that edge. Touched: the
  // edge came.
  enum class Mode : std::uint8_t { Off, Searching, Ready, Touched };
  struct Unit {
    std::uint32_t select = 0;  // as CAPTURE_SELECT was written
    Mode mode = Mode::Off;
    bool before = false;     // level before the edge
    bool confirmed = false;  // the filter has passed the edge
    bool taken = false;      // the snapshot of the edge is in the area
    bool lost = false;       // the edge came while an older capture was still valid
    bool valid = false;
    bool overrun = false;
    bool active = false;  // level to which the captured edge led
    // Only units with a queue: whether the unit watched its input in the last clock, and the filtered level then.
    bool watched = false;
    bool level = false;
    bool operator==(const Unit& o) const {
      return select == o.select && mode == o.mode && before == o.before && confirmed == o.confirmed &&
             taken == o.taken && lost == o.lost && valid == o.valid && overrun == o.overrun && active == o.active &&
             watched == o.watched && level == o.level;
    }
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::array<Unit, kUnits> units{};
    std::uint16_t snapshots = 0;
  };

  // `units`: 0 to 4.
  explicit Captures(unsigned units) : units_(units) {}

  // One rising edge.
  void clock(const Inputs& in) {
    if (in.captured != 0) ++state_.snapshots;
    for (unsigned n = 0; n < units_; ++n) clock_unit(state_.units[n], n, in);
  }

  // The units that ask for a snapshot in this clock, a bit per unit.
  std::uint8_t asks(const Inputs& in) const {
    unsigned mask = 0;
    for (unsigned n = 0; n < units_; ++n) mask |= unit_asks(state_.units[n], n, in) ? 1U << n : 0U;
    return static_cast<std::uint8_t>(mask);
  }

  // A bit per unit. passed(): the unit hands on a capture; edges(): its edge leads to the active level.
  std::uint8_t passed() const {
    unsigned mask = 0;
    for (unsigned n = 0; n < units_; ++n) mask |= hands_on(state_.units[n]) ? 1U << n : 0U;
    return static_cast<std::uint8_t>(mask);
  }
  std::uint8_t edges() const {
    unsigned mask = 0;
    for (unsigned n = 0; n < units_; ++n) mask |= state_.units[n].before ? 0U : 1U << n;
    return static_cast<std::uint8_t>(mask);
  }

  // The value of register CAPTURE_STATE.
  std::uint32_t word() const {
    namespace field = card_map::field;
    std::uint32_t word = std::uint32_t{state_.snapshots} << field::kCaptureStateSnapshotsShift;
    for (unsigned n = 0; n < units_; ++n) {
      const Unit& u = state_.units[n];
      if (u.mode == Mode::Touched) word |= 1U << n << field::kCaptureStatePendingShift;
      if (u.valid) word |= 1U << n << field::kCaptureStateValidShift;
      if (u.overrun) word |= 1U << n << field::kCaptureStateOverrunShift;
      if (u.active) word |= 1U << n << field::kCaptureStateActiveShift;
    }
    return word;
  }

  // True if clocks with these inputs change nothing, however many pass.
  bool rests(const Inputs& in) const {
    Captures after = *this;
    after.clock(in);
    for (unsigned n = 0; n < units_; ++n) {
      if (!(after.state_.units[n] == state_.units[n])) return false;
    }
    return in.captured == 0;
  }

  unsigned units() const { return units_; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  // The unit's input: raw level, filtered level, quiet.
  struct Seen {
    bool raw, level, quiet;
  };
  static Seen seen_by(const Unit& u, const Inputs& in) {
    const std::uint32_t input = u.select & card_map::field::kCaptureSelectInputNumber;
    const auto bit = [input](std::uint32_t word) { return (word >> input & 1) != 0; };
    return {bit(in.raw), bit(in.levels), bit(in.quiet)};
  }
  static bool selected(const Inputs& in, unsigned unit) {
    return in.setting.set && in.setting.address == card_map::reg::capture_select(unit);
  }
  static bool queues(const Unit& u) { return (u.select & card_map::field::kCaptureSelectQueue) != 0; }
  static bool hands_on(const Unit& u) { return queues(u) && u.mode == Mode::Touched && u.confirmed && u.taken; }
  // The input is quiet at a level from which an edge counts for this unit.
  static bool counts(const Unit& u, const Seen& seen) {
    const std::uint32_t edges =
        seen.level ? card_map::field::kCaptureSelectToInactive : card_map::field::kCaptureSelectToActive;
    return seen.quiet && (u.select & edges) != 0;
  }
  // The touch was a glitch: the input is quiet again at its old level.
  static bool withdrawn(const Unit& u, const Seen& seen) {
    return u.mode == Mode::Touched && !u.confirmed && seen.quiet && seen.level == u.before;
  }
  // The level from which a raw change would be an edge. If no edge counts now: the raw level, so that nothing is an
  // edge.
  static bool level_before(const Unit& u, const Seen& seen) {
    if (u.mode == Mode::Ready || withdrawn(u, seen)) return u.before;
    return u.mode == Mode::Searching && counts(u, seen) ? seen.level : seen.raw;
  }
  static bool unit_asks(const Unit& u, unsigned n, const Inputs& in) {
    const Seen seen = seen_by(u, in);
    if (selected(in, n)) return false;
    const bool still_asked = u.mode == Mode::Touched && !u.lost && !u.taken;
    // A request that is pending is withdrawn for one clock before the unit makes a new one.
    if (seen.raw != level_before(u, seen)) return !u.valid && !(withdrawn(u, seen) && still_asked);
    return still_asked && !withdrawn(u, seen);
  }

  static void clock_unit(Unit& u, unsigned n, const Inputs& in) {
    namespace reg = card_map::reg;
    const Seen seen = seen_by(u, in);
    const bool before = level_before(u, seen);
    const bool clears = in.setting.set && in.setting.address == reg::kCaptureClear && (in.setting.data >> n & 1) != 0;
    const bool stood = u.valid;
    if (clears) u.valid = u.overrun = false;
    if (seen.raw == before && missed(u, seen)) u.overrun = true;
    watch(u, seen);
    if (seen.raw != before) {
      u.mode = Mode::Touched;
      u.before = before;
      u.confirmed = seen.level != before;
      u.lost = stood;
      u.taken = false;
    } else if (u.mode == Mode::Searching || withdrawn(u, seen)) {
      if (u.mode == Mode::Touched || counts(u, seen)) {
        u.mode = Mode::Ready;
        u.before = before;
      }
    } else if (u.mode == Mode::Touched) {
      if (!queues(u) && u.confirmed && (u.taken || u.lost)) finish(u);
      if (hands_on(u) && (in.queued >> n & 1) != 0) finish_queued(u, in.full);
      u.confirmed = u.confirmed || seen.level != u.before;
      u.taken = u.taken || (in.captured >> n & 1) != 0;
    }
    if (selected(in, n)) {
      u = {};
      u.select = in.setting.data;
      const std::uint32_t edges = card_map::field::kCaptureSelectToActive | card_map::field::kCaptureSelectToInactive;
      u.mode = (u.select & edges) != 0 ? Mode::Searching : Mode::Off;
    }
  }
  // The filter passes an edge that the unit did not wait for: it was missed.
  static bool missed(const Unit& u, const Seen& seen) {
    if (!queues(u) || u.mode == Mode::Off || !u.watched || seen.level == u.level) return false;
    const std::uint32_t edge =
        seen.level ? card_map::field::kCaptureSelectToActive : card_map::field::kCaptureSelectToInactive;
    return (u.select & edge) != 0 && (u.mode != Mode::Touched || u.confirmed);
  }
  static void watch(Unit& u, const Seen& seen) {
    if (!queues(u)) return;
    u.watched = u.mode != Mode::Off;
    u.level = seen.level;
  }
  static Mode after_capture(const Unit& u) {
    return (u.select & card_map::field::kCaptureSelectContinuous) != 0 ? Mode::Searching : Mode::Off;
  }
  static void finish_queued(Unit& u, bool full) {
    u.mode = after_capture(u);
    u.overrun = u.overrun || full;
  }
  static void finish(Unit& u) {
    u.mode = after_capture(u);
    if (u.lost) {
      u.overrun = true;
    } else {
      u.valid = true;
      u.active = !u.before;
    }
  }

  unsigned units_;
  State state_;
};

}  // namespace trammel::model
