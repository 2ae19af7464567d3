// Random programs for a pair of cores.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core_pair.hpp"

namespace trammel::testing {

// Random settings, paths, pieces and barriers of a program.
class Program {
 public:
  explicit Program(Pair& pair) : p_(pair), axes_(pair.clocked.core.config().axes) {}

  void settings() {
    const auto times = [this](std::uint64_t most) {
      return static_cast<std::uint32_t>(p_.one_in(3) ? 0 : p_.any(0, most));
    };
    const std::uint64_t most = p_.one_in(4) ? 200 : 12;
    for (unsigned n = 0; n < axes_; ++n) {
      p_.write(card_map::reg::step_length(n), times(most));
      p_.write(card_map::reg::step_space(n), times(most));
      p_.write(card_map::reg::dir_setup(n), times(most));
      p_.write(card_map::reg::dir_hold(n), times(most));
      p_.write(card_map::reg::mode(n), static_cast<std::uint32_t>(p_.one_in(2) ? 0 : p_.any(0, 3) << 2 | p_.any(0, 2)));
    }
    for (const std::uint32_t ratio :
         {card_map::reg::kRatioFeed, card_map::reg::kRatioRapid, card_map::reg::kRatioFixed})
      p_.write(ratio, static_cast<std::uint32_t>(p_.one_in(2) ? 0x10000 : p_.any(0x100, 0x10000)));
    if (p_.one_in(2)) p_.write(card_map::reg::kGeometryWatermark, static_cast<std::uint32_t>(p_.any(1, 60)));
    if (p_.one_in(2)) p_.write(card_map::reg::kFeedWatermark, static_cast<std::uint32_t>(p_.any(1, 60)));
    if (p_.one_in(2)) p_.write(card_map::reg::kIrqEnable, static_cast<std::uint32_t>(p_.any(0, (1U << 18) - 1)));
    if (p_.one_in(3))
      p_.write(card_map::reg::kHoldLimit, static_cast<std::uint32_t>(p_.any(1, p_.one_in(2) ? 60 : 2000)));
    if (p_.one_in(3))
      p_.write(card_map::reg::kStopReaction, static_cast<std::uint32_t>(p_.any(0, 255) | p_.any(0, 1) << 10));
    if (p_.one_in(8)) p_.write(card_map::reg::kStreaming, 1U | static_cast<std::uint32_t>(p_.any(0, 2)) << 8);
  }

  // A tick about every `pace` clocks.
  void paths_and_pieces(double pace) {
    std::uint64_t ticks = 0;
    const bool probing = p_.one_in(2);
    if (probing) conditional(card_map::Opcode::Probe, 0);
    for (std::uint64_t paths = p_.any(1, 5); paths != 0; --paths) {
      instants();
      const std::uint64_t n = p_.one_in(4) ? p_.any(1, 40) : p_.any(100, 3000);
      const bool chords = card_map::has_engine(p_.clocked.core.config().engines, card_map::engine::kArcGenerator);
      if (axes_ >= 2 && chords && p_.one_in(2))
        ticks += chord_arc(n);
      else
        ticks += axes_ >= 2 && p_.one_in(5) ? circle(n) : line(n);
    }
    while (ticks != 0) {
      const std::uint64_t n = std::min(ticks, p_.one_in(4) ? p_.any(1, 30) : p_.any(30, 4000));
      piece(n, pace);
      ticks -= n;
    }
    instants();
    if (p_.one_in(2)) barrier();
    instants();
    if (p_.one_in(6)) conditional(card_map::Opcode::WaitInput, p_.one_in(3) ? 0 : p_.sized(12));
    if (probing && !p_.one_in(6)) p_.send(command_words(card_map::Opcode::ProbeEnd, 0, number_++, 0, {}));
  }

  // Only arcs in chords.
  void arcs(double pace) {
    std::uint64_t ticks = 0;
    for (int i = 0; i < 4; ++i) ticks += chord_arc(p_.any(500, 3000));
    piece(ticks, pace);
    barrier();
  }

  // The card refuses the move while anything runs.
  void direct_move() {
    for (unsigned n = 0; n < axes_; ++n) {
      p_.write(card_map::reg::frequency_lo(n), static_cast<std::uint32_t>(p_.random()));
      p_.write(card_map::reg::frequency_hi(n), static_cast<std::uint32_t>(p_.any(0, 40)));
      p_.write(card_map::reg::count(n), static_cast<std::uint32_t>(p_.any(0, 40)));
      p_.write(card_map::reg::direction(n), static_cast<std::uint32_t>(p_.any(0, 1)));
    }
    p_.write(card_map::reg::kLengthLo, static_cast<std::uint32_t>(p_.any(1, 2000)));
    p_.write(card_map::reg::kStart, static_cast<std::uint32_t>(p_.any(1, (1U << axes_) - 1)));
  }

  // Adds PWM commands to those beside the path.
  bool pwm = false;

 private:
  void pulses() {
    const std::uint64_t select = p_.any(0, 1) | p_.any(0, 1) << 4 | p_.any(0, 12) << 8;
    p_.send(command_words(card_map::Opcode::Pwm, 0, number_++, 0,
                          {{"select", select}, {"duty", p_.any(0, 0xFFFF)}, {"gain", p_.any(0, 0xFFFF)}}));
  }

