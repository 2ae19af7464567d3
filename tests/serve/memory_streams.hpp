// A server and its clients in one thread: a client that waits lets the server take its turns. The results therefore do
// not depend on the host's time, and a client can be killed at any byte.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "trammel/driver/errors.hpp"
#include "trammel/serve/card_server.hpp"

namespace trammel::test {

struct Pipe {
  std::deque<std::uint8_t> to_server;
  std::deque<std::uint8_t> to_client;
  bool client_open = true;
  bool server_open = true;
};

// Thrown out of a client that is killed. The driver does not catch it.
struct Killed {};

class MemoryListener final : public transport::Listener {
 public:
  std::unique_ptr<transport::ByteStream> accept() override {
    if (!arriving_) return nullptr;
    return std::make_unique<ServerEnd>(std::exchange(arriving_, nullptr));
  }
  std::string url() const override { return "memory"; }
  void arrive(std::shared_ptr<Pipe> pipe) { arriving_ = std::move(pipe); }

 private:
  class ServerEnd final : public transport::ByteStream {
   public:
    explicit ServerEnd(std::shared_ptr<Pipe> pipe) : pipe_(std::move(pipe)) {}
    ~ServerEnd() override { pipe_->server_open = false; }
    void write(const std::uint8_t* bytes, std::size_t count) override {
      if (!pipe_->client_open) throw driver::LinkError("the client has gone");
      pipe_->to_client.insert(pipe_->to_client.end(), bytes, bytes + count);
    }
    std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds) override {
      const std::size_t count = std::min(room, pipe_->to_server.size());
      if (count == 0 && !pipe_->client_open) throw driver::LinkError("the client has gone");
      std::copy_n(pipe_->to_server.begin(), count, bytes);
      pipe_->to_server.erase(pipe_->to_server.begin(), pipe_->to_server.begin() + static_cast<std::ptrdiff_t>(count));
      return count;
    }
    std::string peer() const override { return "client"; }

   private:
    std::shared_ptr<Pipe> pipe_;
  };

  std::shared_ptr<Pipe> arriving_;
};

// The client's end of a connection.
class ClientEnd final : public transport::ByteStream {
 public:
  // Event at the end of a client's life.
  enum class End { kKilled, kCut };
  // `life`: number of bytes that the client sends and reads before it is killed, or before its connection is cut.
  ClientEnd(serve::CardServer& server, MemoryListener& listener, std::optional<std::uint64_t> life = std::nullopt,
            End end = End::kKilled)
      : server_(server), life_(life), end_(end) {
    listener.arrive(pipe_);
    server_.turn();
  }
  ~ClientEnd() override { pipe_->client_open = false; }
  ClientEnd(const ClientEnd&) = delete;
  ClientEnd& operator=(const ClientEnd&) = delete;

  void write(const std::uint8_t* bytes, std::size_t count) override {
    if (!pipe_->server_open) throw driver::LinkError("the server has closed");
    const auto sent = static_cast<std::size_t>(life_ ? std::min<std::uint64_t>(*life_, count) : count);
    pipe_->to_server.insert(pipe_->to_server.end(), bytes, bytes + sent);
    live(count);
  }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    for (int turns = 0; pipe_->to_client.empty() && longest.count() > 0 && turns < 1'000'000; ++turns) {
      if (!pipe_->server_open) throw driver::LinkError("the server has closed");
      server_.turn();
    }
    const std::size_t count = std::min(room, pipe_->to_client.size());
    std::copy_n(pipe_->to_client.begin(), count, bytes);
    pipe_->to_client.erase(pipe_->to_client.begin(), pipe_->to_client.begin() + static_cast<std::ptrdiff_t>(count));
    live(count);
    return count;
  }
  std::string peer() const override { return "server"; }

 private:
  void cut() {
    pipe_->client_open = false;
    pipe_->server_open = false;
  }
  void live(std::uint64_t bytes) {
    if (!life_) return;
    if (*life_ < bytes && end_ == End::kKilled) throw Killed();
    if (*life_ < bytes) {
      cut();
      throw driver::LinkError("the cable is cut");
    }
    *life_ -= bytes;
  }

  serve::CardServer& server_;
  std::shared_ptr<Pipe> pipe_ = std::make_shared<Pipe>();
  std::optional<std::uint64_t> life_;
  End end_;
};

}  // namespace trammel::test
