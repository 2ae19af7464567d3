// One client: its hello, its bytes, the card time at which they arrive, and the card time at which its answers leave.
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

// Thrown for a client that must be disconnected; what() is the reason, for the client and for the operator.
class Unwanted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Thrown for a client that asks for the machine, not for the card.
struct GoesToWorld {
  bool may_press;
  std::string came;  // bytes after its hello
};

// One further client may be connected and not started, so that the client that moves the card finds a place.
constexpr std::size_t kMaxReaders = 8;

class CardServer::Client {
 public:
  // `server` must outlive it.
  Client(std::unique_ptr<transport::ByteStream> stream, CardServer& server);

  // Reads received bytes, waiting for at most `longest`; executes requests that are due in card time; sends answers
  // that are due. Throws driver::LinkError when the client has left, Unwanted when it must be disconnected or has lost
  // its place.
  void serve(std::chrono::nanoseconds longest);

  // Clocks until something is due; nullopt if the server waits for the client.
  std::optional<std::uint64_t> clocks_to_next() const;

  bool may_move() const { return may_move_; }
  // For the client that may move the card: its watchdog has expired, and it is still silent.
  bool counts_as_dead() const;
  // Removes its right to move the card, and makes the card hold. Its next serve() ends it.
  void lose_place(const std::string& why);
  bool reads() const { return begun_ && !may_move_; }
  // Whether the client says how long it waits; only then does the card's time wait for it.
  bool waits_by_itself() const { return hello_; }
  std::string peer() const { return stream_->peer(); }
  std::uint64_t requests() const { return requests_; }
  std::uint64_t dropped() const { return server_.motion_.dropped() + reading_.dropped(); }  // frames, both endpoints
  const frames::Session& reading_session() const { return reading_.session(); }
  std::unique_ptr<transport::ByteStream> take_stream() { return std::move(stream_); }

 private:
  struct Answer {
    frames::Bytes bytes;
    std::uint64_t cycle;                         // clock at which it leaves
    std::chrono::steady_clock::time_point life;  // the same in real time
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
  double clocks_of_byte_;                        // clocks per byte on the line
  std::chrono::steady_clock::time_point heard_;  // time of the last bytes; before the start: of the connection
  std::deque<std::uint8_t> came_;                // received, not yet at the card
  std::deque<Answer> answers_;
  double line_in_ = 0;            // clock from which the line to the card is free
  double line_out_ = 0;           // clock from which the line back is free
  std::string text_;              // partial hello or wait
  bool between_frames_ = true;    // the last byte was an end
  std::uint64_t since_good_ = 0;  // bytes since the last valid frame or wait
  std::uint64_t requests_ = 0;
  bool spoken_ = false;  // its first byte was a legal one
  bool begun_ = false;   // has sent a hello or a valid frame
  bool hello_ = false;
  bool may_move_ = false;
  std::string displaced_;  // why it lost its place; empty if it has not
};

}  // namespace trammel::serve
