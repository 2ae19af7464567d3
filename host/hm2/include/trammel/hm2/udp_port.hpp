// A UDP port of this machine (IPv4). Each datagram has its arrival time by the kernel's clock, which a delay of this
// process does not change. Used by one thread.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

#include "trammel/hm2/lbp16.hpp"

namespace trammel::hm2 {

struct Peer {
  std::uint32_t address = 0;  // in network byte order, as `port`
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
  // `host`: an address or a name of this machine; `port` 0: any free port. Throws driver::LinkError with a one-line
  // message that gives the remedy.
  UdpPort(const std::string& host, std::uint16_t port);
  ~UdpPort();
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  // Sleeps until a datagram arrives, a signal arrives, or `until`.
  void wait(std::chrono::steady_clock::time_point until);
  // Takes the oldest datagram; false: there is none. A datagram that is larger than the buffer is cut.
  bool receive(Datagram& datagram);
  // A datagram that the network does not accept is lost, as any datagram may be.
  void send(const Bytes& bytes, const Peer& to);

  const Peer& address() const { return address_; }
  // Ethernet address of the interface with address(), first byte first; zeros if it has none, or if the port listens on
  // all interfaces.
  std::array<std::uint8_t, 6> hardware_address() const;

 private:
  [[noreturn]] void fail(const std::string& why);

  int file_ = -1;
  Peer address_;
};

}  // namespace trammel::hm2
