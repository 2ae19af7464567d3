// Programs as the queues hold them: stretches of paths and of feed pieces that cover the same number of ticks, with
// barriers between them. They drive the tests of the sequencers and the motion core. Some programs are wrong on
// purpose.
#pragma once

#include <cstdint>
#include <deque>
#include <string_view>
#include <utility>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/model/halfword_queue.hpp"
#include "wires.hpp"

namespace trammel::lockstep {

__extension__ typedef __int128 int128;

using Field = std::pair<std::string_view, int128>;
using Halfwords = std::vector<std::uint16_t>;

inline constexpr std::int64_t kOnePulse = std::int64_t{1} << 40;

// A command in its stored form. Fields that are not named are 0; `increments` are those of the axes in the mask.
inline Halfwords stored_command(card_map::Opcode opcode, unsigned mask, std::uint64_t count,
                                const std::vector<Field>& fields = {},
                                const std::vector<std::int64_t>& increments = {}) {
  constexpr std::size_t kHeader = 4;
  const card_map::Command& layout = *card_map::find_command(static_cast<std::uint8_t>(opcode));
  Halfwords to(card_map::queue_halfwords(layout, static_cast<std::uint8_t>(mask)), 0);
  const auto put = [&to](std::size_t at, std::size_t halfwords, int128 value) {
    for (std::size_t i = 0; i < halfwords; ++i) to[at + i] = static_cast<std::uint16_t>(value >> (16 * i));
  };
  to[0] = static_cast<std::uint16_t>(static_cast<unsigned>(opcode) | mask << 8);
  put(1, 3, static_cast<int128>(count));
  for (std::size_t i = 0; i < layout.field_count; ++i) {
    const card_map::Field& field = layout.fields[i];
    for (const Field& given : fields) {
      if (given.first == field.name) put(kHeader + field.offset, field.halfwords, given.second);
    }
    if (field.name != "increment") continue;
    for (std::size_t n = 0; n < increments.size(); ++n) put(kHeader + field.offset + 3 * n, 3, increments[n]);
  }
  return to;
}

class Programs {
 public:
  Programs(unsigned axes, Dice& dice) : axes_(axes), dice_(dice) {}

  // One stretch in `wrong_every` gives more or fewer ticks than it takes; one arc in as many misses its end.
  unsigned wrong_every = 100;
  // False: all paths are lines.
  bool arcs = true;
  // True: every other arc is in 8 directions.
  bool eight_directions = false;
  // True: arcs in chords, on the arc generator.
  bool chords = false;
  // True: OUTPUT and MARK between paths.
  bool path_commands = false;
  // One in this many of them is a PWM; 0: none.
  unsigned pwm_every = 0;
  // True: also PROBE, PROBE_END and WAIT_INPUT, on inputs below `inputs`.
  bool probes = false;
  unsigned inputs = 16;
  // True: pieces of all classes; otherwise only feed.
  bool classes = false;
  // The maximum ticks of a stretch, and of its paths and pieces.
  unsigned longest = 600;

  struct Stretch {
    std::vector<Halfwords> geometry;
    std::vector<Halfwords> feed;
  };

  Stretch stretch() {
    Stretch s;
    std::uint64_t path_ticks = 0;
    std::uint64_t piece_ticks = 0;
    const unsigned paths = dice_.below(6);
    const bool single = dice_.chance(4);  // paths and pieces of one tick each, in sequence
    const bool probing = probes && dice_.chance(3);
    if (probing) s.geometry.push_back(conditional(card_map::Opcode::Probe, 0));
    for (unsigned i = 0; i < paths; ++i) {
      instants(s.geometry);
      if (probing && dice_.chance(10)) s.geometry.push_back(conditional(card_map::Opcode::Probe, 0));
      path_ticks += path(s.geometry, single);
    }
    instants(s.geometry);
    while (piece_ticks < path_ticks) {
      const std::uint64_t left = path_ticks - piece_ticks;
      const std::uint64_t ticks = single ? 1 : dice_.chance(3) ? left : 1 + dice_.below(static_cast<unsigned>(left));
      piece(s.feed, ticks);
      piece_ticks += ticks;
    }
    if (dice_.chance(wrong_every)) {
      if (dice_.chance(2))
        piece(s.feed, 1 + dice_.below(3));
      else
        path(s.geometry, true);
    }
    for (unsigned i = dice_.below(3); i != 0; --i) {
      barrier(s);
      instants(s.geometry);
    }
    if (probing ? !dice_.chance(8) : probes && dice_.chance(8)) both(s, probe_end());
    return s;
  }

  static Halfwords mark() { return stored_command(card_map::Opcode::Mark, 0, 0); }
  Halfwords output() {
    return stored_command(card_map::Opcode::Output, 0, 0,
                          {{"set", dice_.draw() & 0xFFFF}, {"clear", dice_.draw() & 0xFFFF}});
  }

