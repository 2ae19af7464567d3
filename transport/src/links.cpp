#include "trammel/transport/links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <thread>
#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/frames/stuffing.hpp"

namespace trammel::transport {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr nanoseconds kHelloTime = 5s;
constexpr nanoseconds kLastHelloTime = 300ms;  // for a server that was silent before, if there is a patience
constexpr nanoseconds kLongestWait = 20ms;     // longest single wait; longer ones are split
constexpr std::size_t kLongestLine = 200;
constexpr nanoseconds kDrainTime = 200ms;
constexpr const char* kHeld = " held: ";
constexpr const char* kIsItThere = "is that its port?";

// Text from another program, made safe for a terminal.
std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.empty() ? "for no reason that it gives" : text;
}
constexpr char kSerial[] = "serial line";
constexpr char kConnection[] = "connection";

void end_if_interrupted(const std::string& peer) {
  if (!driver::interrupted()) return;
  throw driver::InterruptedError(fmt::format("{}: interrupted before the connection was made", peer));
}

// Reads a byte from an unknown program.
std::size_t read_byte(ByteStream& stream, std::uint8_t& byte, nanoseconds longest) {
  try {
    return stream.read(&byte, 1, longest);
  } catch (const driver::LinkError& error) {
    throw driver::LinkError(fmt::format("{}: is `trammel serve` running there?", error.what()));
  }
}

// Reads up to the end of the line.
std::string read_line(ByteStream& stream, nanoseconds longest) {
  std::string line;
  const auto until = steady_clock::now() + longest;
  while (line.size() < kLongestLine) {
    std::uint8_t byte = 0;
    const nanoseconds left = until - steady_clock::now();
    if (left.count() <= 0) break;
    if (read_byte(stream, byte, std::min<nanoseconds>(left, driver::kInterruptSlice)) == 0) {
      end_if_interrupted(stream.peer());
      continue;
    }
    if (byte == '\n') return line;
    line += static_cast<char>(byte);
  }
  throw driver::LinkError(
      fmt::format("{}: what answers is no `trammel serve`: {}", stream.peer(),
                  line.empty() ? "it says nothing (a bridge to a serial line wants hello=no)" : kIsItThere));
}

// Makes a call on a stream. A stream is lost after a failure; a lost stream cannot be used.
template <class Stream, class Call>
auto on_stream(std::unique_ptr<Stream>& stream, const char* name, Call call) {
  if (!stream) throw driver::LinkError(fmt::format("the {} is lost", name));
  try {
    return call();
  } catch (const driver::LinkError&) {
    stream.reset();
    throw;
  }
}

}  // namespace

nanoseconds HostTimeLink::now() const { return steady_clock::now().time_since_epoch(); }
void HostTimeLink::sleep(nanoseconds time) { std::this_thread::sleep_for(time); }

void SerialLink::send(const std::uint8_t* bytes, std::size_t count) {
  on_stream(stream_, kSerial, [&] { stream_->write(bytes, count); });
}

std::size_t SerialLink::receive(std::uint8_t* bytes, std::size_t room, nanoseconds longest) {
  return on_stream(stream_, kSerial, [&] { return stream_->read(bytes, room, longest); });
}

void SerialLink::restart() {
  constexpr std::uint8_t kMeasured = 0x55;
  if (!stream_) stream_ = open_();
  on_stream(stream_, kSerial, [&] {
    stream_->send_break();
    stream_->write(&kMeasured, 1);
  });
}

