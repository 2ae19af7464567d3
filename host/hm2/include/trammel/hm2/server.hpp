// `trammel serve --hm2`: a card behind a UDP port for one driver. Each datagram counts at the card's clock at which it
// came, by the kernel's time stamp, however late this process is; only the answer is late then.
//
// It sleeps until a datagram comes, a line is due or the watchdog's time is over. Errors: LinkError. One thread.
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
    std::uint32_t clock_hz = 0;  // of the card
    double lose_percent = 0;     // of the datagrams, each way, on purpose, once something has moved
    std::uint64_t seed = 1;      // of which
    std::function<void(const std::string&)> note = [](const auto&) {};  // what the operator should know
  };
  struct Counts {
    std::uint64_t drivers = 0;
    std::uint64_t strangers = 0;  // datagrams of others while a driver was there
    std::uint64_t lost = 0;       // on purpose
    std::chrono::nanoseconds longest_answer{};
    std::chrono::nanoseconds longest_gap{};  // from a datagram of the driver's to its next one
    double lost_seconds = 0;                 // that the card was too slow for
  };

  // All must outlive it.
  Server(Hostmot2& hostmot2, Board& board, UdpPort& port, Settings settings);

  // Serves what has come and what is due; sleeps before that for 50 ms at most.
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
