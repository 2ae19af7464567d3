// The server on a local UDP port: answers in order, one driver at a time, and sleep while nothing is due.
#include "trammel/hm2/server.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <iostream>

#include "bench.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::hm2 {
namespace {

using namespace std::chrono_literals;

struct ServerBench : Bench {
  explicit ServerBench(double lose_percent = 0)
      : port("127.0.0.1", 0), server(hostmot2, board, port, settings(lose_percent)), driver("127.0.0.1", 0) {}

  Server::Settings settings(double lose_percent) {
    Server::Settings result;
    result.clock_hz = kClock;
    result.lose_percent = lose_percent;
    result.note = [this](const std::string& text) { notes.push_back(text); };
    return result;
  }
  void serve_for(std::chrono::nanoseconds longest) {
    for (const auto end = std::chrono::steady_clock::now() + longest; std::chrono::steady_clock::now() < end;)
      server.turn();
  }
  template <class Holds>
  bool serve_until(Holds holds) {
    for (const auto end = std::chrono::steady_clock::now() + 30s; !holds();) {
      if (std::chrono::steady_clock::now() > end) return false;
      server.turn();
    }
    return true;
  }
  static Bytes question(std::uint8_t mark) {
    Bytes datagram;
    append_write(datagram, Space::kTimer, 2, 0x10, {mark, 0});
    append_read(datagram, Space::kTimer, 2, 0x10, 1);
    return datagram;
  }
  // First bytes of the answers that have arrived.
  static std::vector<int> answers(UdpPort& to) {
    std::vector<int> marks;
    Datagram datagram;
    while (to.receive(datagram)) marks.push_back(datagram.bytes[0]);
    return marks;
  }
  bool noted(const std::string& part) const {
    return std::any_of(notes.begin(), notes.end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
  }

  UdpPort port;
  Server server;
  UdpPort driver;
};

TEST(Hm2Server, DatagramsInFlightAreAnsweredInTheirOrder) {
  ServerBench bench;
  std::vector<int> expected;
  for (std::uint8_t mark = 1; mark <= 40; ++mark) {
    bench.driver.send(ServerBench::question(mark), bench.port.address());
    expected.push_back(mark);
  }
  bench.driver.send({1, 2, 3}, bench.port.address());  // no answer
  EXPECT_TRUE(bench.serve_until([&] { return bench.board.counts().datagrams == 41; }));
  EXPECT_EQ(ServerBench::answers(bench.driver), expected);
  EXPECT_EQ(bench.board.counts().datagrams, 41U);
  EXPECT_EQ(bench.board.counts().all_refused(), 1U);
  EXPECT_TRUE(bench.noted("driver 127.0.0.1:"));
}

TEST(Hm2Server, OneDriverAtATimeAndTheNextOneWhenItHasGone) {
  ServerBench bench;
  UdpPort other("127.0.0.1", 0);
  bench.driver.send(ServerBench::question(1), bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.server.has_driver(); }));
  other.send(ServerBench::question(2), bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.server.counts().strangers == 1; }));
  EXPECT_EQ(ServerBench::answers(bench.driver), std::vector<int>{1});
  EXPECT_TRUE(ServerBench::answers(other).empty());
  EXPECT_TRUE(bench.serve_until([&] { return !bench.server.has_driver(); }));
  EXPECT_TRUE(bench.noted("has gone"));
  other.send(ServerBench::question(3), bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.server.has_driver(); }));
  EXPECT_EQ(ServerBench::answers(other), std::vector<int>{3});
  EXPECT_EQ(bench.server.counts().drivers, 2U);
}

TEST(Hm2Server, BehindABiteADriverThatIsStartedAnewIsTakenAtOnce) {
  ServerBench bench;
  UdpPort anew("127.0.0.1", 0);
  Bytes bite;
  append_write(bite, map_at::kWatchdogTimer, {1});
  bench.driver.send(bite, bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.hostmot2.bites() == 1; }));
  bench.serve_for(150ms);
  anew.send(ServerBench::question(7), bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.server.counts().drivers == 2; }));
  EXPECT_EQ(ServerBench::answers(anew), std::vector<int>{7});
}

// Also without a watchdog.
TEST(Hm2Server, ADriverThatFallsSilentStopsTheMotion) {
  ServerBench bench;
  Bytes rate;
  append_write(rate, map_at::kStepRate, {static_cast<std::uint32_t>(rate_of(5000))});
  bench.driver.send(rate, bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.pins(0) > 100; }));
  EXPECT_TRUE(bench.hostmot2.moves());
  EXPECT_TRUE(bench.serve_until([&] { return bench.hostmot2.bitten(); }));
  EXPECT_FALSE(bench.hostmot2.moves());
  EXPECT_EQ(bench.pins(0), bench.counter(0));
}

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

TEST(Hm2Server, AtRestItSleeps) {
  ServerBench bench;
  bench.driver.send(ServerBench::question(1), bench.port.address());
  bench.serve_for(50ms);
  const double before = cpu_seconds();
  bench.serve_for(500ms);
  const double used = cpu_seconds() - before;
  std::cout << "CPU time of half a second at rest: " << used * 1e3 << " ms\n";
  EXPECT_LT(used, 0.1);
}

TEST(Hm2Server, DatagramsAreLostOnPurposeFromTheFirstMotionOn) {
  ServerBench bench(100);
  bench.driver.send(ServerBench::question(1), bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.board.counts().datagrams == 1; }));
  EXPECT_EQ(ServerBench::answers(bench.driver), std::vector<int>{1});
  Bytes rate;
  append_write(rate, map_at::kStepRate, {1000});
  bench.driver.send(rate, bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.hostmot2.moves(); }));
  bench.driver.send(ServerBench::question(2), bench.port.address());
  EXPECT_TRUE(bench.serve_until([&] { return bench.server.counts().lost == 1; }));
  EXPECT_TRUE(ServerBench::answers(bench.driver).empty());
}

TEST(Hm2UdpPort, ItSaysWhyItCannotBeOpened) {
  const auto why = [](const std::string& host, std::uint16_t port) {
    try {
      const UdpPort opened(host, port);
    } catch (const driver::LinkError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const UdpPort first("127.0.0.1", 0);
  const std::string text = first.address().text();
  const auto number = static_cast<std::uint16_t>(std::stoul(text.substr(text.find(':') + 1)));
  EXPECT_EQ(why("127.0.0.1", number),
            fmt::format("UDP port {} is in use: end what listens there, or choose another", number));
  EXPECT_EQ(why("192.0.2.1", 0), "\"192.0.2.1\": no such address of this machine");
  EXPECT_EQ(why("", 0), "\"\": no such address of this machine");
}

}  // namespace
}  // namespace trammel::hm2
