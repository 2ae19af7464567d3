// `trammel run` on a served card, interrupted and resumed.
#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "command.hpp"
#include "server.hpp"

namespace trammel::test {

class ResumedRun : public ::testing::Test {
 protected:
  // Lines and arcs, about 3 s of motion.
  static std::string program() {
    std::string text = "F3000\n";
    for (int i = 1; i <= 60; ++i) {
      const std::string x = std::to_string(0.37 * i);
      const std::string y = std::to_string(i * 7 % 13 * 0.4);
      text += "G1 X" + x + " Y" + y + "\n";
      if (i % 10 == 0)
        text += "G2 X" + std::to_string(0.37 * i + 1) + " Y" + y + " R3 Z" + std::to_string(0.01 * i) + "\n";
    }
    return text + "G4 P0.05\nG0 X0 Y0 Z0\nM2\n";
  }
  std::string line(const std::string& options = "") const {
    return "run " + command_.path("p.ngc") + " " + options + " --set motion.watchdog=" + watchdog_ + " --card " +
           (card_.empty() ? server_.moving() : card_);
  }
  Outcome run(const std::string& options = "") const { return command_.run(line(options)); }
  Running start(const std::string& options = "") {
    ++started_;
    return Running(command_, line(options), said_in());
  }
  // Each client has its own file: a client that has just started may not have emptied an earlier file yet.
  std::string said_in() const { return "client" + std::to_string(started_) + ".err"; }
  bool shows(const std::string& text) const {
    return command_.run("monitor --looks 1 --card " + server_.url()).out.find(text) != std::string::npos;
  }
  // Waits until the client has moved the card for a while. For a resumed run this time counts from its message about
  // the line at which it begins.
  void let_move(int milliseconds, bool resumed) const {
    const auto moves = [&] {
      return resumed ? contents(command_.path(said_in())).find("the run begins at line") != std::string::npos
                     : shows("on a path");
    };
    EXPECT_TRUE(eventually(moves)) << contents(command_.path(said_in()));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  }
  void end(Running& client, int number, int milliseconds, bool resumed = false) {
    let_move(milliseconds, resumed);
    client.signal(number);
    client.wait();
    await_gone();
  }
  // Waits until the server has seen one more client disconnect.
  void await_gone() {
    const auto gone = [&] {
      std::size_t times = 0;
      const std::string said = server_.errors();
      for (std::size_t at = 0; (at = said.find("the card holds", at)) != std::string::npos; ++at) ++times;
      return times;
    };
    ++ended_;
    EXPECT_TRUE(eventually([&] { return gone() >= ended_; })) << server_.errors();
  }
  void interrupt() {
    Running client = start();
    end(client, SIGKILL, 300);
  }
  static void expect_refused(const Outcome& outcome, const std::string& message) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(message));
    EXPECT_EQ(outcome.out, "");
  }
  // Position after the card has come to rest.
  std::string position() const {
    std::string at;
    const auto stands = [&] {
      const std::string before = at;
      at = command_.run("position --card " + server_.url()).out;
      return at == before && at.find("the card moves") == std::string::npos;
    };
    EXPECT_TRUE(eventually(stands));
    return at;
  }
  // Number of steps and identity of the path on a server whose run is not interrupted.
  std::string undisturbed() const {
    const Command elsewhere;
    Server other(elsewhere, "--engine model --fast");
    EXPECT_EQ(elsewhere.run("run " + command_.path("p.ngc") + " --card " + other.moving()).status, 0);
    return path_of(other.end());
  }
  static std::string path_of(const std::string& said) {
    const std::size_t steps = said.find("path: ");
    const std::size_t path = said.find("numbers ");
    if (steps == std::string::npos || path == std::string::npos) return "nothing: " + said;
    return said.substr(steps, said.find(',', steps) - steps) + " " + said.substr(path, 24);
  }

  // Repeats the program so often that it lasts for all interruptions.
  void write_long_program() {
    std::string longer = "F3000\n";
    for (int i = 0; i < 5; ++i) longer += program().substr(0, program().size() - 3);
    command_.write("p.ngc", longer);
  }

  Command command_;
  std::string watchdog_ = "40";  // seconds
  std::string card_;             // empty: the server's URL
  Server server_{command_, "--engine model"};
  std::string program_ = command_.write("p.ngc", program());
  unsigned started_ = 0;
  std::size_t ended_ = 0;  // clients that moved the card and have disconnected
};

}  // namespace trammel::test
