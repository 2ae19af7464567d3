// Golden model of the serial port, cycle-exact at every port: docs/developer/architecture.md. The k-th bit after an
// edge ends floor(k/8 * period) clocks after it, where the period is the measured time of 8 bits. Not thread-safe.
#pragma once

#include <cstdint>

namespace trammel::model {

class UartPort {
 public:
  struct Inputs {
    bool rx = true;
    bool valid = false;  // a byte for the line
    std::uint8_t byte = 0;
  };

  struct Outputs {
    bool tx = true;
    bool restart = false;     // event: a break
    bool byte_valid = false;  // event
    std::uint8_t byte = 0;    // valid with byte_valid
    bool ready = false;
  };

  static constexpr std::uint32_t kMinPeriod = 64;
  static constexpr std::uint32_t kMaxPeriod = (1U << 20) - 2;

  // A break is 2^break_bits clocks.
  explicit UartPort(unsigned break_bits = 20) : break_bits_(break_bits) {}

  void reset() { *this = UartPort(break_bits_); }

  // One rising edge with reset low.
  void clock(const Inputs& in) {
    const bool level = second_;
    const bool fall = before_ && !second_;
    const bool known = known_;
    const bool takes = in.valid && out_.ready;
    measure(level, fall);
    receive(known, level, fall);
    send(known, takes, in.byte);
    before_ = second_;
    second_ = first_;
    first_ = in.rx;
    ++now_;
    out_.ready = known_ && !sending_;
  }

  const Outputs& outputs() const { return out_; }
  // Clocks per 8 bits; 0: not known.
  std::uint32_t period() const { return known_ ? period_ : 0; }

 private:
  enum class Baud : std::uint8_t { Idle, Start, Count, Settle };

  // Detects breaks and measures the baud rate.
  void measure(bool level, bool fall) {
    if (out_.restart) {
      baud_ = Baud::Start;
      known_ = false;
    } else {
      follow(level, fall);
    }
    low_ = level ? 0 : low_ + 1;
    out_.restart = low_ == std::uint64_t{1} << break_bits_;
  }
  void follow(bool level, bool fall) {
    switch (baud_) {
      case Baud::Idle:
        break;
      case Baud::Start:
        if (fall) {
          baud_ = Baud::Count;
          first_edge_ = now_;
          edges_ = 0;
        }
        break;
      case Baud::Count:
        if (now_ - first_edge_ > kMaxPeriod + 1) {
          baud_ = Baud::Idle;
        } else if (fall && ++edges_ == 4) {
          period_ = static_cast<std::uint32_t>(now_ - first_edge_);
          baud_ = Baud::Settle;
        }
        break;
      case Baud::Settle:
        known_ = level && period_ >= kMinPeriod && period_ <= kMaxPeriod;
        if (level || period_ < kMinPeriod || period_ > kMaxPeriod) baud_ = Baud::Idle;
        break;
    }
  }

  // The middle of the start bit is half a bit after its edge; the other bits follow at distances of one bit.
  void receive(bool known, bool level, bool fall) {
    out_.byte_valid = false;
    if (!known) {
      receiving_ = false;
    } else if (!receiving_) {
      receiving_ = fall;
      start_edge_ = now_;
      received_ = 0;
    } else if (now_ == start_edge_ + period_ / 16 + received_ * std::uint64_t{period_} / 8) {
      sample(level);
    }
  }
  void sample(bool level) {
    if (received_ == 0) {
      receiving_ = !level;
    } else if (received_ == 9) {
      receiving_ = false;
      out_.byte_valid = level;
      out_.byte = bits_;
    } else {
      bits_ = static_cast<std::uint8_t>(bits_ >> 1 | (level ? 0x80 : 0));
    }
    ++received_;
  }

  // The start bit begins in the clock after the byte was taken.
  void send(bool known, bool takes, std::uint8_t byte) {
    if (!known) {
      sending_ = false;
      out_.tx = true;
    } else if (takes) {
      sending_ = true;
      taken_ = now_;
      sent_ = 0;
      frame_ = 0x200U | unsigned{byte} << 1;
      out_.tx = false;
    } else if (sending_ && now_ == taken_ + (sent_ + 1) * std::uint64_t{period_} / 8) {
      ++sent_;
      out_.tx = sent_ == 10 || (frame_ >> sent_ & 1) != 0;
      sending_ = sent_ != 10;
    }
  }

  unsigned break_bits_;
  std::uint64_t now_ = 0;
  bool first_ = true;      // the line one clock ago
  bool second_ = true;     // the line two clocks ago
  bool before_ = true;     // the line three clocks ago
  std::uint64_t low_ = 0;  // clocks for which the line has been low
  Baud baud_ = Baud::Idle;
  std::uint64_t first_edge_ = 0;
  unsigned edges_ = 0;
  bool known_ = false;
  std::uint32_t period_ = 0;
  bool receiving_ = false;
  std::uint64_t start_edge_ = 0;
  unsigned received_ = 0;  // bits received
  std::uint8_t bits_ = 0;
  bool sending_ = false;
  std::uint64_t taken_ = 0;
  unsigned sent_ = 0;  // bits sent
  unsigned frame_ = 0;
  Outputs out_;
};

}  // namespace trammel::model
