// A host for card tests: sends commands over the bus, waits, aborts; and random programs, the same for the same seed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/arc.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::test {

namespace reg = card_map::reg;
namespace field = card_map::field;

class Host {
 public:
  explicit Host(sim::Engine& engine) : card(engine) {}

  void send(const driver::Command& command) {
    std::vector<std::uint32_t> words;
    driver::encode(command, number_++, words);
    for (const std::uint32_t word : words) card.write(reg::kStream, word);
  }
  void abort() {
    card.write(reg::kControl, field::kControlAbort);
    number_ = 0;
  }
  std::uint32_t status() { return card.read(reg::kStatus); }
  // False when the card is still busy after `clocks`.
  bool wait_idle(std::uint64_t clocks) {
    const std::uint64_t begin = card.cycles();
    while ((status() & field::kStatusBusy) != 0) {
      if ((status() & field::kStatusFaulted) != 0 || card.cycles() - begin > clocks) return false;
      card.wait(50);
    }
    return true;
  }
  // The same step times for every axis, clocks.
  void set_times(unsigned axes, std::uint32_t length, std::uint32_t space, std::uint32_t setup, std::uint32_t hold) {
    for (unsigned n = 0; n < axes; ++n) {
      card.write(reg::step_length(n), length);
      card.write(reg::step_space(n), space);
      card.write(reg::dir_setup(n), setup);
      card.write(reg::dir_hold(n), hold);
    }
  }

  sim::Engine& card;

 private:
  std::uint8_t number_ = 0;
};

// A line of p pulses on each axis over `ticks` ticks.
inline driver::Line line(std::uint64_t ticks, const std::vector<std::int64_t>& pulses) {
  driver::Line result;
  result.ticks = ticks;
  for (std::size_t n = 0; n < pulses.size(); ++n) {
    if (pulses[n] == 0) continue;
    result.mask = static_cast<std::uint8_t>(result.mask | 1U << n);
    const auto magnitude = static_cast<std::uint64_t>(std::abs(pulses[n])) << 40;
    const auto increment = static_cast<std::int64_t>((magnitude + ticks / 2) / ticks);
    result.increment[n] = pulses[n] < 0 ? -increment : increment;
  }
  if (result.mask == 0) result.mask = 1;
  return result;
}

// A piece at a constant rate of one tick in `clocks`.
inline driver::Feed feed(std::uint64_t ticks, double clocks) {
  driver::Feed result;
  result.ticks = ticks;
  result.rate = static_cast<std::uint64_t>(0x1p64 * std::min(1 / clocks, 1 - 0x1p-50));
  result.floor = 1;
  return result;
}

class RandomProgram {
 public:
  RandomProgram(Host& host, unsigned axes, std::uint64_t seed) : host_(host), axes_(axes), random_(seed) {}

  // A few paths, the feed pieces for them in any order between, and a barrier behind; and some traffic meanwhile.
  void section() {
    std::vector<driver::Command> geometry;
    std::uint64_t total = 0;
    // Clocks for one tick, from nearly one to many.
    const double pace =
        one_of(3) == 0 ? 1.001 + static_cast<double>(one_of(100)) * 0.05 : 8 + static_cast<double>(one_of(40));
    for (std::uint64_t paths = 1 + one_of(8); paths != 0; --paths) geometry.push_back(path(pace, total));
    std::vector<driver::Command> pieces;
    while (total != 0) {
      const std::uint64_t ticks = one_of(3) == 0 ? total : 1 + one_of(total);
      pieces.push_back(piece(ticks, pace));
      total -= ticks;
    }
    auto next = geometry.begin();
    for (const driver::Command& piece : pieces) {
      while (next != geometry.end() && one_of(2) == 0) host_.send(*next++);
      host_.send(piece);
      if (one_of(6) == 0) disturb();
    }
    while (next != geometry.end()) host_.send(*next++);
    if (one_of(2) == 0)
      host_.send(driver::Dwell{one_of(3) == 0 ? 0 : one_of(200)});
    else
      host_.send(driver::End{});
    host_.card.wait(one_of(2000));
  }

