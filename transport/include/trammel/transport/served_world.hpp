// The machine behind a card of `trammel serve --world`, for programs beside the one that moves the card: its state and
// its buttons. docs/user/world.md lists the requests and the members of the state. One thread at a time uses an object;
// objects of several threads and processes may use one server at once.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/card_url.hpp"

namespace trammel::transport {

class ServedWorld {
 public:
  // Connects. Throws driver::ArgumentError if `url` is not that of a server (a real card has no such machine), and
  // driver::LinkError if the server cannot be reached, has no world, or has another token. Without a token, presses are
  // refused.
  explicit ServedWorld(const CardUrl& url);
  // The same over an existing stream.
  ServedWorld(std::unique_ptr<ByteStream> stream, const std::string& token);

  // Makes a request and returns the resulting state, a line of JSON. Requests: "state"; "press NAME" and "release
  // NAME", whose answer comes 20 ms of card time later; each may be followed by a condition, "when X > 40".
  //
  // Throws driver::ArgumentError, with the server's text, if the server refuses; driver::LinkError if no answer came
  // within `longest` of real time, or the server is gone; driver::InterruptedError by an InterruptScope. After the last
  // two the object is unusable, and a request whose condition was not met is dropped.
  std::string request(const std::string& text, std::chrono::milliseconds longest = std::chrono::seconds(10));

 private:
  std::string read_answer(std::chrono::milliseconds longest, const std::string& if_late);
  void say_hello(const std::string& token);

  std::unique_ptr<ByteStream> stream_;  // nullptr: lost
  std::string came_;
};

}  // namespace trammel::transport