// A byte has a start bit, eight data bits and a stop bit.
nanoseconds SerialLink::time_of(std::size_t bytes) const {
  return nanoseconds(static_cast<std::int64_t>(10'000'000'000 / baud_ + 1) * static_cast<std::int64_t>(bytes));
}

StreamLink::StreamLink(Open open, std::optional<Hello> hello, const Options& options)
    : open_(std::move(open)), hello_(std::move(hello)), options_(options) {
  connect();
}

void StreamLink::connect() {
  stream_ = open_();
  if (hello_) on_stream(stream_, kConnection, [this] { say_hello(); });
}

void StreamLink::say_hello() {
  // The kEnd ends a partial frame that an earlier client may have left on a terminal.
  const std::string hello = fmt::format("{}trammel 1{}{}\n", static_cast<char>(frames::kEnd),
                                        hello_->token.empty() ? "" : " ", hello_->token);
  stream_->write(reinterpret_cast<const std::uint8_t*>(hello.data()), hello.size());
  const std::string line =
      read_line(*stream_, patience_.count() != 0 && given_up_ ? kLastHelloTime : at_most(kHelloTime));
  const auto is = [&line](const std::string& answer) { return line == answer || line.rfind(answer + kHeld, 0) == 0; };
  may_move_ = is("trammel 1 motion");
  const std::size_t held = line.find(kHeld);
  hold_origin_ = held == std::string::npos ? std::string() : plain(line.substr(held + std::strlen(kHeld)));
  if (may_move_ || is("trammel 1 reading")) return;
  constexpr const char* kRefused = "trammel 1 refused: ";
  if (line.rfind(kRefused, 0) == 0) {
    throw driver::LinkError(
        fmt::format("{}: refused: {}", stream_->peer(), plain(line.substr(std::string(kRefused).size()))));
  }
  throw driver::LinkError(
      fmt::format("{}: what answers is no `trammel serve` of this version: {}", stream_->peer(), kIsItThere));
}

void StreamLink::send(const std::uint8_t* bytes, std::size_t count) {
  on_stream(stream_, kConnection, [&] { stream_->write(bytes, count); });
}

std::size_t StreamLink::receive(std::uint8_t* bytes, std::size_t room, nanoseconds longest) {
  return on_stream(stream_, kConnection, [&] { return stream_->read(bytes, room, longest); });
}

void StreamLink::restart() {
  if (stream_) {
    std::uint8_t late[256];
    const auto until = steady_clock::now() + kDrainTime;
    while (receive(late, sizeof(late), 0ns) != 0 && steady_clock::now() < until) {
    }
    return;
  }
  for (const auto until = steady_clock::now() + (std::exchange(given_up_, true) ? 0ns : options_.reopen);;) {
    try {
      connect();
      given_up_ = false;
      ++reconnections_;
      return;
    } catch (const driver::LinkError&) {
      if (steady_clock::now() >= until) throw;
    }
    end_if_interrupted(kConnection);
    std::this_thread::sleep_for(50ms);
  }
}

nanoseconds StreamLink::at_most(nanoseconds time) const {
  return patience_.count() != 0 ? std::min(patience_, time) : time;
}

nanoseconds StreamLink::now() const { return steady_clock::now().time_since_epoch(); }

void StreamLink::sleep(nanoseconds time) {
  if (!hello_ || !stream_) return std::this_thread::sleep_for(time);
  try {
    for (; time.count() > 0; time -= std::min(time, kLongestWait)) wait(std::min(time, kLongestWait));
  } catch (const driver::LinkError&) {
    // The stream is lost: the next transfer connects again, or reports it.
  }
}

void StreamLink::wait(nanoseconds time) {
  constexpr char kEnd = static_cast<char>(frames::kEnd);
  const std::string what = fmt::format("{} {}{}", time.count(), ++waits_, kEnd);
  // The first kEnd ends a partial frame or a damaged wait.
  const std::string text = fmt::format("{}wait {}", kEnd, what);
  const unsigned sends = at_most(options_.answer) < options_.answer ? 1 : options_.sends;
  for (unsigned sent = 0; sent < sends; ++sent) {
    send(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    if (answered("waited " + what) || driver::interrupted()) return;
  }
  stream_.reset();
  throw driver::LinkError("the server does not answer");
}

// Data before `text` are late replies to requests that were given up.
bool StreamLink::answered(const std::string& text) {
  const auto begun = steady_clock::now();
  const nanoseconds answer = at_most(options_.answer);
  const auto until = begun + answer;
  std::string came;
  for (auto left = answer; left.count() > 0; left = until - steady_clock::now()) {
    std::uint8_t bytes[256];
    const std::size_t count = receive(bytes, sizeof(bytes), std::min<nanoseconds>(left, driver::kInterruptSlice));
    if (count == 0 && driver::interrupted_after(steady_clock::now() - begun)) return false;
    came.append(reinterpret_cast<const char*>(bytes), count);
    if (came.find(text) != std::string::npos) return true;
    if (came.size() > text.size()) came.erase(0, came.size() - text.size());
  }
  return false;
}

}  // namespace trammel::transport
