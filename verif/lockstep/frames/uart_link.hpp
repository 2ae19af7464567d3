// The driver's link over the pins of a card's serial port, in clocks of the card. Time is that of the card only.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>

#include "trammel/driver/byte_link.hpp"
#include "uart_line.hpp"

namespace trammel::lockstep {

// The host's end of the pins. Its owner gives the card the line's level in each clock, and calls take().
struct UartEnd {
  void take(bool level) {
    if (const std::optional<std::uint8_t> byte = line.take(level)) received.push_back(*byte);
  }
  // Starts a connection: a break, and the byte that tells the rate.
  void begin(double clocks_of_8_bits, double break_clocks) {
    line.clear();
    line.set_period(clocks_of_8_bits);
    line.break_line(break_clocks);
  }
  UartLine line;
  std::deque<std::uint8_t> received;
};

class UartLink final : public driver::ByteLink {
 public:
  struct Rate {
    std::uint64_t clock_hz = 1'000'000;
    double baud = 115'200;
    double break_clocks = 0;
  };

  // `end` must outlive it; `clock` runs one clock of the card, `cycles` returns their number so far.
  UartLink(UartEnd& end, const Rate& rate, std::function<void()> clock, std::function<std::uint64_t()> cycles)
      : end_(end), rate_(rate), clock_(std::move(clock)), cycles_(std::move(cycles)) {}

  void send(const std::uint8_t* bytes, std::size_t count) override {
    for (std::size_t i = 0; i < count; ++i) end_.line.send(bytes[i]);
    while (end_.line.busy()) clock_();
  }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    for (const auto until = now() + longest; end_.received.empty() && now() < until;) clock_();
    std::size_t count = 0;
    for (; count < room && !end_.received.empty(); ++count) {
      bytes[count] = end_.received.front();
      end_.received.pop_front();
    }
    return count;
  }
  void restart() override {
    end_.begin(8 * static_cast<double>(rate_.clock_hz) / rate_.baud, rate_.break_clocks);
    while (end_.line.busy()) clock_();
    end_.received.clear();
  }

  std::chrono::nanoseconds time_of(std::size_t bytes) const override {
    return std::chrono::nanoseconds(static_cast<std::int64_t>(1e10 / rate_.baud * static_cast<double>(bytes)));
  }
  std::chrono::nanoseconds now() const override {
    const std::uint64_t cycles = cycles_();
    return std::chrono::seconds(cycles / rate_.clock_hz) +
           std::chrono::nanoseconds(cycles % rate_.clock_hz * 1'000'000'000 / rate_.clock_hz);
  }
  void sleep(std::chrono::nanoseconds time) override {
    for (const auto until = now() + time; now() < until;) clock_();
  }

 private:
  UartEnd& end_;
  Rate rate_;
  std::function<void()> clock_;
  std::function<std::uint64_t()> cycles_;
};

}  // namespace trammel::lockstep