  Halfwords pulses() {
    return stored_command(card_map::Opcode::Pwm, 0, 0,
                          {{"select", dice_.below(2) | dice_.below(2) << 4 | dice_.below(4) << 8},
                           {"duty", dice_.draw() & 0xFFFF},
                           {"gain", dice_.draw() & 0xFFFF}});
  }

  static Halfwords probe_end() { return stored_command(card_map::Opcode::ProbeEnd, 0, 0); }
  Halfwords conditional(card_map::Opcode opcode, std::uint64_t count) {
    return stored_command(opcode, 0, count, {{"condition", dice_.below(2) << 5 | dice_.below(inputs)}});
  }

  void barrier(Stretch& s) {
    if (probes && dice_.chance(3))
      return both(s, conditional(card_map::Opcode::WaitInput, dice_.chance(4) ? 0 : 1 + dice_.below(60)));
    constexpr unsigned kDwells[] = {0, 1, 2, 3, 4, 15, 16, 17, 18, 33, 100};
    const bool end = dice_.chance(3);
    const Halfwords command = stored_command(end ? card_map::Opcode::End : card_map::Opcode::Dwell, 0,
                                             end ? 0 : kDwells[dice_.below(std::size(kDwells))]);
    both(s, command);
  }

 private:
  static void both(Stretch& s, const Halfwords& command) {
    s.geometry.push_back(command);
    s.feed.push_back(command);
  }

  // Commands that are neither paths nor barriers; sometimes several in a row.
  void instants(std::vector<Halfwords>& to) {
    while (path_commands && dice_.chance(3)) {
      if (pwm_every != 0 && dice_.chance(pwm_every))
        to.push_back(pulses());
      else
        to.push_back(dice_.chance(2) ? mark() : output());
    }
  }

  std::uint64_t path(std::vector<Halfwords>& to, bool single) {
    if (arcs && axes_ > 1 && dice_.chance(4)) return arc(to);
    if (chords && axes_ > 1 && dice_.chance(3)) return chord_arc(to);
    const unsigned mask = 1 + dice_.below((1U << axes_) - 1);
    const std::uint64_t ticks = single ? 1 : 1 + dice_.below(dice_.chance(3) ? 4 : longest);
    std::vector<std::int64_t> increments;
    for (unsigned axis = 0; axis < axes_; ++axis) {
      if ((mask >> axis & 1) == 0) continue;
      // Half of them make a step every few ticks.
      const std::uint64_t any = dice_.chance(2) ? dice_.word() >> 23 >> dice_.below(5) : dice_.log_uniform(41);
      const auto magnitude = static_cast<std::int64_t>(any % (kOnePulse + 1));
      increments.push_back(dice_.chance(2) ? magnitude : -magnitude);
    }
    to.push_back(stored_command(card_map::Opcode::Line, mask, ticks, {}, increments));
    return ticks;
  }

  // A full circle, with as many path ticks as steps.
  std::uint64_t arc(std::vector<Halfwords>& to) {
    constexpr std::int64_t kStepsInEight[] = {6, 12, 16, 24, 28, 32, 40, 44};  // 4 round(sqrt(2) R) from R = 2 on
    const std::int64_t radius = 1 + dice_.below(8);
    const bool eight = eight_directions && dice_.chance(2);
    const std::int64_t steps = eight ? kStepsInEight[radius - 1] : 8 * radius;
    const std::int64_t ticks = steps + dice_.below(dice_.chance(2) ? 4 : 300);
    const bool wrong = dice_.chance(wrong_every);
    const auto prescale = static_cast<std::int64_t>((int128{steps} * kOnePulse + ticks / 2) / ticks);
    const unsigned x = dice_.below(axes_);
    const unsigned y = (x + 1 + dice_.below(axes_ - 1)) % axes_;
    to.push_back(stored_command(card_map::Opcode::Arc, 1U << x | 1U << y, static_cast<std::uint64_t>(ticks),
                                {{"path_ticks", steps},
                                 {"prescale", prescale},
                                 {"plane", y << 8 | x << 4 | (eight ? 2U : 0U) | dice_.below(2)},
                                 {"quadrants", wrong ? 5 : 4},
                                 {"gradient_x", 2 * radius},
                                 {"half_x", 1},
                                 {"half_y", 1}}));
    return static_cast<std::uint64_t>(ticks);
  }

