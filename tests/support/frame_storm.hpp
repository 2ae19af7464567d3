// A host behind a bad link. Frames are damaged, cut, repeated, merged, reordered and lost on their way to a card;
// replies are damaged and lost on their way back. Every access of the card is judged: it must be the next access of the
// one request that may run now. Used at three places: the untimed endpoint, the frame engine and the pins of the ports.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/frames/frame.hpp"

namespace trammel::test {

class FrameStorm {
 public:
  // Delivers bytes to the card and returns its reply.
  using Card = std::function<frames::Bytes(const frames::Bytes&)>;
  // Starts a new connection without a request (a break). Empty if the card has no such event.
  using Restart = std::function<void()>;

  struct Answer {
    bool refused = false;
    std::uint32_t data = 0;
  };

  struct Counts {
    std::uint64_t frames = 0;    // frames sent to the card, whole or damaged
    std::uint64_t damaged = 0;   // damaged ones of these frames
    std::uint64_t repeated = 0;  // repeated ones of these frames, including frames of earlier connections
    std::uint64_t requests = 0;  // requests that ran
    std::uint64_t refused = 0;   // requests of these that the card refused at one of their words
    std::uint64_t connections = 0;
    std::uint64_t lost_replies = 0;
  };

  // One request in `long_one_in` has up to 59 words, the others up to 4.
  FrameStorm(std::uint64_t seed, Card card, Restart restart, std::uint32_t long_one_in = 4)
      : random_(seed), card_(std::move(card)), restart_(std::move(restart)), long_one_in_(long_one_in) {}

  // Sends at least `frames` frames, until the reply to the last request has arrived.
  void run(std::uint64_t frames) {
    if (counts_.connections == 0) {
      connect();
      choose();
    }
    const std::uint64_t until = counts_.frames + frames;
    while (counts_.frames < until) request();
  }

  // Serves an access of the card. Throws std::logic_error if it is not the expected access.
  Answer access(bool write, std::uint32_t address, std::uint32_t data) {
    if (address < kFirst) {
      if (write || address < 0x40 || address > 0x50) fail("an access to the card's state that no reply needs");
      return {false, state_word(address)};
    }
    if (made_ == current_.count || stopped_) fail("an access that no request has");
    const bool fits = write == (current_.kind == frames::Kind::Write) && address == due_address();
    if (!fits || (write && data != current_.data[made_])) fail("a wrong access");
    if (made_ == refuse_at_) {
      stopped_ = true;
      return {true, 0};
    }
    const auto read = draw();
    if (!write) read_.push_back(read);
    ++made_;
    return {false, read};
  }

  const Counts& counts() const { return counts_; }
  // Summary for the log. A fault throws, so a printed summary means that there was none.
  std::string text() const {
    return std::to_string(counts_.frames) + " frames through a bad link (" + std::to_string(counts_.damaged) +
           " damaged, " + std::to_string(counts_.repeated) + " repeated, " + std::to_string(counts_.lost_replies) +
           " replies lost, " + std::to_string(counts_.connections) +
           " connections): " + std::to_string(counts_.requests) + " requests ran once each, 0 wrong, 0 twice";
  }

 private:
  static constexpr std::uint32_t kFirst = 0x100;
  static constexpr std::size_t kKept = 256;

  [[noreturn]] void fail(const std::string& what) const {
    throw std::logic_error(what + ", frame " + std::to_string(counts_.frames) + ", request " +
                           std::to_string(current_.number) + " of connection " + std::to_string(epoch_));
  }
  static std::uint32_t state_word(std::uint32_t address) { return 0x5A000000 | address; }

  std::uint32_t draw() { return static_cast<std::uint32_t>(random_() >> 32); }
  std::uint32_t below(std::uint32_t n) { return draw() % n; }
  bool chance(std::uint32_t one_in) { return below(one_in) == 0; }

  std::uint32_t due_address() const { return current_.address + (current_.fixed ? 0U : 4U * made_); }

