// Walks the feed pieces and paths of a command stream together, and cuts the motion into intervals of one path at one
// rate.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <variant>
#include <vector>

#include "trammel/driver/commands.hpp"

namespace trammel::test {

// A path of the stream: either a line or an arc.
struct Path {
  std::size_t command = 0;  // number of its command, from 0
  std::uint64_t ticks = 0;  // feed ticks
  const driver::LineCommand* line = nullptr;
  const driver::ArcChordCommand* arc = nullptr;
};

// Clocks at one rate of the feed generator, on one path.
struct Interval {
  const Path* path = nullptr;
  std::uint64_t ticks = 0;  // ticks of the path before the interval
  std::uint64_t phase = 0;  // 2^-48 ticks, before the interval
  std::uint64_t clock = 0;  // clock of the motion; barriers take no time here
  std::uint64_t clocks = 0;
  std::uint64_t rate = 0;         // 2^-48 ticks per clock
  std::int64_t gain = 0;          // rate of the piece's next update, if it comes, minus this rate
  std::int64_t acceleration = 0;  // 2^-64 ticks per clock, per update
  std::int64_t jerk = 0;          // 2^-64 ticks per clock, per update^2
  bool begins_path = false;
  bool begins_piece = false;
};

class MotionWalk {
 public:
  // Clocks from the carry of the last tick of a piece to the first clock at the rate of the next piece. The tick is
  // visible 3 clocks after its carry, owed one clock later and taken then. The swap is visible one clock after that,
  // and the next slope applies from the following clock.
  static constexpr std::uint64_t kSwapClocks = 6;

  explicit MotionWalk(const std::vector<driver::Command>& commands) {
    for (std::size_t i = 0; i < commands.size(); ++i) add(commands[i], i);
  }

  // For each stretch between two barriers in which something moves: calls visitor.start(), visitor.interval(const
  // Interval&) for each interval, and visitor.stop().
  template <typename Visitor>
  void visit(Visitor& visitor) {
    std::size_t path = 0;
    std::size_t piece = 0;
    for (const Barrier& barrier : barriers_) {
      match(path, piece, barrier);
      if (path < barrier.paths) stretch(path, piece, barrier, visitor);
      path = barrier.paths;
      piece = barrier.pieces;
    }
  }

  std::uint64_t clocks() const { return clock_; }

 private:
  struct Barrier {
    std::size_t paths;  // paths before the barrier
    std::size_t pieces;
  };

  void add(const driver::Command& command, std::size_t number) {
    if (const auto* line = std::get_if<driver::LineCommand>(&command)) {
      paths_.push_back({number, line->ticks, line, nullptr});
    } else if (const auto* arc = std::get_if<driver::ArcChordCommand>(&command)) {
      paths_.push_back({number, arc->ticks, nullptr, arc});
    } else if (const auto* feed = std::get_if<driver::FeedCommand>(&command)) {
      pieces_.push_back(feed);
    } else if (std::holds_alternative<driver::DwellCommand>(command) ||
               std::holds_alternative<driver::EndCommand>(command)) {
      barriers_.push_back({paths_.size(), pieces_.size()});
    } else {
      throw std::runtime_error("a path that this reading does not know");
    }
  }

  void match(std::size_t path, std::size_t piece, const Barrier& to) const {
    std::uint64_t geometry = 0;
    std::uint64_t feed = 0;
    for (; path < to.paths; ++path) geometry += paths_[path].ticks;
    for (; piece < to.pieces; ++piece) feed += pieces_[piece]->ticks;
    if (geometry != feed) throw std::runtime_error("ticks of paths and pieces differ before a barrier");
  }