  // Random chords, with random further axes; the sum of the increments is at most one pulse per tick.
  std::uint64_t chord_arc(std::vector<Halfwords>& to) {
    const unsigned x = dice_.below(axes_);
    const unsigned y = (x + 1 + dice_.below(axes_ - 1)) % axes_;
    const unsigned mask = 1U << x | 1U << y | dice_.below(1U << axes_);
    const std::uint64_t path_ticks = 1 + dice_.below(dice_.chance(4) ? 4 : longest);
    const std::uint64_t ticks = path_ticks + dice_.below(dice_.chance(2) ? 1 : 2 * longest);
    const auto prescale = static_cast<std::int64_t>((int128{path_ticks} * kOnePulse + ticks / 2) / ticks);
    const unsigned k = 1 + dice_.below(27);
    const unsigned m = 5 + dice_.below(dice_.chance(2) ? 1 : 4);
    const auto any = [this](unsigned bits) {
      const auto magnitude = static_cast<std::int64_t>(dice_.word() >> (64 - bits));
      return dice_.chance(2) ? magnitude : -magnitude;
    };
    std::vector<std::int64_t> further;
    for (unsigned axis = 0; axis < axes_; ++axis) {
      if (axis != x && axis != y && (mask >> axis & 1) != 0) further.push_back(any(40));
    }
    const unsigned bits = k + 38 < 62 ? k + 38 : 62;
    to.push_back(stored_command(card_map::Opcode::ArcChord, mask, ticks,
                                {{"path_ticks", path_ticks},
                                 {"prescale", prescale},
                                 {"plane", y << 8 | x << 4 | dice_.below(2)},
                                 {"shifts", k | m << 8},
                                 {"x", any(bits)},
                                 {"y", any(bits)},
                                 {"first_x", any(40)},
                                 {"first_y", any(40)},
                                 {"closing_x", any(37)},
                                 {"closing_y", any(37)}},
                                further));
    return ticks;
  }

  // Mostly fast: a tick every few clocks at most.
  void piece(std::vector<Halfwords>& to, std::uint64_t ticks) {
    const std::uint64_t rate = dice_.word() >> dice_.below(5) | std::uint64_t{1} << 58;
    const auto change = [this] {
      const auto magnitude = static_cast<std::int64_t>(dice_.log_uniform(58));
      return dice_.chance(2) ? int128{magnitude} : -int128{magnitude};
    };
    const bool constant = dice_.chance(3);
    const unsigned silent = dice_.chance(8) ? card_map::constant::kPieceSilent : 0;
    const unsigned doublings = dice_.chance(2) ? dice_.below(4) * card_map::constant::kPieceDoubling : 0;
    to.push_back(stored_command(card_map::Opcode::Feed, (classes ? dice_.below(3) : 0) | silent | doublings, ticks,
                                {{"rate", static_cast<int128>(rate)},
                                 {"floor", static_cast<int128>(std::uint64_t{1} << 26 | dice_.draw() >> 2)},
                                 {"stop_distance", static_cast<int128>(dice_.draw())},
                                 {"acceleration", constant ? 0 : change()},
                                 {"jerk", constant ? 0 : change()}}));
  }

  unsigned axes_;
  Dice& dice_;
};

// A queue, and a writer that fills it command by command as the checker does: one halfword at a time, which become
// readable with the commit after the command's last one.
class QueueWriter {
 public:
  explicit QueueWriter(std::size_t depth) : queue_(depth) {}

  void add(const std::vector<Halfwords>& commands) {
    commands_.insert(commands_.end(), commands.begin(), commands.end());
  }
  // True if nothing is left to write.
  bool done() const { return commands_.empty(); }
  const model::HalfwordQueue::Outputs& outputs() const { return queue_.outputs(); }

  // The inputs of the queue in the clock that begins; the writer continues if `write`.
  const model::HalfwordQueue::Inputs& offer(bool write) {
    offered_ = {};
    if (write && !commands_.empty()) go_on(offered_);
    return offered_;
  }
  // One rising edge.
  void clock(bool read, bool clear) {
    offered_.read = read;
    offered_.clear = clear;
    if (clear) forget();
    queue_.clock(offered_);
  }

  void reset() {
    forget();
    model::HalfwordQueue::Inputs in;
    in.reset = true;
    queue_.clock(in);
  }

 private:
  void go_on(model::HalfwordQueue::Inputs& in) {
    const Halfwords& command = commands_.front();
    if (written_ == command.size()) {
      in.commit = true;
      commands_.pop_front();
      written_ = 0;
    } else if (queue_.free() != 0) {
      in.write = true;
      in.word = command[written_++];
    }
  }

  void forget() {
    commands_.clear();
    written_ = 0;
  }

  model::HalfwordQueue queue_;
  model::HalfwordQueue::Inputs offered_;
  std::deque<Halfwords> commands_;
  std::size_t written_ = 0;  // halfwords of the first command already written
};

}  // namespace trammel::lockstep
