// A cable between a client and a server that a test cuts and repairs.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "trammel/driver/errors.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "trammel/transport/card_url.hpp"

namespace trammel::test {

// Carries bytes for one client at a time, in its own thread.
class Cable {
 public:
  enum class State {
    kWhole,
    kClosed,  // both ends see their connections close; new connections are closed too
    kSilent,  // nothing is carried and nothing closes; new connections are accepted
  };

  explicit Cable(const std::string& server_url)
      : server_(transport::parse_card_url(server_url)), thread_([this] { carry(); }) {}
  ~Cable() {
    ended_ = true;
    thread_.join();
  }
  Cable(const Cable&) = delete;
  Cable& operator=(const Cable&) = delete;

  std::string url() const { return listener_->url(); }
  // Earlier connections are closed when the cable is whole again.
  void set(State state) { state_ = state; }

 private:
  using Stream = std::unique_ptr<transport::ByteStream>;

  bool is(State state) const { return state_ == state && !ended_; }
  static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

  void carry() {
    while (!ended_) {
      if (Stream client = listener_->accept()) {
        if (is(State::kWhole)) carry(*client);
        if (is(State::kSilent)) keep_silent(std::move(client));
      }
      pause();
    }
  }
  // Carries until the cable is cut or one end closes.
  void carry(transport::ByteStream& client) {
    try {
      const Stream server = transport::connect_tcp(server_.host, server_.port, std::chrono::seconds(5));
      while (is(State::kWhole)) {
        if (move(client, *server) + move(*server, client) == 0) pause();
      }
      keep_silent(nullptr);
    } catch (const driver::LinkError&) {
    }
  }
  void keep_silent(Stream first) {
    std::vector<Stream> clients;
    clients.push_back(std::move(first));
    while (is(State::kSilent)) {
      if (Stream client = listener_->accept()) clients.push_back(std::move(client));
      pause();
    }
  }
  static std::size_t move(transport::ByteStream& from, transport::ByteStream& to) {
    std::uint8_t bytes[256];
    const std::size_t count = from.read(bytes, sizeof(bytes), std::chrono::nanoseconds(0));
    to.write(bytes, count);
    return count;
  }

  std::unique_ptr<transport::Listener> listener_ = transport::listen_tcp("127.0.0.1", 0);
  transport::CardUrl server_;
  std::atomic<State> state_{State::kWhole};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace trammel::test
