// The card's stream of commands: numbers them, waits for room, writes them whole.
//
// The card parts the stream into a geometry and a feed queue. A command waits here until the queue, or both queues,
// that it goes into have room for all of it. Geometry and feed must therefore come in an order in which the card can
// use up its queued commands while the next one waits: the commands that fill one queue must find their counterpart in
// the other. The planner sends them in such an order; another order ends in a TimeoutError, not in a deadlock.
//
// Nothing is allocated for a command: words wait in a buffer of fixed size until it is full, until there is no room
// known for the next command, or until flush().
//
// Thread-safety: as of the card: a hold or an abort from another thread goes by Card::request_hold() and
// Card::request_abort(), which put(), flush(), send() and finish() look at whenever they wait.
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
  std::uint64_t commands_sent = 0;   // since the stream was opened or restarted
  Status status;                     // of the card
  std::uint32_t geometry_begun = 0;  // of these, commands begun from the geometry queue: paths and barriers
  std::uint32_t feed_begun = 0;      // and from the feed queue: pieces and barriers
};

enum class ProbeOutcome : std::uint8_t {
  kTripped,         // the edge came on the way
  kTrippedAlready,  // the input had the level before the first path began: nothing moved
  kMissed,          // the paths ended without it
};
struct ProbeResult {
  ProbeOutcome outcome = ProbeOutcome::kMissed;
  Snapshot edge;  // of the clock after the edge showed at the card's synchronised input; zeros when missed
  Snapshot rest;  // where the card stands now
};

struct StreamOptions {
  // Pause between two looks at the card, card clocks; 0: poll_interval(). Where the bus has interrupts the stream
  // waits for the end, and where the card has watermarks for room in its queues, without looking so often.
  std::uint64_t poll_clocks = 0;
  // How much longer than planned (in card time) the card may be with what it has begun before it counts as hung. What
  // was planned is known from the commands: dwells, and pieces at the ratio of their class; holds do not count.
  std::chrono::nanoseconds margin = std::chrono::seconds(1);
  // Called at each look while the stream waits. May throw: the exception passes through, the stream stays usable.
  std::function<void(const StreamProgress&)> progress;
  // Waits out a hold that stands when the stream is opened, like one that comes later.
  bool opens_in_hold = false;
};

class Stream final : public CommandSink {
 public:
  // Opens the card's stream: numbers begin at 0, the queues are empty, no refusal is latched. Throws HeldError if the
  // card stands in a hold that this program has not set, StateError if it is busy, FaultError if it is faulted,
  // ArgumentError for a margin that is not positive. `card` must outlive the stream.
  explicit Stream(Card& card, StreamOptions options = {});

  // Takes a command to send, whole or not at all; it is written now or later. Throws ArgumentError when it does not fit
  // its layout or what the card has (axes, engines), and for a feed piece whose jerk would reverse the feed before its
  // end: it is not taken then, and those before it stay as they were.
  //
  // When it has to write or to wait for room: LinkError, FaultError; TimeoutError when the card is overdue;
  // RefusedError when it refuses a command, with the reason and the command's number (a refusal may show only at a
  // later call, and any refused access to the card counts); StateError when it has not begun what it was sent: it was
  // reset, or aborted by somebody else. After a RefusedError, a LinkError or a StateError the stream is closed, and
  // what it kept back is dropped: all calls throw StateError until restart().
  void put(const Command& command) override;

  // Writes what put() has kept back. Errors as in put().
  void flush();

  // put() and flush(). Of several, every one is checked before the first access to the bus.
  void send(const Command& command);
  void send(const std::vector<Command>& commands);

  // Flushes and waits until all is done: the card is idle, has begun every command, and, if the last command was End,
  // has ended. Returns the status. Errors as in put().
  Status finish();

  // Moves along `paths` (paths and the pieces of their time, and what else stands between them) until the condition's
  // input has its level. From there the card ramps to rest along the path and drops the rest of them. Waits until
  // everything before is done, and until the card stands; the stream goes on from there. On cards with path commands.
  // Throws ArgumentError, before anything moves, for an input that the card lacks, no paths, or a PROBE, a PROBE_END or
  // an END among them; else as finish(). A StateError if another program ended the probe.
  ProbeResult probe(const ProbeCommand& condition, const std::vector<Command>& paths);

  // Drops the queued commands, stops the path and begins anew at number 0. Throws FaultError if it is faulted.
  void restart();

  // Number that the next command gets.
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
  // Commands of one queue: how many were put, written, and begun as the card said last.
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
  std::vector<Access> accesses_;     // kept back: the first used_; of fixed size
  std::vector<Duration> durations_;  // of the commands of the feed queue that may be under way, by number; a ring
  std::size_t used_ = 0;
  std::size_t kept_ = 0;  // commands
  Need room_;             // known to be free: never more than the card has
  std::uint64_t sent_ = 0;
  Count geometry_;
  Count feed_;
  std::optional<unsigned> inputs_;  // of the card, once it was asked
  bool last_is_end_ = false;
  bool broken_ = false;
};

}  // namespace trammel::driver
