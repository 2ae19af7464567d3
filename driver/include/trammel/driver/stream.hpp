// The card's stream of commands: numbers the commands, waits for room, and writes each command as a whole.
//
// The card divides the stream into a geometry queue and a feed queue. A command waits in the host until the queue or
// queues that it enters have room for all of it. Geometry and feed must therefore come in an order in which the card
// can consume its queued commands while the next one waits: the commands that fill one queue must find their
// counterparts in the other. The planner sends them in such an order. Another order ends in a TimeoutError, not in a
// deadlock.
//
// put() does not allocate. Words are kept in a buffer of fixed size until it is full, until no room is known for the
// next command, or until flush().
//
// Thread-safety as of the card. Another thread holds or aborts through Card::request_hold() and Card::request_abort();
// put(), flush(), send() and finish() serve these requests whenever they wait.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/driver/command_sink.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {

struct StreamProgress {
  std::uint64_t commands_sent = 0;   // commands sent since the stream was opened or restarted
  Status status;                     // of the card
  std::uint32_t geometry_begun = 0;  // of these, begun from the geometry queue: paths and barriers
  std::uint32_t feed_begun = 0;      // of these, begun from the feed queue: pieces and barriers
};

enum class ProbeOutcome : std::uint8_t {
  kTripped,         // the edge came during the motion
  kTrippedAlready,  // the input had the level before the first path began; nothing moved
  kMissed,          // the paths ended without an edge
};
struct ProbeResult {
  ProbeOutcome outcome = ProbeOutcome::kMissed;
  // The state one clock after the edge appeared at the card's synchronised input; zeros when missed.
  Snapshot edge;
  Snapshot rest;  // the state at the end, at rest
};

struct StreamOptions {
  // Interval between two polls of the card, card clocks; 0: poll_interval(). If the bus has interrupts, the stream
  // waits for the end by interrupt, and if the card also has watermarks, for room in its queues too; polls are then
  // rare.
  std::uint64_t poll_clocks = 0;
  // The stream throws TimeoutError when the card is later than planned by more than this (card time). The plan covers
  // the commands begun: dwells, and pieces at the ratio of their class; holds do not count.
  std::chrono::nanoseconds margin = std::chrono::seconds(1);
  // Called at each poll while the stream waits. May throw: the exception passes through, and the stream stays usable.
  std::function<void(const StreamProgress&)> progress;
  // Waits out a hold that exists when the stream is opened, as it does with a later one.
  bool opens_in_hold = false;
};

class Stream final : public CommandSink {
 public:
  // Opens the card's stream: numbers start at 0, the queues are empty, no refusal is latched. Throws HeldError if the
  // card is in a hold that this program has not set, StateError if it is busy, FaultError if it has a fault,
  // ArgumentError for a margin that is not positive. `card` must outlive the stream.
  explicit Stream(Card& card, StreamOptions options = {});

  // Accepts a command to send, as a whole or not at all, and writes it now or later. Throws ArgumentError when the
  // command exceeds the ranges of its fields or the abilities of the card (axes, engines), and for a feed piece whose
  // jerk would reverse the feed before its end. Such a command is not accepted; earlier ones are not affected.
  //
  // When put() has to write or to wait for room it also throws LinkError, FaultError; TimeoutError when the card is
  // overdue; RefusedError when the card refuses a command, with the reason and the command's number (a later call may
  // report the refusal, and any refused access to the card counts); StateError when the card has not begun what it was
  // sent, because it was reset, or aborted by another program. After a RefusedError, a LinkError or a StateError the
  // stream is closed and its buffer dropped: all calls throw StateError until restart().
  void put(const Command& command) override;

  // Writes the commands that put() has buffered. Errors as in put().
  void flush();

  // put() and flush(). The second form checks all commands before the first access to the bus.
  void send(const Command& command);
  void send(const std::vector<Command>& commands);

  // Flushes and waits for the end: the card is idle, has begun every command, and, if the last command was End, has
  // ended. Returns the status. Errors as in put().
  Status finish();

  // Probes: waits for the end of all earlier commands, then moves along `paths` until the condition's input has its
  // level. From there the card ramps to rest along the path and drops the remaining paths. Waits until the card is at
  // rest; the stream continues from there. `paths` contains paths, their feed pieces and any commands between them.
  // Needs a card with path commands.
  //
  // Throws ArgumentError, before anything moves, for an input that the card lacks, for no paths, and for a PROBE,
  // PROBE_END or END among them; StateError if another program ended the probe; else as finish().
  ProbeResult probe(const ProbeCommand& condition, const std::vector<Command>& paths);

  // Drops the queued commands, stops the path and restarts at number 0. Throws FaultError if the card has a fault.
  void restart();

  // Number of the next command.
  std::uint8_t next_number() const { return static_cast<std::uint8_t>(sent_ + kept_); }
  // Commands written since the stream was opened or restarted.
  std::uint64_t sent() const { return sent_; }

 private:
  struct Need {  // halfwords in each queue
    std::uint32_t geometry = 0;
    std::uint32_t feed = 0;
  };
  struct Duration {  // clocks
    std::uint64_t gated = 0;
    std::uint64_t real = 0;
    PieceClass piece_class = PieceClass::kFeed;
  };
  // Commands of one queue: accepted by put(), written, and begun according to the last poll.
  struct Count {
    std::uint64_t put = 0;
    std::uint64_t sent = 0;
    std::uint64_t begun = 0;
  };
  class Wait;

  void reset();
  Need checked_need(const Command& command, std::uint32_t header);
  void check_input(const Command& command);
  void check_probing(const ProbeCommand& condition, const std::vector<Command>& paths);
  Status wait_for_probe();
  bool has_room(const Need& need) const { return need.geometry <= room_.geometry && need.feed <= room_.feed; }
  void wait_for_room(const Need& need);
  std::uint32_t wake_for(const Need& need) const;
  void refresh_room(const Need& need);
  void keep(const Command& command, const Need& need, const std::uint32_t* words, std::size_t count);
  void write_kept();
  Status look(Wait& wait);
  void advance(Count& count, std::uint32_t begun) const;
  bool all_begun() const { return geometry_.begun == geometry_.sent && feed_.begun == feed_.sent; }
  std::size_t slot(std::uint64_t number) const { return static_cast<std::size_t>(number % durations_.size()); }
  void require_open() const;
  template <class Call>
  auto closing_at_errors(Call call);

  Card* card_;
  StreamOptions options_;
  std::uint64_t margin_clocks_;
  std::uint64_t poll_clocks_;
  std::vector<Access> accesses_;  // buffered writes: the first used_ are valid; of fixed size
  // Ring, by number: durations of the feed queue's commands that may be under way.
  std::vector<Duration> durations_;
  std::size_t used_ = 0;
  std::size_t kept_ = 0;  // buffered commands
  Need room_;             // room known to be free; never more than the card has
  std::uint64_t sent_ = 0;
  Count geometry_;
  Count feed_;
  std::optional<unsigned> inputs_;  // number of the card's inputs, once read
  bool last_is_end_ = false;
  bool broken_ = false;
};

}  // namespace trammel::driver
