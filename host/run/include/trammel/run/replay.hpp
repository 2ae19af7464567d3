// Going on with a program at a place on its path. The program is planned from its first line, as for the whole run, and
// the Replay drops what comes before the place. So every path from there on, its ticks and its feed pieces are those of
// the undisturbed run, and with them every step. Plain data and a filter between planner and stream; not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "trammel/driver/command_sink.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::run {

// A place on the path of a program: a command, and how much of it is left, as the card's area REST says it.
struct PathPlace {
  static constexpr std::uint64_t kAllTicks = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t command = 0;             // commands of the program before it that count in GEOMETRY_BEGUN
  std::uint64_t ticks_left = kAllTicks;  // feed ticks of it; kAllTicks: none is done. Of a barrier 0 or kAllTicks
};

// A place that the program does not have: another program, or another plan of it.
class ReplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What is left of a piece behind `gone` of its ticks (fewer than it has): what is left of the update of the feed
// generator, at its rate, and a piece from the next update on, by the generator's forward differences. To a tick these
// are the times of the piece's own ticks. Where the remainder would reverse before its end it slows down evenly to it.
// Pure.
std::vector<driver::FeedCommand> rest_of(const driver::FeedCommand& piece, std::uint64_t gone);

// Passes on the commands of a program from a place on, in this order: an OUTPUT with what the commands before have
// left of the outputs, where they have switched any; where the place is inside a path, a silent piece over its ticks
// that are done; the rest of the feed piece in force; the interrupted path, whole; then all that follows. A barrier
// that was under way is passed on whole. MARKs before the place are dropped.
class Replay final : public driver::CommandSink {
 public:
  // `next` must outlive the replay. What it throws passes through.
  Replay(driver::CommandSink& next, const PathPlace& place) : next_(next), place_(place) {}
  // From the first counted command behind here() on.
  explicit Replay(driver::CommandSink& next) : next_(next) {}
  void here();

  // All commands of the program from its first one on. Throws ReplayError where the command has fewer ticks than
  // the place says, and for a probe before the place: where it ended is not known.
  void put(const driver::Command& command) override;

  // Whether it passes on what comes.
  bool begun() const { return begun_; }
  // Commands before the place that count in GEOMETRY_BEGUN: final once it has begun.
  std::uint64_t skipped() const { return geometry_; }
  // Feed ticks of the path in which it began that are done: those of the silent piece, 0 without one.
  std::uint64_t ticks_done() const { return done_; }

 private:
  struct Piece {
    std::uint64_t begin;  // ticks of pieces before it
    driver::FeedCommand feed;
  };

  void geometry(const driver::Command& command);
  void begin(const driver::Command& command);
  void put_pieces(std::uint64_t from);

  driver::CommandSink& next_;
  std::optional<PathPlace> place_;
  std::uint64_t geometry_ = 0;     // counted commands passed over
  std::uint64_t path_ticks_ = 0;   // of the paths passed over
  std::uint64_t piece_ticks_ = 0;  // of all pieces
  std::uint64_t done_ = 0;         // of the path at the place
  std::deque<Piece> pieces_;       // that end behind the paths passed over
  driver::OutputCommand outputs_;
  std::optional<driver::PwmCommand> pulses_;  // that were in force; a program has them on one channel
  bool begun_ = false;
};

}  // namespace trammel::run
