// The environment of the frame engine and of the ports before it in their tests: an inner port whose accesses are
// judged or answered at random, and a source of frames.
#pragma once

#include <cstdint>
#include <deque>

#include "trammel/frames/frame.hpp"
#include "wires.hpp"

namespace trammel::lockstep {

// Answers each request after a given number of clocks.
class InnerPort {
 public:
  struct Answer {
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };

  // To be called in the clock in which the request shows: defines the answer, which comes `clocks` (1 or more) later.
  void ask(unsigned clocks, bool error, std::uint32_t data) {
    left_ = clocks + 1;
    answer_ = {true, error, data};
  }
  // The port's answer in this clock.
  Answer now() {
    if (left_ == 0) return {};
    return --left_ == 0 ? answer_ : Answer{};
  }
  bool open() const { return left_ != 0; }
  void clear() { left_ = 0; }

 private:
  unsigned left_ = 0;
  Answer answer_;
};

// Requests as a stream of bytes: most with the expected number and epoch, some without, some damaged, and noise.
class FrameSource {
 public:
  explicit FrameSource(Dice& dice) : dice_(dice) {}

  // The next byte, for a card with this last number and epoch.
  std::uint8_t next(std::uint16_t last, std::uint16_t epoch) {
    if (waiting_.empty()) fill(last, epoch);
    const std::uint8_t byte = waiting_.front();
    waiting_.pop_front();
    return byte;
  }
  void clear() { waiting_.clear(); }

 private:
  void fill(std::uint16_t last, std::uint16_t epoch) {
    frames::Bytes stream;
    if (dice_.chance(2)) stream.push_back(frames::kEnd);
    frames::append_request(stream, request(last, epoch));
    if (dice_.chance(6)) body(stream, last, epoch);
    if (dice_.chance(5)) damage(stream);
    waiting_.insert(waiting_.end(), stream.begin(), stream.end());
  }

  frames::Request request(std::uint16_t last, std::uint16_t epoch) {
    frames::Request r;
    r.kind = static_cast<frames::Kind>(dice_.chance(4) ? dice_.below(4) : 2 + dice_.below(2));
    r.fixed = dice_.chance(2);
    const bool moves = r.kind == frames::Kind::Read || r.kind == frames::Kind::Write;
    if (moves) r.count = static_cast<std::uint8_t>(1 + dice_.below(dice_.chance(12) ? frames::kMaxWords : 3));
    // Sometimes past the end of the window; numbers and epochs that differ in one bit, or by a carry.
    r.address = static_cast<std::uint16_t>(4 * (dice_.chance(6) ? 1020 + dice_.below(4) : dice_.below(1024)));
    r.number = static_cast<std::uint16_t>(last + (dice_.chance(4) ? 0 : 1));
    if (dice_.chance(12)) r.number = static_cast<std::uint16_t>(r.number ^ 1U << dice_.below(16));
    r.epoch = epoch;
    if (dice_.chance(12)) r.epoch = static_cast<std::uint16_t>(epoch ^ 1U << dice_.below(16));
    for (unsigned i = 0; r.kind == frames::Kind::Write && i < r.count; ++i) r.data.push_back(word());
    return r;
  }
  std::uint32_t word() {
    std::uint32_t w = dice_.draw();
    if (dice_.chance(4)) w = (w & ~0xFFU) | frames::kEscape;
    if (dice_.chance(4)) w = (w & ~0xFF0000U) | std::uint32_t{frames::kEnd} << 16;
    return w;
  }
  // A good CRC over a header that no host makes, with or without words.
  void body(frames::Bytes& stream, std::uint16_t last, std::uint16_t epoch) {
    frames::Bytes b{static_cast<std::uint8_t>(dice_.chance(2) ? dice_.below(4) : dice_.below(256)),
                    static_cast<std::uint8_t>(dice_.chance(2)   ? dice_.below(3)
                                              : dice_.chance(2) ? 56 + dice_.below(10)
                                                                : dice_.below(256)),
                    static_cast<std::uint8_t>(last + 1),
                    static_cast<std::uint8_t>((last + 1) >> 8),
                    static_cast<std::uint8_t>(epoch),
                    static_cast<std::uint8_t>(epoch >> 8),
                    static_cast<std::uint8_t>(dice_.chance(2) ? 4 * dice_.below(64) : dice_.below(256)),
                    static_cast<std::uint8_t>(dice_.chance(2) ? dice_.below(16) : dice_.below(256))};
    const bool write = (b[0] & 3) == 3;
    std::size_t words = write ? b[1] % 64U : 0U;
    if (dice_.chance(6)) words = dice_.below(64);
    // A read of a few words more than a reply can have.
    if (dice_.chance(4)) {
      b[0] = 2;
      b[1] = static_cast<std::uint8_t>(59 + dice_.below(6));
      b[6] = b[7] = 0;
      words = 0;
    }
    for (std::size_t i = 0; i < 4 * words; ++i) b.push_back(static_cast<std::uint8_t>(dice_.below(256)));
    if (dice_.chance(6)) b.resize(b.size() - 1 - dice_.below(8));
    // Shorter than any request, with a count whose length in bytes needs more than 8 bits.
    if (dice_.chance(8)) b = {static_cast<std::uint8_t>(dice_.chance(2) ? 3 : 0x13), 63, b[2], b[3]};
    if (dice_.chance(8)) more_than_fits(b);
    frames::append_frame(stream, b);
  }
  // 256 bytes, then a whole ask: an 8-bit position counter has wrapped.
  void more_than_fits(frames::Bytes& b) {
    b.assign(264, 0);
    for (unsigned i = 0; i < 256; ++i) b[i] = static_cast<std::uint8_t>(dice_.below(256));
  }
  void damage(frames::Bytes& stream) {
    const std::uint32_t place = dice_.below(static_cast<std::uint32_t>(stream.size()));
    switch (dice_.below(7)) {
      case 5:  // an escape without meaning
        stream.insert(stream.begin() + place, {frames::kEscape, static_cast<std::uint8_t>(dice_.below(256))});
        break;
      case 6:  // a doubled escape
        for (std::size_t i = 0; i < stream.size(); ++i) {
          if (stream[i] != frames::kEscape) continue;
          stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(i), frames::kEscape);
          break;
        }
        break;
      case 0:
        stream[place] = static_cast<std::uint8_t>(stream[place] ^ 1U << dice_.below(8));
        break;
      case 1:
        stream.resize(place + 1);
        break;
      case 2:
        stream.insert(stream.begin() + place, static_cast<std::uint8_t>(dice_.below(256)));
        break;
      case 3:
        stream[place] = dice_.chance(2) ? frames::kEscape : frames::kEnd;
        break;
      default:
        stream.insert(stream.begin() + place, 1 + dice_.below(260), static_cast<std::uint8_t>(dice_.below(256)));
    }
  }

  Dice& dice_;
  std::deque<std::uint8_t> waiting_;
};

}  // namespace trammel::lockstep