  // Random commands that are neither paths nor barriers.
  void instants() {
    while (p_.one_in(3)) {
      if (pwm && p_.one_in(2))
        pulses();
      else if (p_.one_in(2))
        p_.send(command_words(card_map::Opcode::Mark, 0, number_++, 0, {}));
      else
        p_.send(command_words(card_map::Opcode::Output, 0, number_++, 0,
                              {{"set", p_.any(0, 0xFFFF)}, {"clear", p_.any(0, 0xFFFF)}}));
    }
  }

  void conditional(card_map::Opcode opcode, std::uint64_t count) {
    p_.send(command_words(opcode, 0, number_++, count, {{"condition", p_.any(0, 1) << 5 | p_.any(0, 3)}}));
  }

  std::uint64_t line(std::uint64_t ticks) {
    const auto mask = static_cast<std::uint8_t>(p_.any(1, (1U << axes_) - 1));
    std::vector<std::int64_t> increments;
    for (unsigned n = 0; n < card_map::axes_in(mask); ++n) {
      const auto magnitude = static_cast<std::int64_t>(p_.one_in(3) ? p_.sized(40) : p_.any(0, std::uint64_t{1} << 34));
      increments.push_back(p_.one_in(2) ? magnitude : -magnitude);
    }
    p_.send(command_words(card_map::Opcode::Line, mask, number_++, ticks, {}, increments));
    return ticks;
  }

  std::uint64_t circle(std::uint64_t ticks) {
    const std::int64_t r = static_cast<std::int64_t>(p_.any(1, 6));
    ticks = std::max<std::uint64_t>(ticks, static_cast<std::uint64_t>(8 * r));
    const bool can = card_map::has_engine(p_.clocked.core.config().engines, card_map::engine::kAccumulator8);
    const bool eight = can && p_.one_in(2);
    p_.send(CoreBench::circle_words(number_++, ticks, r, p_.one_in(2), eight));
    return ticks;
  }

  // An arc in chords with a random set of further axes.
  std::uint64_t chord_arc(std::uint64_t ticks) {
    const auto x = static_cast<unsigned>(p_.any(0, axes_ - 1));
    const auto y = static_cast<unsigned>((x + p_.any(1, axes_ - 1)) % axes_);
    const auto mask = static_cast<std::uint8_t>(1U << x | 1U << y | p_.any(0, (1U << axes_) - 1));
    const auto any = [this](unsigned bits) {
      const auto magnitude = static_cast<std::int64_t>(p_.sized(bits));
      return p_.one_in(2) ? magnitude : -magnitude;
    };
    const std::uint64_t path_ticks = p_.any(p_.one_in(2) ? 1 : ticks / 2, ticks);
    const auto k = static_cast<unsigned>(p_.any(1, 24));
    std::vector<std::int64_t> further;
    for (unsigned n = 2; n < card_map::axes_in(mask); ++n) further.push_back(any(36));
    const bool taken = p_.send(command_words(card_map::Opcode::ArcChord, mask, number_++, ticks,
                                             {{"path_ticks", path_ticks},
                                              {"prescale", ((int128{path_ticks} << 40) + ticks / 2) / ticks},
                                              {"plane", y << 8 | x << 4 | p_.any(0, 1)},
                                              {"shifts", k | p_.any(5, 13) << 8},
                                              {"x", any(k + 38)},
                                              {"y", any(k + 38)},
                                              {"first_x", any(38)},
                                              {"first_y", any(38)},
                                              {"closing_x", any(30)},
                                              {"closing_y", any(30)}},
                                             further));
    p_.chord_arcs += taken ? 1 : 0;
    return ticks;
  }

  void piece(std::uint64_t ticks, double pace) {
    const auto rate = static_cast<std::uint64_t>(0x1p64 / pace);
    const auto floor = static_cast<std::uint32_t>(std::max(1.0, 0x1p32 / pace / 3));
    std::int64_t acceleration = 0;
    std::int64_t jerk = 0;
    if (p_.one_in(2)) {
      acceleration = static_cast<std::int64_t>(p_.random()) / static_cast<std::int64_t>(pace * pace * 900);
      if (p_.one_in(2)) jerk = acceleration / -97;
    }
    const auto piece_class = static_cast<std::uint8_t>(p_.one_in(2) ? 0 : p_.any(0, 2));
    p_.send(command_words(card_map::Opcode::Feed, piece_class, number_++, ticks,
                          {{"rate", rate},
                           {"acceleration", acceleration},
                           {"jerk", jerk},
                           {"floor", floor},
                           {"stop_distance", p_.one_in(2) ? 0 : p_.any(1, p_.one_in(4) ? 5000 : 400)}}));
  }

  void barrier() {
    if (p_.one_in(3))
      p_.send(command_words(card_map::Opcode::End, 0, number_++, 0, {}));
    else
      p_.send(command_words(card_map::Opcode::Dwell, 0, number_++, p_.sized(12), {}));
  }

  Pair& p_;
  unsigned axes_;
  std::uint8_t number_ = 0;
};

}  // namespace trammel::testing
