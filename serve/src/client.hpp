// One client: its hello, what it sends, when of the card's time that arrives, and when its answers leave.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "trammel/frames/endpoint.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/byte_stream.hpp"

namespace trammel::serve {

// A client that cannot stay; what() is why, for it and for the operator.
class Unwanted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A client that wants to look at the machine, not at the card.
struct GoesToWorld {
  bool may_press;
  std::string came;  // behind its hello
};

// One more may have come and not begun yet; so who moves the card finds a place.
constexpr std::size_t kMaxReaders = 8;

class CardServer::Client {
 public:
  // `server` must outlive it.
  Client(std::unique_ptr<transport::ByteStream> stream, CardServer& server);

  // Reads what has come, waiting for at most `longest`; makes what is due at the card's time; sends what is due.
  // Throws driver::LinkError when the client has gone, Unwanted when it cannot stay, or has lost its place.
  void serve(std::chrono::nanoseconds longest);

  // Clocks until something is due; none when it is the client's turn.
  std::optional<std::uint64_t> clocks_to_next() const;

  bool may_move() const { return may_move_; }
  // Of the one that may move the card: it has let its watchdog expire, and is silent still.
  bool counts_as_dead() const;
  // Its right to move the card goes; the card holds. Its next turn ends it.
  void lose_place(const std::string& why);
  bool reads() const { return begun_ && !may_move_; }
  // Lets time pass by itself; only then the card's time waits for it.
  bool waits_by_itself() const { return hello_; }
  std::string peer() const { return stream_->peer(); }
  std::uint64_t requests() const { return requests_; }
  std::uint64_t dropped() const { return server_.motion_.dropped() + reading_.dropped(); }  // frames, of both
  const frames::Session& reading_session() const { return reading_.session(); }
  std::unique_ptr<transport::ByteStream> take_stream() { return std::move(stream_); }

 private:
  struct Answer {
    frames::Bytes bytes;
    std::uint64_t cycle;                         // leaves when this has come
    std::chrono::steady_clock::time_point life;  // when that would be in real time
  };

  void read(std::chrono::nanoseconds longest);
  void check_silence() const;
  bool take_byte(std::uint8_t byte);
  void begin_anew();
  void begin();
  void take_hello(const std::string& line);
  [[noreturn]] void go_to_world(const std::string& line);
  void take_wait(const std::string& text);
  void drop(std::size_t bytes);
  bool deliver(std::uint8_t byte);
  void send_due();
  void answer(frames::Bytes bytes, std::uint64_t cycle);
  frames::Endpoint& endpoint() { return may_move_ ? server_.motion_ : reading_; }
  bool has_no_say_in_time() const;

  std::unique_ptr<transport::ByteStream> stream_;
  CardServer& server_;
  sim::Engine& engine_;
  const Settings& settings_;
  frames::Endpoint reading_;
  double clocks_of_byte_;                        // on the line, in card time
  std::chrono::steady_clock::time_point heard_;  // something; before it has begun: when it came
  std::deque<std::uint8_t> came_;                // not yet at the card
  std::deque<Answer> answers_;
  double line_in_ = 0;  // clock from which on the line is free, to the card and back
  double line_out_ = 0;
  std::string text_;              // of a hello or a wait, as far as it has come
  bool between_frames_ = true;    // the last byte was an end
  std::uint64_t since_good_ = 0;  // bytes
  std::uint64_t requests_ = 0;
  bool spoken_ = false;  // began as a client may
  bool begun_ = false;   // said hello, or sent a frame that was one
  bool hello_ = false;
  bool may_move_ = false;
  std::string displaced_;  // why it has lost its place; empty where it has not
};

}  // namespace trammel::serve
