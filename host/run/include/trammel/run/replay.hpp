// Continues a program from a place on its path. The program is planned from its first line, as for the whole run, and
// the Replay drops everything before the place. Every later path therefore has the ticks, the feed pieces and the steps
// of the undisturbed run. Plain data, and a filter between planner and stream; not thread-safe.
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

// A place on the path of a program: a command, and its remaining ticks, as in the card's area REST.
struct PathPlace {
  static constexpr std::uint64_t kAllTicks = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t command = 0;             // earlier commands that count in GEOMETRY_BEGUN
  std::uint64_t ticks_left = kAllTicks;  // remaining feed ticks; kAllTicks: not begun; barrier: 0 or kAllTicks
};

// The program does not have this place: it is another program, or was planned differently.
class ReplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The rest of a piece after `gone` of its ticks (fewer than it has). The first result is the rest of the current update
// of the feed generator, at its rate; the second is a piece from the next update on, computed from the generator's
// forward differences. The ticks have the same times as those of the original piece, to within one tick. If the rest
// would reverse before its end, it slows down evenly to its end instead. Pure.
std::vector<driver::FeedCommand> rest_of(const driver::FeedCommand& piece, std::uint64_t gone);

// Passes on the commands of a program from a place on, in this order: an OUTPUT with the output levels that the earlier
// commands have left, if they switched any; if the place is inside a path, a silent piece for the ticks of it that are
// done; the rest of the current feed piece; the whole interrupted path; then all later commands. An interrupted barrier
// is passed on whole. MARKs before the place are dropped.
class Replay final : public driver::CommandSink {
 public:
  // `next` must outlive the replay. Its exceptions pass through.
  Replay(driver::CommandSink& next, const PathPlace& place) : next_(next), place_(place) {}
  // Begins at the first counted command after a call of here().
  explicit Replay(driver::CommandSink& next) : next_(next) {}
  void here();

  // Takes all commands of the program from its first one on. Throws ReplayError if the command has fewer ticks than the
  // place requires, and for a probe before the place, because the end of the probe is unknown.
  void put(const driver::Command& command) override;

  // Whether the place was reached, so commands are passed on.
  bool begun() const { return begun_; }
  // Commands before the place that count in GEOMETRY_BEGUN; final when begun() is true.
  std::uint64_t skipped() const { return geometry_; }
  // Feed ticks already done of the path that contains the place: those of the silent piece, 0 without one.
  std::uint64_t ticks_done() const { return done_; }

 private:
  struct Piece {
    std::uint64_t begin;  // total ticks of the earlier pieces
    driver::FeedCommand feed;
  };

  void geometry(const driver::Command& command);
  void begin(const driver::Command& command);
  void put_pieces(std::uint64_t from);

  driver::CommandSink& next_;
  std::optional<PathPlace> place_;
  std::uint64_t geometry_ = 0;     // counted commands before the place
  std::uint64_t path_ticks_ = 0;   // ticks of these paths
  std::uint64_t piece_ticks_ = 0;  // ticks of all pieces
  std::uint64_t done_ = 0;         // ticks already done of the path at the place
  std::deque<Piece> pieces_;       // pieces that end after these paths
  driver::OutputCommand outputs_;
  std::optional<driver::PwmCommand> pulses_;  // last PWM command; a program uses only one channel
  bool begun_ = false;
};

}  // namespace trammel::run
