// A server of a simulated card, without sockets and threads, and clients in the same process.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include "memory_streams.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/links.hpp"

namespace trammel::test {

using transport::StreamLink;

constexpr std::uint32_t kClock = 1'000'000;

class ClientsTest : public ::testing::Test {
 protected:
  static serve::Settings settings(std::uint32_t baud = 0) {
    serve::Settings settings;
    settings.token = "secret";
    settings.clock_hz = kClock;
    settings.real_time = false;
    settings.baud = baud;
    return settings;
  }
  void start(serve::Settings settings) {
    settings.note = [this](const std::string& text) { notes_ += text + "\n"; };
    server_ = std::make_unique<serve::CardServer>(*engine_, listener_, settings);
  }
  StreamLink::Open opener() {
    return [this] { return std::make_unique<ClientEnd>(*server_, listener_); };
  }
  // Reply that a client reads after it has sent `text`.
  std::string answer_to(const std::string& text) {
    ClientEnd client(*server_, listener_);
    client.write(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    for (int i = 0; i < 5; ++i) server_->turn();
    std::array<std::uint8_t, 256> bytes{};
    const std::size_t count = client.read(bytes.data(), bytes.size(), std::chrono::nanoseconds(0));
    return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)};
  }
  std::string link_error(const std::string& token) {
    try {
      StreamLink link(opener(), StreamLink::Hello{token});
    } catch (const driver::LinkError& error) {
      return error.what();
    }
    return "";
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine(sim::EngineOptions{4, kClock, false});
  MemoryListener listener_;
  std::unique_ptr<serve::CardServer> server_;
  std::string notes_;
};

}  // namespace trammel::test
