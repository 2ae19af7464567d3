#include "client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"

namespace trammel::serve {
namespace {

using std::chrono::steady_clock;

constexpr std::uint8_t kMeasured = 0x55;  // first byte on a serial line
constexpr char kHello[] = "trammel 1";
constexpr char kToWorld[] = "trammel 1 at world";  // no token contains spaces
constexpr std::uint64_t kMaxRubbish = 64 * 1024;   // bytes without a valid frame
constexpr char kWait[] = "wait ";
constexpr std::size_t kLongestText = 100;
constexpr auto kSilentStill = std::chrono::seconds(1);  // a live program has written by then

frames::Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

// Compares tokens in constant time.
bool same(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |=
        static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(i < b.size() ? b[i] : 0));
  }
  return difference == 0;
}

}  // namespace

CardServer::Client::Client(std::unique_ptr<transport::ByteStream> stream, CardServer& server)
    : stream_(std::move(stream)),
      server_(server),
      engine_(server.engine_),
      settings_(server.settings_),
      reading_([&server](bool write, std::uint32_t address,
                         std::uint32_t data) { return server.make_reading(write, address, data); },
               std::exchange(server.reading_session_, frames::Session())),
      clocks_of_byte_(settings_.baud == 0 ? 0 : 10.0 * settings_.clock_hz / settings_.baud),
      heard_(steady_clock::now()) {
  reading_.connect();
}

void CardServer::Client::serve(std::chrono::nanoseconds longest) {
  if (!displaced_.empty()) throw Unwanted(displaced_);
  read(longest);
  while (!came_.empty() && take_byte(came_.front())) came_.pop_front();
  send_due();
}

// Reads all received bytes, so that a closed connection is seen at once: requests that had not reached the card by then
// do not run.
void CardServer::Client::read(std::chrono::nanoseconds longest) {
  std::uint8_t bytes[4096];
  const auto before = static_cast<std::ptrdiff_t>(came_.size());
  while (const std::size_t count = stream_->read(bytes, sizeof(bytes), longest)) {
    came_.insert(came_.end(), bytes, bytes + count);
    if (begun_) heard_ = steady_clock::now();
    longest = std::chrono::nanoseconds(0);
    if (came_.size() > kMaxRubbish) throw Unwanted("more bytes than the line carries: a request waits for its reply");
  }
  if (stream_->changed_hands()) {
    // The new bytes come from the next client or from both; they get neither client's rights.
    came_.erase(came_.begin(), came_.begin() + before);
    text_.clear();
    between_frames_ = true;
    endpoint().connect();
    begin_anew();
  }
  check_silence();
}

// Single bytes do not extend the time of a client that has not started.
void CardServer::Client::check_silence() const {
  const auto most = begun_ ? settings_.silence : settings_.hello;
  if (most.count() == 0 || !answers_.empty() || !came_.empty() || steady_clock::now() - heard_ < most) return;
  throw Unwanted(fmt::format("{} {:.1f} s", begun_ ? "nothing came for" : "neither a hello nor a request in",
                             std::chrono::duration<double>(most).count()));
}

// Between frames, a hello may begin, and a wait too after a hello; no frame starts with their first letters. Both take
// no time on the line. Returns false if the byte is not due yet.
bool CardServer::Client::take_byte(std::uint8_t byte) {
  if (text_.empty()) {
    const bool line_begins = byte == kMeasured;
    const bool hello = byte == kHello[0];
    const bool wait = hello_ && byte == kWait[0];
    if (between_frames_ && (line_begins || hello)) begin_anew();
    if (!spoken_ && !line_begins && !hello && byte != frames::kEnd) throw Unwanted("neither a hello nor a frame");
    spoken_ = true;
    if (!between_frames_ || !(hello || wait)) return deliver(byte);
  }
  const bool hello = text_.empty() ? byte == kHello[0] : text_[0] == kHello[0];
  if (byte == (hello ? '\n' : frames::kEnd)) {
    const std::string text = std::exchange(text_, {});
    hello ? take_hello(text) : take_wait(text);
    return true;
  }
  text_ += static_cast<char>(byte);
  if (text_.size() <= kLongestText) return true;
  if (hello) throw Unwanted("no hello of this version");
  // Not a wait: drops bytes up to the next end.
  drop(text_.size());
  text_.clear();
  between_frames_ = false;
  return true;
}

// On a terminal a client may be replaced by another one without notice.
void CardServer::Client::begin_anew() {
  if (may_move_) server_.hold(peer() + ": another one has its place");
  hello_ = false;
  may_move_ = false;
}

// The connection of a host that is cut off or halted does not end; an expired watchdog shows that state. A watchdog
// fault left by an earlier program says nothing about a client that still sends.
bool CardServer::Client::counts_as_dead() const {
  const bool expired = (engine_.read(card_map::reg::kFault) & card_map::field::kFaultWatchdog) != 0;
  return expired && steady_clock::now() - heard_ > kSilentStill;
}

void CardServer::Client::lose_place(const std::string& why) {
  displaced_ = why;
  server_.hold(peer() + ": " + why);
  may_move_ = false;
}

void CardServer::Client::begin() {
  if (!begun_) heard_ = steady_clock::now();
  begun_ = true;
  if (!may_move_ && server_.readers() > kMaxReaders) throw Unwanted("as many clients read as the server takes");
}

