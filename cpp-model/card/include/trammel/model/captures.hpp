// Golden model of the capture units, rtl/io/captures.sv: a unit asks for its snapshot at the first raw change of its
// input after quiet; the filter's passing makes a capture of it, quiet takes it back. A capture stays with its unit, or
// is handed on to the queue. Everything that comes in clock c shows at c + 1, but for asks(), which is of the clock
// itself. Not thread-safe; no errors are reported.
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
    std::uint8_t captured = 0;  // events, a bit for each unit: the snapshot it asks for is in its area
    std::uint8_t queued = 0;    // events, likewise: the capture that it hands on is in the queue,
    bool full = false;          // or lost
    Setting setting;
  };
  // Searching: for quiet at the level before the edge. Touched: an edge has come.
  enum class Mode : std::uint8_t { Off, Searching, Ready, Touched };
  struct Unit {
    std::uint32_t select = 0;  // as CAPTURE_SELECT was written
    Mode mode = Mode::Off;
    bool before = false;     // the level before the edge
    bool confirmed = false;  // of the edge: its filter has passed
    bool taken = false;      // its snapshot is in the area
    bool lost = false;       // it came while a capture stood
    bool valid = false;
    bool overrun = false;
    bool active = false;  // the level that the captured edge led to
    // Of units with a queue: the level of the input a clock ago, where it was watched then.
    bool watched = false;
    bool level = false;
    bool operator==(const Unit& o) const {
      return select == o.select && mode == o.mode && before == o.before && confirmed == o.confirmed &&
             taken == o.taken && lost == o.lost && valid == o.valid && overrun == o.overrun && active == o.active &&
             watched == o.watched && level == o.level;
    }
  };
  // All that the next clock() depends on beside its inputs.
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

  // The units that want a snapshot in this clock.
  std::uint8_t asks(const Inputs& in) const {
    unsigned mask = 0;
    for (unsigned n = 0; n < units_; ++n) mask |= unit_asks(state_.units[n], n, in) ? 1U << n : 0U;
    return static_cast<std::uint8_t>(mask);
  }

  // The units that hand on a capture, and the level that its edge led to.
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

  // CAPTURE_STATE, as the register reads.
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

  // The next clock() changes nothing, however often it comes.
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
  // What a unit sees of its input.
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
  // The input is quiet at a level that the unit's edges come from.
  static bool counts(const Unit& u, const Seen& seen) {
    const std::uint32_t edges =
        seen.level ? card_map::field::kCaptureSelectToInactive : card_map::field::kCaptureSelectToActive;
    return seen.quiet && (u.select & edges) != 0;
  }
  // A touch was a glitch: the input is quiet again.
  static bool withdrawn(const Unit& u, const Seen& seen) {
    return u.mode == Mode::Touched && !u.confirmed && seen.quiet && seen.level == u.before;
  }
  // The level that a change now would be one from, where one counts; else the raw level itself, which is none.
  static bool level_before(const Unit& u, const Seen& seen) {
    if (u.mode == Mode::Ready || withdrawn(u, seen)) return u.before;
    return u.mode == Mode::Searching && counts(u, seen) ? seen.level : seen.raw;
  }
  static bool unit_asks(const Unit& u, unsigned n, const Inputs& in) {
    const Seen seen = seen_by(u, in);
    if (selected(in, n)) return false;
    const bool still_asked = u.mode == Mode::Touched && !u.lost && !u.taken;
    // What is still asked for is taken back for a clock before it is asked for anew.
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
  // The filter passes, and it was not the touch under way that it waited for.
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
