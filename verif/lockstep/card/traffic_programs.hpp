// The programs that Traffic sends: paths and pieces, streams with stalls, position streaming, probes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "commands.hpp"
#include "traffic.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::test {

inline void Traffic::section(bool faulty) {
  const double pace = one_in(2) ? 1.001 + static_cast<double>(below(100)) * 0.05 : 8 + static_cast<double>(below(40));
  std::vector<std::vector<std::uint32_t>> geometry;
  std::uint64_t total = 0;
  const auto random = [this](std::uint64_t count) { return below(count); };
  for (std::uint64_t paths = 1 + below(6); paths != 0; --paths) {
    while (commands_every != 0 && one_in(commands_every)) driver::encode(beside_a_path(), 0, geometry.emplace_back());
    if (chords_every != 0 && axes_ > 1 && one_in(chords_every))
      geometry.push_back(random_chords(random, axes_, total));
    else
      driver::encode(random_path(random, axes_, pace, total, arc_every_), 0, geometry.emplace_back());
  }
  std::vector<driver::Command> pieces;
  for (std::uint64_t left = total; left != 0;) {
    const std::uint64_t ticks = one_in(3) ? left : 1 + below(left);
    driver::FeedCommand piece = random_piece(random, ticks, pace);
    if (classes) piece.piece_class = static_cast<driver::PieceClass>(one_in(3) ? below(3) : below(2));
    piece.silent = one_in(8);
    if (one_in(2)) piece.slew_shift = static_cast<std::uint8_t>(below(4));
    pieces.emplace_back(piece);
    left -= ticks;
  }
  // If pieces and paths do not cover the same ticks, there is a fault at the next barrier.
  if (one_in(25)) pieces.pop_back();
  auto path = geometry.begin();
  auto piece = pieces.begin();
  while (path != geometry.end() || piece != pieces.end()) {
    const bool geometry_next = piece == pieces.end() || (path != geometry.end() && one_in(2));
    const bool broken = faulty && one_in(12);
    if (!(geometry_next ? send_words(*path++, broken) : send(*piece++, broken))) {
      // After a refusal everything is refused until an abort, which need not come at once.
      if (!one_in(3)) abort();
      return;
    }
    if (one_in(30)) host_.write(reg::kControl, field::kControlFlush);
  }
  switch (below(4)) {
    case 0:
      send(driver::DwellCommand{one_in(3) ? below(3) : below(300)});
      break;
    case 1:
      send(driver::EndCommand{});
      if (one_in(2)) send(driver::DwellCommand{below(40)});
      break;
    default:
      break;
  }
}

inline void Traffic::starved() {
  if (!one_in(4)) recover();
  const double pace = 1.01 + static_cast<double>(below(40)) * 0.1;
  const std::uint32_t slew = std::uint32_t{1} << (14 + below(14));
  const std::uint64_t before = host_.read(reg::kUnderruns).value_or(0);
  host_.write(reg::kSlew, slew);
  // A stop takes 2^29 / slew / pace ticks.
  const auto stop = static_cast<std::uint32_t>(0x1p29 / slew / pace);
  const auto random = [this](std::uint64_t count) { return below(count); };
  std::uint64_t paths = 0;
  std::uint64_t pieces = 0;
  for (std::uint64_t left = 2 + below(30); left != 0; --left) {
    std::uint64_t ticks = 0;
    const bool chords = chords_every != 0 && axes_ > 1 && one_in(chords_every);
    if (!(chords ? send_words(random_chords(random, axes_, ticks), false)
                 : send(random_path(random, axes_, pace, ticks, arc_every_))))
      return abort();
    paths += ticks;
    if (one_in(3)) host_.wait(below(one_in(4) ? 8000 : 600));
    while (pieces < paths && (left == 1 || !one_in(3))) {
      driver::FeedCommand piece =
          random_piece(random, left == 1 ? paths - pieces : 1 + below(2 * (paths - pieces)), pace);
      if (one_in(2)) piece.slew_shift = static_cast<std::uint8_t>(below(4));
      piece.stop_distance = left == 1 && !one_in(4) ? 0 : 1 + stop / (one_in(6) ? 10 : 1);
      if (!send(piece)) return abort();
      pieces += piece.ticks;
    }
    if (one_in(12)) hold();
    if (one_in(12)) set_ratio(reg::kRatioFeed, static_cast<std::uint32_t>(below(0x10001)));
  }
  host_.write(reg::kHold, 0);
  host_.wait(below(4000));
  if (one_in(3)) send(driver::EndCommand{});
  if (one_in(3)) abort();
  underruns += host_.read(reg::kUnderruns).value_or(0) - before;
}