// `line`: "trammel 1 at world", or the same followed by a space and the token.
void CardServer::Client::go_to_world(const std::string& line) {
  const std::string token = line.substr(std::min(line.size(), sizeof(kToWorld)));
  if (!token.empty() && !same(token, settings_.token)) {
    throw Unwanted("wrong token: take the one that the server has printed");
  }
  came_.pop_front();  // newline
  throw GoesToWorld{!token.empty(), std::string(came_.begin(), came_.end())};
}

void CardServer::Client::take_hello(const std::string& line) {
  if (line == kToWorld || line.rfind(std::string(kToWorld) + " ", 0) == 0) go_to_world(line);
  const bool plain = line == kHello;
  const bool with_token = line.rfind(std::string(kHello) + " ", 0) == 0;
  if (!plain && !with_token) throw Unwanted("no hello of this version");
  if (with_token && !same(line.substr(sizeof(kHello)), settings_.token)) {
    throw Unwanted("wrong token: take the one that the server has printed");
  }
  Client* const mover = server_.mover();
  if (with_token && mover != nullptr && mover != this) {
    if (!mover->counts_as_dead()) throw Unwanted("another client moves the card: one at a time");
    mover->lose_place("its watchdog had expired, and another client has its place");
  }
  hello_ = true;
  may_move_ = with_token;
  begin();
  if (may_move_) server_.motion_.connect();  // drops a partial frame of its predecessor
  const std::string& held_by = server_.held_by_;
  const std::string held = held_by.empty() ? "" : " held: " + held_by.substr(0, kLongestText);
  answer(bytes_of(fmt::format("trammel 1 {}{}\n", may_move_ ? "motion" : "reading", held)), engine_.cycles());
}

bool CardServer::Client::deliver(std::uint8_t byte) {
  const auto now = static_cast<double>(engine_.cycles());
  if (line_in_ > now && !has_no_say_in_time()) return false;
  // If the line became free in this clock, the next byte follows without a gap.
  if (now - line_in_ >= 1) line_in_ = now;
  line_in_ += clocks_of_byte_;
  between_frames_ = byte == frames::kEnd;
  frames::Bytes reply;
  endpoint().take(byte, reply);
  drop(1);
  if (reply.empty()) return true;
  since_good_ = 0;
  begin();
  ++requests_;
  line_out_ = std::max(line_out_, std::max(line_in_, static_cast<double>(engine_.cycles()))) +
              clocks_of_byte_ * static_cast<double>(reply.size());
  answer(std::move(reply), static_cast<std::uint64_t>(std::ceil(line_out_)));
  return true;
}

// The answer repeats time and number, so that the client sees how its wait was understood. A damaged wait is dropped,
// as a damaged frame is.
void CardServer::Client::take_wait(const std::string& text) {
  constexpr std::int64_t kMax = 1'000'000'000;  // ns
  const char* const end = text.data() + text.size();
  std::int64_t time = -1;
  std::uint32_t number = 0;
  const bool named = text.rfind(kWait, 0) == 0;
  const auto first = std::from_chars(named ? text.data() + sizeof(kWait) - 1 : end, end, time);
  const bool spaced = first.ptr != end && *first.ptr == ' ';
  const auto second = std::from_chars(spaced ? first.ptr + 1 : end, end, number);
  if (second.ec != std::errc{} || second.ptr != end || time < 0 || time > kMax) return drop(text.size());
  since_good_ = 0;
  frames::Bytes waited = bytes_of(fmt::format("waited {} {}", time, number));
  waited.push_back(frames::kEnd);
  answer(std::move(waited),
         engine_.cycles() + driver::clocks_of(std::chrono::nanoseconds(time), settings_.clock_hz, "wait"));
}

// Counts bytes since the last complete frame or wait.
void CardServer::Client::drop(std::size_t bytes) {
  since_good_ += bytes;
  if (since_good_ > kMaxRubbish) throw Unwanted(fmt::format("no frame in {} bytes", kMaxRubbish));
}

void CardServer::Client::answer(frames::Bytes bytes, std::uint64_t cycle) {
  const std::uint64_t now = engine_.cycles();
  const double seconds = static_cast<double>(cycle > now ? cycle - now : 0) / settings_.clock_hz;
  const auto life = std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(seconds));
  answers_.push_back({std::move(bytes), cycle, steady_clock::now() + life});
}

// Only the client that moves the card decides when the card's time advances. While that time does not advance, a
// reader's answers are timed by the host's clock.
bool CardServer::Client::has_no_say_in_time() const {
  return !settings_.real_time && !may_move_ && server_.mover() != nullptr;
}

void CardServer::Client::send_due() {
  const auto is_due = [this](const Answer& answer) {
    return answer.cycle <= engine_.cycles() || (has_no_say_in_time() && answer.life <= steady_clock::now());
  };
  while (!answers_.empty() && is_due(answers_.front())) {
    stream_->write(answers_.front().bytes.data(), answers_.front().bytes.size());
    answers_.pop_front();
  }
}

std::optional<std::uint64_t> CardServer::Client::clocks_to_next() const {
  const std::uint64_t now = engine_.cycles();
  std::optional<std::uint64_t> next;
  const auto look = [&](std::uint64_t cycle) {
    const std::uint64_t clocks = cycle > now ? cycle - now : 0;
    next = std::min(next.value_or(clocks), clocks);
  };
  if (!answers_.empty()) look(answers_.front().cycle);
  if (!came_.empty()) look(static_cast<std::uint64_t>(std::ceil(line_in_)));
  return next;
}

}  // namespace trammel::serve