  // Chooses a request of random words; short requests are more frequent.
  void choose() {
    frames::Request r;
    r.kind = chance(3) ? frames::Kind::Read : frames::Kind::Write;
    r.fixed = chance(2);
    r.count = static_cast<std::uint8_t>(1 + below(chance(long_one_in_) ? frames::kMaxWords : 4));
    r.address = static_cast<std::uint16_t>(kFirst + 4 * below(0x200));
    for (unsigned i = 0; r.kind == frames::Kind::Write && i < r.count; ++i) r.data.push_back(word());
    r.number = static_cast<std::uint16_t>(last_ + 1);
    r.epoch = epoch_;
    current_ = r;
    read_.clear();
    made_ = 0;
    stopped_ = false;
    refuse_at_ = chance(8) ? below(r.count) : ~0U;
  }
  // Bytes that need stuffing are more frequent than in random data.
  std::uint32_t word() {
    std::uint32_t w = draw();
    if (chance(4)) w = (w & ~0xFF00U) | std::uint32_t{frames::kEnd} << 8;
    if (chance(4)) w = (w & ~0xFFU) | frames::kEscape;
    return w;
  }

  // Repeats one request over the bad link until its reply arrives.
  void request() {
    frames::Bytes stream{frames::kEnd};
    frames::append_request(stream, current_);
    for (bool done = false; !done;) {
      while (chance(2)) disturb(stream);
      if (restart_ && chance(64)) restart(stream);
      ++counts_.frames;
      const frames::Bytes reply = card_(stream);
      keep(stream);
      if (chance(8)) {
        ++counts_.lost_replies;
        continue;
      }
      done = judge(reply);
    }
    ++counts_.requests;
    counts_.refused += stopped_ ? 1 : 0;
    last_ = current_.number;
    // A request number may be used again only in a new connection.
    if (last_ == 0xFFFF || chance(5000)) connect();
    choose();
  }

  // Starts a new connection. If the request has not run yet, the host may replace it by another one. The frame of the
  // old connection arrives late.
  void restart(frames::Bytes& stream) {
    const frames::Bytes before = stream;
    restart_();
    connect();
    if (card_last_ != current_.number && chance(2)) choose();
    current_.epoch = epoch_;
    stream = {frames::kEnd};
    frames::append_request(stream, current_);
    ++counts_.frames;
    ++counts_.repeated;
    deliver(before);
  }