  // A read, a snapshot, a hold, another ratio.
  void disturb() {
    sim::Engine& card = host_.card;
    switch (one_of(6)) {
      case 0:
        card.write(reg::kHold, one_of(2) == 0 ? 1 : 0);
        break;
      case 1:
        card.write(reg::kRatio, static_cast<std::uint32_t>(0x4000 + one_of(0xC001)));
        break;
      case 2:
        card.write(reg::kSlew, static_cast<std::uint32_t>(1 + one_of(0xFFFFFF)));
        break;
      case 3:
        card.write(reg::kControl, field::kControlSnapshot);
        break;
      case 4:
        card.read(reg::snap_position(static_cast<std::uint32_t>(one_of(axes_))));
        break;
      default:
        card.read(reg::kRunning);
        break;
    }
    card.wait(one_of(100));
  }

  // Lets the program end; after a fault, clears up.
  void finish() {
    host_.card.write(reg::kHold, 0);
    host_.card.write(reg::kRatio, 0x10000);
    host_.card.write(reg::kSlew, 0xFFFFFFF);
    if (host_.wait_idle(400'000)) return;
    if (one_of(2) == 0) host_.card.write(reg::kFault, 0x3FF);
    host_.abort();
    host_.card.wait(one_of(300));
    host_.card.write(reg::kFault, 0x3FF);
    host_.card.wait(20);
  }

  std::uint64_t one_of(std::uint64_t count) { return random_() % count; }

 private:
  driver::Command path(double pace, std::uint64_t& total) {
    const std::uint64_t ticks = one_of(3) == 0 ? 1 + one_of(30) : 1 + one_of(400);
    total += ticks;
    if (axes_ > 1 && one_of(4) == 0) {
      // A quarter or a whole circle of up to 20 pulses; one tick a clock leaves the accumulator behind, which stalls.
      driver::ArcGeometry arc;
      const auto radius = static_cast<std::int32_t>(1 + one_of(20));
      arc.clockwise = one_of(2) == 0;
      arc.centre_x = -radius * driver::kCentreUnitsPerPulse;
      const bool whole = one_of(3) == 0;
      arc.end_x = whole ? 0 : -radius;
      arc.end_y = whole ? 0 : (arc.clockwise ? -radius : radius);
      arc.sweep = whole ? 6.283185307179586 : 1.5707963267948966;
      arc.axis_x = static_cast<std::uint8_t>(one_of(axes_));
      arc.axis_y = static_cast<std::uint8_t>((arc.axis_x + 1 + one_of(axes_ - 1)) % axes_);
      driver::Arc command = driver::prepare(arc);
      total += command.path_ticks;
      return driver::with_ticks(command, ticks + command.path_ticks);
    }
    std::vector<std::int64_t> pulses(axes_);
    // Steps come no closer than the shaper serves them, but for some lines that overrun it.
    const double most = static_cast<double>(ticks) * (one_of(40) == 0 ? 1.0 : std::min(1.0, pace / 14));
    for (std::int64_t& p : pulses) {
      const auto bound = static_cast<std::uint64_t>(most) + 1;
      p = static_cast<std::int64_t>(one_of(2 * bound + 1)) - static_cast<std::int64_t>(bound);
      p = std::clamp(p, -static_cast<std::int64_t>(ticks), static_cast<std::int64_t>(ticks));
    }
    return line(ticks, pulses);
  }

  driver::Command piece(std::uint64_t ticks, double pace) {
    driver::Feed result = feed(ticks, pace);
    result.floor = static_cast<std::uint32_t>(0x1p32 / (4 * pace));
    if (one_of(2) == 0) {
      const double change = (static_cast<double>(one_of(2001)) - 1000) / 1000;
      result.acceleration = static_cast<std::int64_t>(change * 0x1p64 / pace / pace / static_cast<double>(ticks));
      result.jerk = -result.acceleration / static_cast<std::int64_t>(1 + one_of(100));
    }
    return result;
  }

  Host& host_;
  unsigned axes_;
  std::mt19937_64 random_;
};

}  // namespace trammel::test
