// A running `trammel grbl`, and a sender that is connected to it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "command.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/transport/byte_stream.hpp"

namespace trammel::test {

using namespace std::chrono_literals;

class GrblServer {
 public:
  GrblServer(const Command& command, const std::string& options)
      : command_(command), running_(command, "grbl --listen 127.0.0.1:0 " + options, "grbl.err", "grbl.out") {
    EXPECT_TRUE(eventually([this] { return contents(command_.path("grbl.out")).find('\n') != std::string::npos; }))
        << errors();
    const std::string out = contents(command_.path("grbl.out"));
    port_ = static_cast<std::uint16_t>(std::stoul(out.substr(out.rfind(':') + 1)));
  }

  std::uint16_t port() const { return port_; }
  std::string errors() const { return contents(command_.path("grbl.err")); }
  // Ends the server. Returns its standard error.
  std::string end() {
    running_.signal(SIGTERM);
    const std::optional<int> status = running_.wait();
    EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0) << errors();
    return errors();
  }

 private:
  const Command& command_;
  Running running_;
  std::uint16_t port_ = 0;
};

// The number of steps and the identity in a line such as "path: 10 steps, of axes and directions 0123456789abcdef".
inline std::string path_of(const std::string& said) {
  const std::size_t count = said.rfind("path: ");
  const std::size_t order = said.rfind("of axes and directions ");
  if (count == std::string::npos || order == std::string::npos) return "no path in: " + said;
  return said.substr(count, said.find(' ', count + 6) - count) + " " + said.substr(order, 39);
}

class Sender {
 public:
  explicit Sender(const GrblServer& server, bool awaits_banner = true)
      : stream_(transport::connect_tcp("127.0.0.1", server.port(), 5s)) {
    if (awaits_banner) {
      EXPECT_EQ(until("Grbl "), "Grbl 1.1h ['$' for help]");
    }
  }

  void put(const std::string& bytes) {
    stream_->write(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  // The next line that is not empty; "" after `longest`.
  std::string line(std::chrono::milliseconds longest = 20s) {
    const auto end = std::chrono::steady_clock::now() + longest;
    for (;;) {
      const std::size_t at = came_.find("\r\n");
      if (at != std::string::npos) {
        const std::string line = came_.substr(0, at);
        came_.erase(0, at + 2);
        if (!line.empty()) return line;
        continue;
      }
      if (std::chrono::steady_clock::now() >= end) return "";
      std::uint8_t bytes[4096];
      const std::size_t count = stream_->read(bytes, sizeof bytes, 10ms);
      came_.append(bytes, bytes + count);
    }
  }
  // Reads lines until one starts with `begin`.
  std::string until(const std::string& begin, std::chrono::milliseconds longest = 20s) {
    const auto end = std::chrono::steady_clock::now() + longest;
    while (std::chrono::steady_clock::now() < end) {
      const std::string next = line(longest);
      if (next.rfind(begin, 0) == 0) return next;
    }
    return "no line " + begin;
  }
  // Sends a line. Returns its answer: ok, error or alarm.
  std::string ask(const std::string& text) {
    put(text + "\n");
    for (;;) {
      const std::string next = line();
      if (next.empty() || next == "ok" || next.rfind("error:", 0) == 0 || next.rfind("ALARM:", 0) == 0) return next;
      told_.push_back(next);
    }
  }
  // Lines that came before the answers to ask() so far.
  const std::vector<std::string>& told() const { return told_; }
  std::string report() {
    put("?");
    return until("<");
  }
  std::string state() {
    const std::string text = report();
    return text.substr(1, text.find('|') - 1);
  }
  // Machine coordinates "x,y,z".
  std::string place() {
    const std::string text = report();
    const std::size_t at = text.find("MPos:") + 5;
    return text.substr(at, text.find('|', at) - at);
  }
  double axis(unsigned n) {
    std::string text = place();
    for (; n != 0; --n) text.erase(0, text.find(',') + 1);
    return std::stod(text);
  }
  // Waits at most 30 s for a state. Returns whether it came.
  bool await_state(const std::string& wanted) {
    return eventually([&] {
      if (state() == wanted) return true;
      std::this_thread::sleep_for(20ms);
      return false;
    });
  }

  // Sends lines as senders do: counts the bytes that wait (126 at most), or sends a line after each answer. Returns the
  // answers other than ok.
  std::vector<std::string> stream(const std::vector<std::string>& lines, std::size_t window,
                                  std::chrono::milliseconds pause = 0ms) {
    std::vector<std::string> wrong;
    std::deque<std::size_t> waiting;
    std::size_t bytes = 0;
    const auto answer = [&] {
      const std::string next = line();
      if (next.empty()) throw std::runtime_error("no answer");
      const bool is_answer = next == "ok" || next.rfind("error:", 0) == 0 || next.rfind("ALARM:", 0) == 0;
      if (!is_answer) return;
      if (next != "ok") wrong.push_back(next);
      bytes -= waiting.front();
      waiting.pop_front();
    };
    for (const std::string& text : lines) {
      while (!waiting.empty() && bytes + text.size() + 1 > window) answer();
      if (pause != 0ms) std::this_thread::sleep_for(pause);
      put(text + "\n");
      waiting.push_back(text.size() + 1);
      bytes += text.size() + 1;
    }
    while (!waiting.empty()) answer();
    return wrong;
  }

 private:
  std::unique_ptr<transport::ByteStream> stream_;
  std::string came_;
  std::vector<std::string> told_;
};

}  // namespace trammel::test
