// A Bus over a stream of bytes. Every request has a number and runs exactly once, whatever happens on the link: the bus
// repeats damaged and lost frames, and restores broken connections.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "trammel/driver/bus.hpp"
#include "trammel/driver/byte_link.hpp"
#include "trammel/frames/frame.hpp"

namespace trammel::driver {

class FrameBus final : public Bus {
 public:
  struct Options {
    // Time that the card may take to answer, in addition to the transmission of the bytes: 600 clocks per access, plus
    // the delay of the operating system.
    std::chrono::nanoseconds answer = std::chrono::milliseconds(50);
    unsigned sends = 4;     // transmissions of a request before the connection is restarted
    unsigned restarts = 3;  // restarts of the connection before transfer() gives up
    // The constructor sends one request on one connection. For a link that loses nothing, on which a device that does
    // not answer is not a card.
    bool opens_at_once = false;
  };

  // Statistics of the link.
  struct Counts {
    std::uint64_t requests = 0;
    std::uint64_t sent_again = 0;
    std::uint64_t restarts = 0;
    std::uint64_t strange = 0;  // valid replies to other requests: late or repeated
  };

  // Connects; throws LinkError when no card answers. `link` must outlive the object.
  explicit FrameBus(ByteLink& link) : FrameBus(link, Options()) {}
  FrameBus(ByteLink& link, const Options& options);

  std::size_t transfer(Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override { link_.sleep(time); }
  bool reports_refusals() const override { return true; }
  std::string hold_origin() const override { return link_.hold_origin(); }

  // Call it after transfer() has thrown a LinkError: connects again, and returns the number of accesses of that
  // transfer that were made. The data of its reads are lost. Throws LinkError when the card does not answer, or was
  // reset or used by another program meanwhile. The number is then unknown, and the next transfer() starts a new
  // connection.
  std::size_t resume();

  // Limits the wait for an answer if Options::answer is longer than `patience`. A transfer then gives up when it had no
  // answer for `patience` and one further request had none either; the card's watchdog has stopped the card by then.
  // The following transfers ask once, with a short wait, until one is answered. 0 (the default): a transfer waits as
  // Options say.
  void set_patience(std::chrono::nanoseconds patience) { patience_ = patience; }
  // Whether the last transfer got no answer.
  bool lost() const { return lost_; }

  // The state of the card as reported by the last reply.
  const frames::CardState& state() const { return state_; }
  const Counts& counts() const { return counts_; }

 private:
  // Repetitions of a request and the wait for each answer.
  struct Tries {
    std::chrono::nanoseconds answer;
    unsigned sends;
    unsigned restarts;
  };

  bool is_impatient() const { return patience_.count() != 0 && patience_ < options_.answer; }
  Tries tries() const;
  frames::Request request_for(const Access* accesses, std::size_t count) const;
  frames::Reply exchange(frames::Request request);
  std::optional<frames::Reply> send_and_wait(const frames::Request& request);
  std::optional<frames::Reply> wait_for(const frames::Request& request, std::size_t bytes);
  std::optional<frames::Reply> try_open();
  void connect_again(std::chrono::nanoseconds begun);
  bool connect();
  void reconnect();
  void begin_anew();
  bool known() const;

  ByteLink& link_;
  Options options_;
  std::chrono::nanoseconds patience_{0};
  Tries tries_{};  // limits of the request or connection under way
  bool lost_ = false;
  frames::Deframer deframer_{frames::kMaxReplyBody};
  frames::CardState state_;
  Counts counts_;
  std::uint16_t epoch_ = 0;
  std::uint16_t number_ = 0;             // last executed request, as far as replies have shown
  std::uint16_t card_last_ = 0;          // last executed request, as the card said at connection
  bool went_back_ = false;               // the card's epoch has decreased since begin_anew()
  std::uint16_t tag_ = 0;                // number of the last request outside the sequence
  std::size_t made_ = 0;                 // accesses of the transfer reported as made
  std::optional<frames::Request> open_;  // sent request that may or may not have run
};

}  // namespace trammel::driver
