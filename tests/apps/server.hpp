// A running `trammel serve`.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <string>

#include "command.hpp"

namespace trammel::test {

class Server {
 public:
  Server(const Command& command, const std::string& options)
      : command_(command), running_(command, "serve --token secret " + options, "serve.err", "serve.out") {
    EXPECT_TRUE(eventually([this] { return told("token secret"); })) << errors();
    const std::string out = contents(command_.path("serve.out"));
    url_ = out.substr(5, out.find('\n') - 5);
  }

  // URL of the card; the first is for reading, the second has the token and may move the card.
  const std::string& url() const { return url_; }
  std::string moving() const { return "'" + url_ + "?token=secret'"; }
  std::string errors() const { return contents(command_.path("serve.err")); }
  bool said(const std::string& text) const { return errors().find(text) != std::string::npos; }
  void signal(int number) const { running_.signal(number); }
  // Ends the server by SIGTERM. Returns its standard error.
  std::string end() {
    running_.signal(SIGTERM);
    const std::optional<int> status = running_.wait();
    EXPECT_TRUE(status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0) << errors();
    return errors();
  }
  // Waits until the server ends by itself. Returns its standard error.
  std::string wait() {
    EXPECT_TRUE(running_.wait()) << errors();
    return errors();
  }

 private:
  bool told(const char* text) const { return contents(command_.path("serve.out")).find(text) != std::string::npos; }

  const Command& command_;
  Running running_;
  std::string url_;
};

}  // namespace trammel::test
