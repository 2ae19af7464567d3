#include "trammel/transport/served_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"

namespace trammel::transport {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWorldHelloTime = 5s;
constexpr std::size_t kLongestAnswer = 64 * 1024;  // bytes: some hundred times the answer of the default world

bool begins_with(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

// Text from another program, made safe for a terminal.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::unique_ptr<ByteStream> stream_to(const CardUrl& url) {
  if (url.kind == CardUrl::Kind::kTcp && url.hello) return connect_tcp(url.host, url.port, 5s);
  throw driver::ArgumentError(
      fmt::format("{}: no machine is simulated behind this card: the URL is one of `trammel serve --world`, as "
                  "tcp://127.0.0.1:7000",
                  url.text));
}

}  // namespace

ServedWorld::ServedWorld(const CardUrl& url) : ServedWorld(stream_to(url), url.token) {}

ServedWorld::ServedWorld(std::unique_ptr<ByteStream> stream, const std::string& token) : stream_(std::move(stream)) {
  say_hello(token);
}

void ServedWorld::say_hello(const std::string& token) {
  const std::string hello = fmt::format("trammel 1 at world{}{}\n", token.empty() ? "" : " ", token);
  stream_->write(reinterpret_cast<const std::uint8_t*>(hello.data()), hello.size());
  const std::string peer = stream_->peer();
  const std::string line = read_answer(kWorldHelloTime, "no answer");
  if (line == "trammel 1 world") return;
  constexpr const char* kRefused = "trammel 1 refused: ";
  throw driver::LinkError(begins_with(line, kRefused)
                              ? fmt::format("{}: refused: {}", peer, line.substr(std::string(kRefused).size()))
                              : fmt::format("{}: what answers is no `trammel serve` of this version", peer));
}

// Reads up to the end of the line. `if_late` begins the error if none comes within `longest`.
std::string ServedWorld::read_answer(std::chrono::milliseconds longest, const std::string& if_late) {
  const auto until = steady_clock::now() + longest;
  // If this call ends without a line, the next line would answer the wrong request; so the stream is then dropped.
  std::unique_ptr<ByteStream> stream = std::move(stream_);
  while (came_.find('\n') == std::string::npos) {
    if (driver::interrupted()) throw driver::InterruptedError("interrupted while the machine was asked");
    const std::chrono::nanoseconds left = until - steady_clock::now();
    if (left.count() <= 0) {
      throw driver::LinkError(
          fmt::format("{}: {} within {:g} s", stream->peer(), if_late, std::chrono::duration<double>(longest).count()));
    }
    std::uint8_t bytes[1024];
    const std::size_t count =
        stream->read(bytes, sizeof(bytes), std::min<std::chrono::nanoseconds>(left, driver::kInterruptSlice));
    came_.append(reinterpret_cast<const char*>(bytes), count);
    if (came_.size() > kLongestAnswer) throw driver::LinkError(stream->peer() + ": what answers is no `trammel serve`");
  }
  const std::size_t end = came_.find('\n');
  std::string line = printable(came_.substr(0, end));
  came_.erase(0, end + 1);
  stream_ = std::move(stream);
  return line;
}

std::string ServedWorld::request(const std::string& text, std::chrono::milliseconds longest) {
  if (std::any_of(text.begin(), text.end(), [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; })) {
    throw driver::ArgumentError("a request is one line of text");
  }
  if (!stream_) throw driver::LinkError("the connection to the machine is lost");
  const std::string line = text + "\n";
  stream_->write(reinterpret_cast<const std::uint8_t*>(line.data()), line.size());
  // While a condition is not met, the server does not answer.
  const auto when = text.find(" when ");
  const std::string if_late = when == std::string::npos ? "no answer"
                                                        : fmt::format("nothing was done, because {} did not come",
                                                                      printable(text.substr(when + 6)));
  const std::string answer = read_answer(longest, if_late);
  if (begins_with(answer, "ok ")) return answer.substr(3);
  throw driver::ArgumentError(begins_with(answer, "no: ") ? answer.substr(4) : answer);
}

}  // namespace trammel::transport
