// A UDP port of this machine (IPv4), and when each datagram came by the kernel's own clock: what a process that was
// late does not change. One thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

#include "trammel/hm2/lbp16.hpp"

namespace trammel::hm2 {

struct Peer {
  std::uint32_t address = 0;  // as the network has them
  std::uint16_t port = 0;
  bool operator==(const Peer& other) const { return address == other.address && port == other.port; }
  std::string text() const;  // 192.168.1.1:27181
};

struct Datagram {
  std::array<std::uint8_t, 2048> bytes{};
  std::size_t size = 0;
  Peer from;
  std::chrono::steady_clock::time_point came;
};

class UdpPort {
 public:
  // `host`: an address or a name of this machine; `port` 0: one that is free. Throws driver::LinkError with one line
  // that says what to do.
  UdpPort(const std::string& host, std::uint16_t port);
  ~UdpPort();
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  // Sleeps until a datagram is there, a signal has come, or `until`.
  void wait(std::chrono::steady_clock::time_point until);
  // Takes the oldest one; false: there is none. One that is larger than its place is cut.
  bool receive(Datagram& datagram);
  // A datagram that the network does not take is lost, as any may be.
  void send(const Bytes& bytes, const Peer& to);

  const Peer& address() const { return address_; }
  // Of the interface with address(), first byte first; zeros where it has none or all interfaces are meant.
  std::array<std::uint8_t, 6> hardware_address() const;

 private:
  [[noreturn]] void fail(const std::string& why);

  int file_ = -1;
  Peer address_;
};

}  // namespace trammel::hm2