inline void Traffic::streamed() {
  if (!one_in(6)) recover();
  const std::uint64_t period = 30 + below(one_in(2) ? 60 : 600);  // ticks, of about two clocks
  const std::uint32_t stale_periods = static_cast<std::uint32_t>(below(4));
  const std::uint32_t mode = field::kStreamingOn | stale_periods << field::kStreamingStalePeriodsShift;
  host_.write(reg::kStopReaction, one_in(3) ? 0 : field::kStopReactionMissingPeriod);
  host_.write(reg::kSlew, std::uint32_t{1} << (17 + below(11)));
  if (!one_in(8)) host_.write(reg::kStreaming, mode);
  const auto period_words = [&](std::uint64_t ticks) {
    std::vector<std::int64_t> pulses(axes_);
    for (std::int64_t& p : pulses)
      p = static_cast<std::int64_t>(below(ticks / 4 + 2)) - static_cast<std::int64_t>(ticks / 8);
    std::vector<std::uint32_t> words;
    driver::encode(line(ticks, pulses), number_++, words);
    return words;
  };
  // One piece for all paths, or one for each; some change their rate.
  const bool single = one_in(2);
  const auto piece = [&] {
    driver::FeedCommand p = feed(one_in(3) ? 1 : period, 2);
    if (one_in(4)) p.acceleration = static_cast<std::int64_t>(odd_number(54));
    return send(p);
  };
  const auto refused = [&] {
    missing += (host_.read(reg::kFault).value_or(0) & field::kFaultMissingPeriod) != 0 ? 1U : 0U;
    host_.read(reg::kStaleTicks);
    abort();
  };
  if (!piece()) return refused();
  for (std::uint64_t left = 2 + below(12); left != 0; --left) {
    if (!single && !piece()) return refused();
    const std::vector<std::uint32_t> words = period_words(one_in(4) ? 1 + below(period) : period);
    for (const std::uint32_t word : words) {
      if (!host_.write(reg::kStream, word)) return refused();
      if (one_in(words.size())) host_.wait(below(one_in(4) ? 4 * period : one_in(2) ? period : 20));
    }
    if (commands_every != 0 && one_in(8)) send(beside_a_path());
    if (one_in(10)) host_.write(reg::kHold, static_cast<std::uint32_t>(below(2)));
    if (one_in(10)) host_.write(reg::kRatioFeed, static_cast<std::uint32_t>(one_in(2) ? 0 : below(0x10001)));
    if (one_in(10)) host_.write(reg::kStreaming, one_in(2) ? 0 : mode);
    if (one_in(30)) disturb();
    if (one_in(2)) host_.read(reg::kStaleTicks);
    stale += (status() & field::kStatusStale) != 0 ? 1U : 0U;
  }
  host_.write(reg::kHold, 0);
  host_.write(reg::kRatioFeed, 0x10000);
  if (one_in(3)) send(driver::EndCommand{});
  host_.wait(below(8 * period));
  missing += (host_.read(reg::kFault).value_or(0) & field::kFaultMissingPeriod) != 0 ? 1U : 0U;
  host_.read(reg::kStaleTicks);
  host_.write(reg::kStreaming, 0);
  if (one_in(2)) abort();
  if (!one_in(3)) host_.write(reg::kFault, 0xFFFF);
  host_.read(reg::kStreaming);
}

inline void Traffic::probing() {
  const double pace = 1.01 + static_cast<double>(below(40)) * 0.1;
  const auto random = [this](std::uint64_t count) { return below(count); };
  // Inputs that nobody touches: the armed probe misses.
  const bool untouched = one_in(3);
  const auto touch = [this, untouched] {
    if (!untouched) flip_a_pin();
  };
  const auto input = [this] { return static_cast<std::uint8_t>(below(one_in(20) ? 16 : 4)); };
  // Mostly for a level that the input does not have at present.
  const auto probe = [this, input, untouched] {
    const std::uint8_t n = input();
    const bool now = (host_.pins() >> n & 1) != 0;
    return driver::ProbeCommand{n, !untouched && one_in(6) ? now : !now};
  };
  if (one_in(3)) host_.write(reg::kSlew, std::uint32_t{1} << (16 + below(12)));
  if (one_in(2)) host_.write(reg::kControl, field::kControlProbeClear);
  for (std::uint64_t sections = 1 + below(3); sections != 0; --sections) {
    if (!send(probe())) return abort();
    std::uint64_t ticks = 0;
    for (std::uint64_t paths = below(5); paths != 0; --paths) {
      const bool chords = chords_every != 0 && axes_ > 1 && one_in(chords_every);
      const bool good = chords ? send_words(random_chords(random, axes_, ticks), false)
                               : send(random_path(random, axes_, pace, ticks, arc_every_));
      if (!good || (one_in(3) && !send(beside_a_path()))) return abort();
      if (one_in(10) && !send(probe())) return abort();
      if (one_in(6)) touch();
    }
    if (ticks != 0 && !send(random_piece(random, ticks, pace))) return abort();
    if (one_in(3) && !send(driver::WaitInputCommand{input(), one_in(2), one_in(4) ? 0 : below(400)})) return abort();
    if (one_in(4) && !send(driver::DwellCommand{below(300)})) return abort();
    if (!one_in(10) && !send(driver::ProbeEndCommand{})) return abort();
    if (one_in(2)) touch();
  }
  std::uint64_t ticks = 0;
  send(random_path(random, axes_, pace, ticks, arc_every_));
  send(random_piece(random, ticks, pace));
  for (std::uint64_t waits = untouched ? 24 : below(12); waits != 0; --waits) {
    host_.wait(below(300));
    if (one_in(2)) touch();
    const std::uint32_t now = status();
    probed += (now & field::kStatusProbed) != 0 ? 1U : 0U;
    missed += (now & field::kStatusProbeMissed) != 0 ? 1U : 0U;
    if (one_in(2)) host_.write(reg::kControl, field::kControlProbeClear);
  }
}

}  // namespace trammel::test
