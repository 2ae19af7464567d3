// A Bus over a stream of bytes. Every request has a number and runs once, whatever the link does to it: a frame that
// was damaged or lost is sent again, and a connection that broke is made anew.
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
    // How long the card may take beside the bytes' own time: 600 clocks per access, and what the operating system adds.
    std::chrono::nanoseconds answer = std::chrono::milliseconds(50);
    unsigned sends = 4;     // of a request, before the connection is made anew
    unsigned restarts = 3;  // of the connection, before transfer() gives up
    // The constructor sends once, on one connection: for a link that loses nothing, on which a device that does not
    // answer is no card.
    bool opens_at_once = false;
  };

  // Counts of what the link did.
  struct Counts {
    std::uint64_t requests = 0;
    std::uint64_t sent_again = 0;
    std::uint64_t restarts = 0;
    std::uint64_t strange = 0;  // whole replies to something else: late, or repeated
  };

  // `link` must outlive it. Connects; throws LinkError when no card answers.
  explicit FrameBus(ByteLink& link) : FrameBus(link, Options()) {}
  FrameBus(ByteLink& link, const Options& options);

  std::size_t transfer(Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override { link_.sleep(time); }
  bool reports_refusals() const override { return true; }
  std::string hold_origin() const override { return link_.hold_origin(); }

  // After transfer() has thrown a LinkError: connects again, and says how many of its accesses were made; the data of
  // reads among them are lost. Throws LinkError when the card does not answer, or was reset or used by another program
  // meanwhile: then nothing is known, and the next transfer() begins anew.
  std::size_t resume();

  // Where an answer may take longer than this (Options::answer), a transfer gives up when none has come for so long and
  // one further request has none, either: what the card was doing has ended by then, by its watchdog. Those behind it
  // ask once and shortly, until one is answered. 0, as in the beginning: a transfer waits as Options say.
  void set_patience(std::chrono::nanoseconds patience) { patience_ = patience; }
  // Whether the last transfer had no answer.
  bool lost() const { return lost_; }

  // What the last reply said of the card.
  const frames::CardState& state() const { return state_; }
  const Counts& counts() const { return counts_; }

 private:
  // How often and for how long a request is tried.
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
  Tries tries_{};  // of the request or connection under way
  bool lost_ = false;
  frames::Deframer deframer_{frames::kMaxReplyBody};
  frames::CardState state_;
  Counts counts_;
  std::uint16_t epoch_ = 0;
  std::uint16_t number_ = 0;             // executed last, as far as replies have said
  std::uint16_t card_last_ = 0;          // executed last, as the card said when it was connected last
  bool went_back_ = false;               // the card's epoch, since this side has begun anew
  std::uint16_t tag_ = 0;                // of requests without a number
  std::size_t made_ = 0;                 // accesses of the transfer that replies have said were made
  std::optional<frames::Request> open_;  // sent, and not known to have run or not
};

}  // namespace trammel::driver