  template <typename Visitor>
  void stretch(std::size_t path, std::size_t piece, const Barrier& to, Visitor& visitor) {
    visitor.start();
    Interval at;
    const auto enter = [&] {
      at.path = &paths_[path];
      at.ticks = 0;
      at.begins_path = true;
    };
    enter();
    std::uint64_t ahead = 0;  // ticks of the piece that came at the last rates of the previous piece
    for (; piece < to.pieces; ++piece) {
      Rate rate(*pieces_[piece]);
      at.begins_piece = true;
      std::uint64_t left = pieces_[piece]->ticks - ahead;
      std::uint64_t clocks = 32;
      // One rate for at most `most` clocks, and at most up to the last of `ticks` ticks.
      const auto hold = [&](std::uint64_t most, std::uint64_t& ticks) {
        at.rate = rate.slope();
        at.gain = static_cast<std::int64_t>(rate.next_slope()) - static_cast<std::int64_t>(at.rate);
        at.acceleration = rate.acceleration();
        at.jerk = pieces_[piece]->jerk;
        while (most != 0 && ticks != 0 && path < to.paths) {
          const std::uint64_t path_left = at.path->ticks - at.ticks;
          const std::uint64_t gone = run(at, std::min(ticks, path_left), most);
          visitor.interval(at);
          clock_ += at.clocks;
          at.phase += at.rate * at.clocks - (gone << 48);
          at.begins_piece = at.begins_path = false;
          at.ticks += gone;
          ticks -= gone;
          most -= at.clocks;
          clocks -= at.clocks;
          if (gone == path_left && ++path < to.paths) enter();
        }
      };
      for (; left != 0; clocks = 32, rate.update()) {
        hold(32, left);
        if (left == 0) break;
      }
      // The last tick is in progress: the rate continues until that of the next piece replaces it.
      ahead = 0;
      if (piece + 1 == to.pieces) break;
      for (std::uint64_t rest = kSwapClocks; rest != 0;) {
        if (clocks == 0) {
          rate.update();
          clocks = 32;
        }
        const std::uint64_t part = std::min(rest, clocks);
        std::uint64_t free = pieces_[piece + 1]->ticks - ahead;
        const std::uint64_t before = free;
        hold(part, free);
        ahead += before - free;
        rest -= part;
      }
    }
    visitor.stop();
  }

  // At most `clocks` clocks, and none after the `most`-th tick; returns the ticks in these clocks.
  std::uint64_t run(Interval& at, std::uint64_t most, std::uint64_t clocks) {
    at.clock = clock_;
    const std::uint64_t ticks = (at.phase + at.rate * clocks) >> 48;  // rate < 1, clocks <= 32: 54 bits
    if (ticks < most) {
      at.clocks = clocks;
      return ticks;
    }
    at.clocks = ((most << 48) - at.phase + at.rate - 1) / at.rate;  // at most 32 ticks per call: 53 bits
    return most;
  }

  // Rates of a piece: R += A, A += J in every 32nd clock, clamped between the floor and one tick per clock. The first
  // rate is not clamped.
  __extension__ using Wide = __int128;
  class Rate {
   public:
    explicit Rate(const driver::FeedCommand& piece)
        : rate_(piece.rate), acceleration_(piece.acceleration), jerk_(piece.jerk), floor_(piece.floor) {
      slope_ = piece.rate >> 16;
    }
    std::uint64_t slope() const { return slope_; }
    std::int64_t acceleration() const { return static_cast<std::int64_t>(acceleration_); }
    std::uint64_t next_slope() const { return clamped(rate_ + acceleration_); }
    void update() {
      rate_ += acceleration_;
      acceleration_ += jerk_;
      slope_ = clamped(rate_);
    }

   private:
    std::uint64_t clamped(Wide rate) const {
      if (rate < static_cast<Wide>(floor_) << 32) return static_cast<std::uint64_t>(floor_) << 16;
      if (rate >> 64 != 0) return (std::uint64_t{1} << 48) - 1;
      return static_cast<std::uint64_t>(rate >> 16);
    }
    Wide rate_;
    Wide acceleration_;
    Wide jerk_;
    std::uint32_t floor_;
    std::uint64_t slope_;
  };

  std::vector<Path> paths_;
  std::vector<const driver::FeedCommand*> pieces_;
  std::vector<Barrier> barriers_;
  std::uint64_t clock_ = 0;
};

}  // namespace trammel::test
