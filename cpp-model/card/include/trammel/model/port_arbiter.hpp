// Golden model of the port arbiter: several host ports share the one inner port in turn
// (docs/developer/architecture.md). One instance per card; not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace trammel::model {

class PortArbiter {
 public:
  static constexpr std::size_t kMaxPorts = 4;

  struct Access {
    bool request = false;  // event; the other fields are stable until the answer
    bool write = false;
    bool partial = false;
    std::uint32_t address = 0;  // byte address, 12 bits
    std::uint32_t data = 0;
    bool of_session = true;    // a session of the port made the access, not the port itself
    bool new_session = false;  // it is the first access of a session
  };
  using Accesses = std::array<Access, kMaxPorts>;

  // The access as the core sees it, and its port.
  struct Inner {
    Access access;
    std::uint8_t port = 0;
  };

  // ports: 1 .. 4; throws std::invalid_argument otherwise.
  explicit PortArbiter(std::size_t ports) : ports_(ports), last_(ports - 1) {
    if (ports < 1 || ports > kMaxPorts) throw std::invalid_argument("PortArbiter: 1 to 4 ports");
  }

  void reset() { *this = PortArbiter(ports_); }

  // The request side of the inner port in this clock. With one port it is combinational. With more ports it is
  // registered: a request at c is noted at c+1 and passed on at c+2, or in the clock after the answer to the previous
  // request.
  Inner inner(const Accesses& now) const { return ports_ == 1 ? Inner{now[0], 0} : inner_; }

  // The port to which an answer of the core belongs. The answer is passed on in the same clock.
  std::size_t served() const { return inner_.port; }

  // One rising edge with reset low; `ack`: the core answers.
  void clock(const Accesses& now, bool ack) {
    if (ports_ == 1) return;
    inner_.access.request = false;
    if (ack) busy_ = false;
    for (std::size_t i = 1; i <= ports_ && !busy_; ++i) {
      const std::size_t port = (last_ + i) % ports_;
      if (noted_[port]) pass_on(now[port], port);
    }
    for (std::size_t port = 0; port < ports_; ++port) noted_[port] = noted_[port] || now[port].request;
  }

 private:
  void pass_on(const Access& access, std::size_t port) {
    busy_ = true;
    noted_[port] = false;
    last_ = port;
    inner_ = {access, static_cast<std::uint8_t>(port)};
    inner_.access.request = true;
  }

  std::size_t ports_;
  std::size_t last_;  // port served last
  bool busy_ = false;
  std::array<bool, kMaxPorts> noted_{};
  Inner inner_;
};

}  // namespace trammel::model
