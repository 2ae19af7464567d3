// `trammel serve --hm2`: a card behind a UDP port, for one driver. Each datagram takes effect at the card's clock of
// its arrival, by the kernel's time stamp. If this process is late, only the answer is late.
//
// The server sleeps until a datagram arrives, a line is due or the watchdog expires. Errors: LinkError. Used by one
// thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>

#include "trammel/hm2/board.hpp"
#include "trammel/hm2/udp_port.hpp"

namespace trammel::hm2 {

class Server {
 public:
  struct Settings {
    std::uint32_t clock_hz = 0;  // clock of the card
    double lose_percent = 0;     // share of datagrams to lose deliberately, per direction, after the first motion
    std::uint64_t seed = 1;      // seed of the random choice of lost datagrams
    std::function<void(const std::string&)> note = [](const auto&) {};  // gets messages for the operator
  };
  struct Counts {
    std::uint64_t drivers = 0;
    std::uint64_t strangers = 0;  // datagrams of others while a driver was active
    std::uint64_t lost = 0;       // lost deliberately
    std::chrono::nanoseconds longest_answer{};
    std::chrono::nanoseconds longest_gap{};  // between two datagrams of the driver
    double lost_seconds = 0;                 // time that the card was too slow to make up for
  };

  // `hostmot2`, `board` and `port` must outlive the server.
  Server(Hostmot2& hostmot2, Board& board, UdpPort& port, Settings settings);

  // Serves received datagrams and due work; sleeps before that for at most 50 ms.
  void turn();
  bool has_driver() const { return driver_.has_value(); }
  const Counts& counts() const { return counts_; }

 private:
  using Clock = std::chrono::steady_clock;

  void serve(const Datagram& datagram);
  bool admit(const Datagram& datagram);
  bool loses();
  void look_for_silence(Clock::time_point now);
  std::uint64_t clock_at(Clock::time_point time);
  Clock::time_point time_of(std::uint64_t clock) const;
  void run_to(Clock::time_point time);

  Hostmot2& hostmot2_;
  Board& board_;
  UdpPort& port_;
  Settings settings_;
  std::mt19937_64 random_;
  std::optional<Peer> driver_;
  Peer last_driver_;
  Clock::time_point heard_;
  Clock::time_point anchor_time_;
  std::uint64_t anchor_clock_ = 0;
  Counts counts_;
};

}  // namespace trammel::hm2
