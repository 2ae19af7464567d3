#include "trammel/hm2/udp_port.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <linux/if_packet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>

#include "trammel/driver/errors.hpp"

namespace trammel::hm2 {
namespace {

using namespace std::chrono;

constexpr int kReceiveBytes = 1 << 20;  // room for some hundred periods, in case the server is late
// Greatest plausible age of a kernel time stamp; an older one means that the clock was set.
constexpr nanoseconds kOldest = seconds(1);

sockaddr_in socket_address(const Peer& peer) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = peer.address;
  address.sin_port = peer.port;
  return address;
}

Peer peer_of(const sockaddr_in& address) { return {address.sin_addr.s_addr, address.sin_port}; }

// The stamp is in wall-clock time; its age is the same on every clock.
steady_clock::time_point time_of_arrival(msghdr& message) {
  const auto now = steady_clock::now();
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(part), sizeof(stamp));
    const nanoseconds age =
        system_clock::now().time_since_epoch() - (seconds(stamp.tv_sec) + nanoseconds(stamp.tv_nsec));
    if (age >= nanoseconds(0) && age < kOldest) return now - age;
  }
  return now;
}

}  // namespace

std::string Peer::text() const {
  char text[INET_ADDRSTRLEN] = {};
  in_addr number{};
  number.s_addr = address;
  ::inet_ntop(AF_INET, &number, text, sizeof(text));
  return fmt::format("{}:{}", text, ntohs(port));
}

UdpPort::UdpPort(const std::string& host, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (host.empty() || ::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) {
    throw driver::LinkError(fmt::format("\"{}\": no such address of this machine", host));
  }
  sockaddr_in wanted{};
  std::memcpy(&wanted, found->ai_addr, sizeof(wanted));
  ::freeaddrinfo(found);
  wanted.sin_port = htons(port);
  file_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (file_ < 0) fail(std::strerror(errno));
  const int on = 1;
  ::setsockopt(file_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
  ::setsockopt(file_, SOL_SOCKET, SO_RCVBUF, &kReceiveBytes, sizeof(kReceiveBytes));
  if (::bind(file_, reinterpret_cast<const sockaddr*>(&wanted), sizeof(wanted)) != 0) {
    if (errno == EADDRINUSE)
      fail(fmt::format("UDP port {} is in use: end what listens there, or choose another", port));
    if (errno == EADDRNOTAVAIL) fail(fmt::format("\"{}\": no such address of this machine", host));
    fail(fmt::format("{}: cannot listen: {}", peer_of(wanted).text(), std::strerror(errno)));
  }
  sockaddr_in bound{};
  socklen_t size = sizeof(bound);
  ::getsockname(file_, reinterpret_cast<sockaddr*>(&bound), &size);
  address_ = peer_of(bound);
}

UdpPort::~UdpPort() { ::close(file_); }

void UdpPort::fail(const std::string& why) {
  ::close(file_);
  throw driver::LinkError(why);
}

void UdpPort::wait(steady_clock::time_point until) {
  const nanoseconds left = std::max<nanoseconds>(until - steady_clock::now(), nanoseconds(0));
  const timespec longest{static_cast<std::time_t>(duration_cast<seconds>(left).count()),
                         static_cast<long>((left % seconds(1)).count())};
  pollfd entry{file_, POLLIN, 0};
  ::ppoll(&entry, 1, &longest, nullptr);
}

bool UdpPort::receive(Datagram& datagram) {
  sockaddr_in from{};
  iovec place{datagram.bytes.data(), datagram.bytes.size()};
  alignas(cmsghdr) std::array<char, 128> parts{};
  msghdr message{};
  message.msg_name = &from;
  message.msg_namelen = sizeof(from);
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  message.msg_control = parts.data();
  message.msg_controllen = parts.size();
  const ssize_t size = ::recvmsg(file_, &message, 0);
  if (size < 0) return false;
  datagram.size = static_cast<std::size_t>(size);
  datagram.from = peer_of(from);
  datagram.came = time_of_arrival(message);
  return true;
}

void UdpPort::send(const Bytes& bytes, const Peer& to) {
  const sockaddr_in address = socket_address(to);
  ::sendto(file_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
}

std::array<std::uint8_t, 6> UdpPort::hardware_address() const {
  std::array<std::uint8_t, 6> hardware{};
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return hardware;
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> all(first, &::freeifaddrs);
  const auto has_address = [this](const ifaddrs& entry) {
    sockaddr_in own{};
    if (entry.ifa_addr == nullptr || entry.ifa_addr->sa_family != AF_INET) return false;
    std::memcpy(&own, entry.ifa_addr, sizeof(own));
    return own.sin_addr.s_addr == address_.address;
  };
  for (const ifaddrs* by_number = first; by_number != nullptr; by_number = by_number->ifa_next) {
    if (!has_address(*by_number)) continue;
    for (const ifaddrs* entry = first; entry != nullptr; entry = entry->ifa_next) {
      if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_PACKET) continue;
      if (std::strcmp(entry->ifa_name, by_number->ifa_name) != 0) continue;
      sockaddr_ll link{};
      std::memcpy(&link, entry->ifa_addr, sizeof(link));
      if (link.sll_halen == hardware.size()) std::copy_n(link.sll_addr, hardware.size(), hardware.begin());
    }
  }
  return hardware;
}

}  // namespace trammel::hm2
