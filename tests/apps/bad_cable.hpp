// A cable between a client and a server that breaks.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "trammel/driver/errors.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/card_url.hpp"

namespace trammel::test {

// Carries bytes, and cuts each of the first `cuts` connections after `bytes` bytes. Later connections are carried too.
class BadCable {
 public:
  explicit BadCable(const std::string& server_url, std::uint64_t bytes = 0, unsigned cuts = 0)
      : server_(transport::parse_card_url(server_url)), bytes_(bytes), cuts_(cuts), thread_([this] { carry(); }) {}
  ~BadCable() {
    ended_ = true;
    thread_.join();
  }
  std::string url() const { return listener_->url(); }
  // Number of cuts so far.
  unsigned cuts() const { return made_; }
  void cut() { cut_now_ = true; }

 private:
  using Stream = std::unique_ptr<transport::ByteStream>;

  void carry() {
    while (!ended_) {
      Stream client = listener_->accept();
      if (client) carry(*client);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void carry(transport::ByteStream& client) {
    try {
      const Stream server = transport::connect_tcp(server_.host, server_.port, std::chrono::seconds(5));
      std::uint64_t carried = 0;
      bool is_cut = false;
      while (!ended_ && !is_cut) {
        carried += move(client, *server) + move(*server, client);
        is_cut = cut_now_.exchange(false) || (made_ < cuts_ && carried >= bytes_);
      }
      made_ += is_cut ? 1 : 0;
    } catch (const driver::LinkError&) {
    }
  }
  static std::size_t move(transport::ByteStream& from, transport::ByteStream& to) {
    std::uint8_t bytes[64];
    const std::size_t count = from.read(bytes, sizeof(bytes), std::chrono::nanoseconds(0));
    to.write(bytes, count);
    return count;
  }

  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  transport::CardUrl server_;
  std::uint64_t bytes_;
  unsigned cuts_;
  std::atomic<unsigned> made_{0};
  std::atomic<bool> cut_now_{false};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace trammel::test