  // Sends an old frame, noise or a damaged frame, or holds a copy of the frame back for later.
  void disturb(const frames::Bytes& stream) {
    ++counts_.frames;
    switch (below(8)) {
      case 0:
        return repeat();
      case 1:
        late_.push_back(stream);
        break;
      case 2:
        return noise();
      default:
        return damaged(stream);
    }
    if (late_.size() < 3) return;
    const std::size_t i = below(static_cast<std::uint32_t>(late_.size()));
    deliver(late_[i]);
    late_.erase(late_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  void repeat() {
    if (kept_.empty()) return;
    ++counts_.repeated;
    deliver(kept_[below(static_cast<std::uint32_t>(kept_.size()))]);
  }

  void noise() {
    frames::Bytes bytes(1 + below(40));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(draw());
    ++counts_.damaged;
    deliver(bytes);
  }

  // Keeps the first byte (END), which only ends earlier bytes, and damages the bytes after it.
  void damaged(frames::Bytes bytes) {
    ++counts_.damaged;
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const std::uint32_t place = 1 + below(size - 1);
    switch (below(6)) {
      case 0:  // up to four bits
        for (std::uint32_t n = 1 + below(4); n != 0; --n) flip(bytes, 8 + below(8 * (size - 1)));
        break;
      case 1:
        burst(bytes);
        break;
      case 2:  // cut short; three times out of four without END
        bytes.resize(place);
        if (chance(4)) bytes.push_back(frames::kEnd);
        break;
      case 3:
        bytes.insert(bytes.begin() + place, static_cast<std::uint8_t>(draw()));
        break;
      case 4:
        bytes.erase(bytes.begin() + place, bytes.begin() + place + 1 + below(size - place));
        break;
      default:  // the beginning of this frame, then the end of another one
        if (kept_.empty()) return deliver(bytes);
        const frames::Bytes& other = kept_[below(static_cast<std::uint32_t>(kept_.size()))];
        bytes.resize(place);
        bytes.insert(bytes.end(), other.begin() + below(static_cast<std::uint32_t>(other.size())), other.end());
    }
    deliver(bytes);
  }
  static void flip(frames::Bytes& bytes, std::uint32_t bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << bit % 8);
  }
  void burst(frames::Bytes& bytes) {
    const auto bits = static_cast<std::uint32_t>(8 * bytes.size());
    const std::uint32_t length = 2 + below(31);
    const std::uint32_t first = 8 + below(bits - 8 - length);
    flip(bytes, first);
    flip(bytes, first + length - 1);
    for (std::uint32_t i = 1; i + 1 < length; ++i) {
      if (chance(2)) flip(bytes, first + i);
    }
  }

  // Ignores the card's reply: the host waits for another one.
  void deliver(const frames::Bytes& bytes) { card_(bytes); }

  // Returns true if the reply reached the host. The frame was whole and began with END, so the card must reply to it.
  bool judge(frames::Bytes bytes) {
    if (chance(8) && !bytes.empty()) {
      ++counts_.lost_replies;
      const unsigned whole = replies(bytes);
      flip(bytes, below(static_cast<std::uint32_t>(8 * bytes.size())));
      if (replies(bytes) >= whole) fail("a damaged reply was taken");
      return false;
    }
    const frames::Reply reply = last_reply(bytes);
    if (reply.number != current_.number || reply.epoch != epoch_) fail("a reply to something else");
    const frames::Result due = stopped_ ? frames::Result::Refused : frames::Result::Done;
    if (reply.result != due || reply.made != made_ || reply.last != current_.number) fail("a wrong reply");
    if (!stopped_ && made_ != current_.count) fail("a request that ran in part");
    if (reply.has_data != (current_.kind == frames::Kind::Read) || reply.data != read_) fail("wrong data");
    for (std::uint32_t i = 0; i < frames::kStateWords; ++i) {
      if (reply.state.words[i] != state_word(0x40 + 4 * i)) fail("a wrong state");
    }
    return true;
  }
  static unsigned replies(const frames::Bytes& bytes) {
    frames::Deframer deframer(frames::kMaxReplyBody);
    unsigned whole = 0;
    for (const std::uint8_t byte : bytes)
      whole += deframer.take(byte) && frames::parse_reply(deframer.body()) ? 1U : 0U;
    return whole;
  }

  frames::Reply last_reply(const frames::Bytes& bytes) {
    frames::Deframer deframer(frames::kMaxReplyBody);
    std::optional<frames::Reply> reply;
    for (const std::uint8_t byte : bytes) {
      if (deframer.take(byte)) reply = frames::parse_reply(deframer.body());
    }
    if (!reply) fail("no reply to a whole frame");
    return *reply;
  }

  // Connects as a host does: asks for the epoch, then increments it.
  void connect() {
    frames::Request ask;
    ask.number = static_cast<std::uint16_t>(draw());
    const frames::Reply card = exchange(ask);
    frames::Request request;
    request.kind = frames::Kind::Connect;
    request.epoch = card.epoch;
    request.number = static_cast<std::uint16_t>(draw());
    const frames::Reply reply = exchange(request);
    const bool moved =
        reply.result == frames::Result::Done && reply.epoch == static_cast<std::uint16_t>(card.epoch + 1);
    if (!moved || reply.number != request.number) fail("a connection that was not made");
    epoch_ = reply.epoch;
    card_last_ = reply.last;
    if (counts_.connections == 0) last_ = card_last_;
    ++counts_.connections;
  }
  frames::Reply exchange(const frames::Request& request) {
    frames::Bytes stream{frames::kEnd};
    frames::append_request(stream, request);
    ++counts_.frames;
    keep(stream);
    return last_reply(card_(stream));
  }

  // Keeps frames for repetition. Nearly all replace a frame in the first half of the places. One in 1000 may go to any
  // place, so the second half holds old frames.
  void keep(const frames::Bytes& stream) {
    if (kept_.size() < kKept) return kept_.push_back(stream);
    kept_[below(chance(1000) ? kKept : kKept / 2)] = stream;
  }

  std::mt19937_64 random_;
  Card card_;
  Restart restart_;
  std::uint32_t long_one_in_;
  Counts counts_;
  std::uint16_t epoch_ = 0;
  std::uint16_t last_ = 0;
  std::uint16_t card_last_ = 0;  // last request that the card had run, as it reported at the last connection
  frames::Request current_;
  std::uint32_t made_ = 0;       // accesses of current_ that the card has made
  std::uint32_t refuse_at_ = 0;  // index of the word that is refused; ~0: none
  bool stopped_ = false;         // the refusal has happened
  std::vector<std::uint32_t> read_;
  std::vector<frames::Bytes> kept_;
  std::vector<frames::Bytes> late_;
};

}  // namespace trammel::test
