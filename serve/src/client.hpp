// One client: its hello, what it sends, when of the card's time that arrives, and when its answers leave.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
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

class CardServer::Client {
 public:
  // `left`: called when one who could move the card has gone, and another one has the stream. `held_by`: who has left
  // the card in a hold, if anybody has; the hello says it.
  Client(std::unique_ptr<transport::ByteStream> stream, sim::Engine& engine, frames::Endpoint& endpoint,
         const Settings& settings, std::function<void()> left, const std::string& held_by);

  // Reads what has come, waiting for at most `longest`; makes what is due at the card's time; sends what is due.
  // Throws driver::LinkError when the client has gone, Unwanted when it cannot stay.
  void serve(std::chrono::nanoseconds longest);

  // Clocks until something is due; none when it is the client's turn.
  std::optional<std::uint64_t> clocks_to_next() const;

  bool may_move() const { return may_move_; }
  // Lets time pass by itself; only then the card's time waits for it.
  bool waits_by_itself() const { return hello_; }
  std::string peer() const { return stream_->peer(); }
  std::uint64_t requests() const { return requests_; }
  std::unique_ptr<transport::ByteStream> take_stream() { return std::move(stream_); }

 private:
  struct Answer {
    frames::Bytes bytes;
    std::uint64_t cycle;  // leaves when this has come
  };

  void read(std::chrono::nanoseconds longest);
  void check_silence() const;
  bool take_byte(std::uint8_t byte);
  void begin_anew();
  void begin();
  void take_hello(const std::string& line);
  void take_wait(const std::string& text);
  void drop(std::size_t bytes);
  bool deliver(std::uint8_t byte);
  void send_due();
  void answer(frames::Bytes bytes, std::uint64_t cycle) { answers_.push_back({std::move(bytes), cycle}); }

  std::unique_ptr<transport::ByteStream> stream_;
  sim::Engine& engine_;
  frames::Endpoint& endpoint_;
  const Settings& settings_;
  std::function<void()> left_;
  const std::string& held_by_;
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
};

}  // namespace trammel::serve
