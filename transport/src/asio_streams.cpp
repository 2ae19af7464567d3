// TCP and serial ports with Boost.Asio. Only this file includes it.
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <termios.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/serial_port.hpp>
#include <optional>
#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "wait_for_file.hpp"

namespace trammel::transport {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

// Code shared by sockets and serial ports. Neither waits by itself; poll() limits the waits.
template <class Port>
std::size_t read_some(Port& port, std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest,
                      const std::string& peer) {
  if (!wait_for_file(port.native_handle(), POLLIN, longest)) return 0;
  error_code error;
  const std::size_t count = port.read_some(asio::buffer(bytes, room), error);
  if (error == asio::error::would_block) return 0;
  if (error == asio::error::eof) throw driver::LinkError(fmt::format("{}: the other end has closed", peer));
  if (error) throw driver::LinkError(fmt::format("{}: {}", peer, error.message()));
  return count;
}

template <class Port>
void write_all(Port& port, const std::uint8_t* bytes, std::size_t count, const std::string& peer) {
  while (count != 0) {
    if (!wait_for_file(port.native_handle(), POLLOUT, std::chrono::seconds(1))) {
      throw driver::LinkError(fmt::format("{}: the other end takes no more bytes", peer));
    }
    error_code error;
    const std::size_t written = port.write_some(asio::buffer(bytes, count), error);
    if (error && error != asio::error::would_block) {
      throw driver::LinkError(fmt::format("{}: {}", peer, error.message()));
    }
    bytes += written;
    count -= written;
  }
}

class TcpStream final : public ByteStream {
 public:
  TcpStream(std::shared_ptr<asio::io_context> io, tcp::socket socket, std::string peer)
      : io_(std::move(io)), socket_(std::move(socket)), peer_(std::move(peer)) {
    socket_.non_blocking(true);
    socket_.set_option(tcp::no_delay(true));
  }

  void write(const std::uint8_t* bytes, std::size_t count) override { write_all(socket_, bytes, count, peer_); }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    return read_some(socket_, bytes, room, longest, peer_);
  }
  std::string peer() const override { return peer_; }

 private:
  std::shared_ptr<asio::io_context> io_;  // declared before the socket, which uses it
  tcp::socket socket_;
  std::string peer_;
};

class TcpListener final : public Listener {
 public:
  TcpListener(const std::string& host, std::uint16_t port) : acceptor_(*io_) {
    const std::string place = fmt::format("{}:{}", host, port);
    error_code error;
    tcp::resolver resolver(*io_);
    const auto found = resolver.resolve(host, std::to_string(port), tcp::resolver::passive, error);
    // An empty name would mean all addresses.
    if (host.empty() || error || found.empty()) {
      throw driver::LinkError(fmt::format("\"{}\": no such address of this machine", host));
    }
    const tcp::endpoint endpoint = *found.begin();
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error == asio::error::address_in_use) {
      throw driver::LinkError(fmt::format("port {} is in use: end what listens there, or choose another", port));
    }
    if (error) throw driver::LinkError(fmt::format("{}: cannot listen: {}", place, error.message()));
    acceptor_.non_blocking(true);
  }

  std::unique_ptr<ByteStream> accept() override {
    error_code error;
    tcp::socket socket = acceptor_.accept(error);
    if (error) return nullptr;  // no client, or it has left already
    error_code unknown;
    const tcp::endpoint peer = socket.remote_endpoint(unknown);
    if (unknown) return nullptr;
    return std::make_unique<TcpStream>(io_, std::move(socket), text_of(peer));
  }
  std::string url() const override { return "tcp://" + text_of(acceptor_.local_endpoint()); }

 private:
  static std::string text_of(const tcp::endpoint& endpoint) {
    const std::string address = endpoint.address().to_string();
    return fmt::format(endpoint.address().is_v6() ? "[{}]:{}" : "{}:{}", address, endpoint.port());
  }

  std::shared_ptr<asio::io_context> io_ = std::make_shared<asio::io_context>();
  tcp::acceptor acceptor_;
};

class SerialPort final : public SerialStream {
 public:
  SerialPort(std::string device, std::uint32_t baud) : device_(std::move(device)), port_(io_) {
    error_code error;
    port_.open(device_, error);
    if (error == boost::system::errc::no_such_file_or_directory) fail("no such device: is it plugged in?");
    if (error == boost::system::errc::permission_denied) fail("no permission: add your user to its group");
    if (error) fail("cannot open it as a serial line: " + error.message());
    if (::flock(port_.native_handle(), LOCK_EX | LOCK_NB) != 0) fail("another program uses it: end that first");
    using port = asio::serial_port_base;
    set(port::character_size(8));
    set(port::parity(port::parity::none));
    set(port::stop_bits(port::stop_bits::one));
    set(port::flow_control(port::flow_control::none));
    port_.set_option(port::baud_rate(baud), error);
    if (error) fail(fmt::format("the system has no baud rate {}: {}", baud, error.message()));
  }

  void write(const std::uint8_t* bytes, std::size_t count) override { write_all(port_, bytes, count, device_); }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    return read_some(port_, bytes, room, longest, device_);
  }
  void send_break() override {
    error_code error;
    port_.send_break(error);
    if (error) fail("no break: " + error.message());
    ::tcflush(port_.native_handle(), TCIFLUSH);
  }
  std::string peer() const override { return device_; }

 private:
  template <class Option>
  void set(const Option& option) {
    error_code error;
    port_.set_option(option, error);
    if (error) fail("no serial line: " + error.message());
  }
  [[noreturn]] void fail(const std::string& why) const {
    throw driver::LinkError(fmt::format("serial {}: {}", device_, why));
  }

  std::string device_;
  asio::io_context io_;
  asio::serial_port port_;
};

}  // namespace

std::unique_ptr<ByteStream> connect_tcp(const std::string& host, std::uint16_t port,
                                        std::chrono::milliseconds longest) {
  const std::string place = fmt::format("tcp://{}:{}", host, port);
  auto io = std::make_shared<asio::io_context>();
  error_code error;
  const auto found = tcp::resolver(*io).resolve(host, std::to_string(port), error);
  if (error) throw driver::LinkError(fmt::format("{}: no such host", place));
  tcp::socket socket(*io);
  std::optional<error_code> result;
  asio::async_connect(socket, found, [&](const error_code& code, const tcp::endpoint&) { result = code; });
  const auto until = std::chrono::steady_clock::now() + longest;
  while (!result && std::chrono::steady_clock::now() < until && !driver::interrupted()) {
    io->run_for(driver::kInterruptSlice);
  }
  if (!result) {
    const bool ended = driver::interrupted();
    socket.close(error);
    io->run();
    if (ended) throw driver::InterruptedError(fmt::format("{}: interrupted before it answered", place));
    throw driver::LinkError(fmt::format("{}: no answer within {} ms", place, longest.count()));
  }
  if (*result) {
    throw driver::LinkError(fmt::format("{}: {}: is `trammel serve` running there?", place, result->message()));
  }
  return std::make_unique<TcpStream>(std::move(io), std::move(socket), place);
}

std::unique_ptr<SerialStream> open_serial(const std::string& device, std::uint32_t baud) {
  return std::make_unique<SerialPort>(device, baud);
}

std::unique_ptr<Listener> listen_tcp(const std::string& host, std::uint16_t port) {
  return std::make_unique<TcpListener>(host, port);
}

}  // namespace trammel::transport
