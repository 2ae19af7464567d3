// The host's end of a serial line, in clocks of the card; a bit is not a whole number of clocks.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace trammel::lockstep {

class UartLine {
 public:
  // `period`: clocks of the card per 8 bits.
  void set_period(double period) { bit_ = period / 8; }
  double bit() const { return bit_; }

  // Queues a level for a number of bits, a byte, or a break with the byte that tells the rate.
  void hold(bool level, double bits) { waiting_.push_back({level, bits * bit_}); }
  void send(std::uint8_t byte) {
    hold(false, 1);
    for (unsigned i = 0; i < 8; ++i) hold((byte >> i & 1) != 0, 1);
    hold(true, 1);
  }
  void break_line(double clocks) {
    waiting_.push_back({false, clocks});
    hold(true, 3);
    send(0x55);
    hold(true, 2);
  }
  bool busy() const { return !waiting_.empty(); }
  void clear() { waiting_.clear(); }

  // The level in the next clock. Edges fall between clocks; the remainder is carried over.
  bool next() {
    gone_ += 1;
    while (!waiting_.empty() && gone_ > waiting_.front().clocks) {
      gone_ -= waiting_.front().clocks;
      waiting_.pop_front();
    }
    if (waiting_.empty()) gone_ = 0;
    return waiting_.empty() || waiting_.front().level;
  }

  // Takes the card's line, one level per clock; returns a byte after its stop bit.
  std::optional<std::uint8_t> take(bool level) {
    since_ += 1;
    if (!running_) {
      if (!level) {
        running_ = true;
        since_ = 0;
        bits_ = 0;
        place_ = 0;
      }
      return std::nullopt;
    }
    if (since_ < (place_ + 0.5) * bit_) return std::nullopt;
    if (place_ == 9) {
      running_ = false;
      return level ? std::optional<std::uint8_t>(static_cast<std::uint8_t>(bits_ >> 1)) : std::nullopt;
    }
    bits_ |= unsigned{level} << place_;
    ++place_;
    return std::nullopt;
  }

 private:
  struct Stretch {
    bool level;
    double clocks;
  };

  double bit_ = 8;
  std::deque<Stretch> waiting_;
  double gone_ = 0;  // clocks of the first stretch that have passed
  bool running_ = false;
  double since_ = 0;  // clocks since the start bit's edge
  unsigned place_ = 0;
  unsigned bits_ = 0;
};

}  // namespace trammel::lockstep
