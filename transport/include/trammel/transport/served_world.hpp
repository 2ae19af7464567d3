// The machine behind a card of `trammel serve --world`, beside the program that moves the card: what it is like, and
// its buttons. docs/user/world.md has the requests and the state's members. One object, one thread at a time; objects
// of several threads and processes may ask one server at once.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/card_url.hpp"

namespace trammel::transport {

class ServedWorld {
 public:
  // Connects. Throws driver::ArgumentError where `url` is no server's (a real card has no such machine), and
  // driver::LinkError where the server cannot be reached, has no world, or knows another token. Without a token nothing
  // can be pressed.
  explicit ServedWorld(const CardUrl& url);
  // The same over a stream that is there.
  ServedWorld(std::unique_ptr<ByteStream> stream, const std::string& token);

  // Makes a request and gives the state behind it, a line of JSON: "state"; "press NAME" and "release NAME", whose
  // answer comes 20 ms of the card's time later; each may have a condition behind it, "when X > 40". Throws
  // driver::ArgumentError, with the server's words, for what it refuses; driver::LinkError where no answer has come in
  // `longest` of real time, and where the server has gone; driver::InterruptedError by an InterruptScope. After these
  // two the object is of no use, and a request whose condition has not come is forgotten.
  std::string request(const std::string& text, std::chrono::milliseconds longest = std::chrono::seconds(10));

 private:
  std::string read_answer(std::chrono::milliseconds longest);
  void say_hello(const std::string& token);

  std::unique_ptr<ByteStream> stream_;  // nullptr: lost
  std::string came_;
};

}  // namespace trammel::transport
