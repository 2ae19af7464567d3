// The card's stream of commands: numbers them, waits for room, writes them whole.
//
// The card parts the stream into a geometry and a feed queue. A command waits here until the queue, or both queues,
// that it goes into have room for all of it. Geometry and feed must therefore come in an order in which the card can
// use up what it has while the next command waits: whatever fills one queue must find its counterpart in the other.
// The planner sends them so; another order ends in a TimeoutError, not in a deadlock.
//
// Thread-safety: none, as of the card.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::driver {

struct StreamProgress {
  std::uint64_t commands_sent = 0;   // since the stream was opened or restarted
  Status status;                     // of the card
  std::uint32_t geometry_begun = 0;  // of these, commands begun from the geometry queue: paths and barriers
  std::uint32_t feed_begun = 0;      // and from the feed queue: pieces and barriers
};

struct StreamOptions {
  // Pause between two looks at the card, card clocks; 0: Card::poll_interval().
  std::uint64_t poll_clocks = 0;
  // Longest time (of the card) in which nothing is begun and nothing is held back by a hold: longer than the
  // longest command takes.
  std::chrono::nanoseconds stall_timeout = std::chrono::minutes(10);
  // Called at each look while the stream waits. May throw: the exception passes through, the stream stays usable.
  std::function<void(const StreamProgress&)> progress;
};

class Stream {
 public:
  // Opens the card's stream: numbers begin at 0, the queues are empty, no refusal is latched. Throws StateError if
  // the card is busy, FaultError if it is faulted, ArgumentError for a stall timeout that is not positive.
  // `card` must outlive the stream.
  explicit Stream(Card& card, StreamOptions options = {});

  // Sends commands in order, each whole or not at all, as many in one fixed-address block write as there is room for.
  // Returns when the last is written, not when it is done. Every command is checked against its layout and against
  // what the card has (axes, engines) before the first access to the bus: ArgumentError.
  //
  // While it waits for room: FaultError, TimeoutError. When the card refuses a command: RefusedError with the reason
  // and the command's number; a refusal may show only at a later send() or in finish(), and any refused access to the
  // card counts. After a RefusedError or
  // a BusError the card ignores the stream: send() and finish() throw StateError until restart().
  void send(const Command& command);
  void send(const std::vector<Command>& commands);

  // Waits until all is done: the card is idle and, if the last command was End, has ended. Gives back the status.
  // Errors as in send().
  Status finish();

  // Drops what the card has queued, stops its path and begins anew at number 0. Throws FaultError if it is faulted.
  void restart();

  // Number that the next command gets.
  std::uint8_t next_number() const { return static_cast<std::uint8_t>(sent_); }
  // Commands written since the stream was opened or restarted.
  std::uint64_t sent() const { return sent_; }

 private:
  struct Need {  // halfwords in each queue
    std::uint32_t geometry = 0;
    std::uint32_t feed = 0;
  };
  struct Encoded {
    Need need;
    std::size_t begin = 0;  // words [begin, end) of the encoded stream
    std::size_t end = 0;
    bool is_end = false;
  };
  // State of one wait: time since the card last began something.
  struct Watch {
    std::uint64_t waited = 0;  // clocks
    std::uint32_t geometry_begun = 0;
    std::uint32_t feed_begun = 0;
    bool started = false;
  };

  void reset();
  void send(const Command* commands, std::size_t count);
  Encoded encode_checked(const Command& command, std::uint8_t number, std::vector<std::uint32_t>& words) const;
  bool has_room(const Need& need) const { return need.geometry <= room_.geometry && need.feed <= room_.feed; }
  void wait_for_room(const Need& need);
  void refresh_room(const Need& need);
  void write(const std::vector<std::uint32_t>& words, const Encoded* first, const Encoded* last);
  Status look(Watch& watch);
  void pause(Watch& watch, const char* context);
  void require_open() const;
  [[noreturn]] void throw_refused(const Refusal& refusal);

  Card* card_;
  StreamOptions options_;
  std::uint64_t stall_clocks_;
  std::uint64_t poll_clocks_;
  Need room_;  // known to be free: never more than the card has
  std::uint64_t sent_ = 0;
  bool last_is_end_ = false;
  bool broken_ = false;
};

}  // namespace trammel::driver
