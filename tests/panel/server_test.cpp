#include "trammel/panel/server.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bench.hpp"

namespace trammel::panel {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(Token, IsFoundWholeOrNotAtAll) {
  EXPECT_TRUE(has_token("/?token=abc", "abc"));
  EXPECT_TRUE(has_token("/socket?x=1&token=abc", "abc"));
  for (const char* target : {"/", "/?", "/?token=", "/?token=ab", "/?token=abcd", "/?token=abcabc", "/?token=abd",
                             "/token=abc", "/?tokens=abc", "/?xtoken=abc", "/?token=x&token=abc", "/?token=ABC"}) {
    EXPECT_FALSE(has_token(target, "abc")) << target;
  }
  EXPECT_FALSE(has_token("/?token=", ""));
}

class Served : public testing::Test {
 protected:
  Served() {
    ServerSettings settings;
    settings.token = "right";
    settings.page = "<p>the page</p>";
    server_ = std::make_unique<PanelServer>(settings, bench_.session);
    const std::string url = server_->url();
    port_ = std::stoi(url.substr(url.rfind(':') + 1));
  }
  // The complete answer to a request.
  std::string ask(const std::string& head) {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::send(socket, head.data(), head.size(), 0), static_cast<ssize_t>(head.size()));
    std::string answer;
    char bytes[4096];
    for (unsigned n = 0; n < 200 && answer.find("\r\n\r\n") == std::string::npos; ++n) {
      server_->turn();
      const ssize_t count = ::recv(socket, bytes, sizeof bytes, MSG_DONTWAIT);
      if (count > 0) answer.append(bytes, static_cast<std::size_t>(count));
      if (count == 0) break;
      ::usleep(1000);
    }
    ::close(socket);
    return answer;
  }
  std::string get(const std::string& target) { return ask("GET " + target + " HTTP/1.1\r\nHost: x\r\n\r\n"); }

  Bench bench_;
  std::unique_ptr<PanelServer> server_;
  int port_ = 0;
};

constexpr const char* kUpgrade =
    " HTTP/1.1\r\nHost: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n";

TEST_F(Served, GivesThePageForItsTokenAlone) {
  EXPECT_THAT(server_->url(), HasSubstr("/?token=right"));
  EXPECT_THAT(get("/?token=right"), testing::AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("the page")));
  for (const char* target : {"/", "/?token=wrong", "/program", "/program?token=righ", "/socket", "/nothing"}) {
    EXPECT_THAT(get(target), testing::AllOf(StartsWith("HTTP/1.1 403"), testing::Not(HasSubstr("the page"))));
  }
  EXPECT_THAT(get("/nothing?token=right"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(ask("POST /?token=right HTTP/1.1\r\nHost: x\r\n\r\n"), StartsWith("HTTP/1.1 405"));
}

TEST_F(Served, ASocketNeedsTheToken) {
  EXPECT_THAT(ask(std::string("GET /socket?token=wrong") + kUpgrade), StartsWith("HTTP/1.1 403"));
  EXPECT_FALSE(server_->has_page());
  EXPECT_THAT(ask(std::string("GET /socket?token=right") + kUpgrade), StartsWith("HTTP/1.1 101"));
  EXPECT_TRUE(server_->has_page());
  for (unsigned n = 0; n < 200 && server_->has_page(); ++n) {
    server_->turn();
    ::usleep(1000);
  }
  EXPECT_FALSE(server_->has_page()) << "a page that has gone";
}

TEST_F(Served, GivesTheProgram) {
  bench_.load("G1 X5 F600\n");
  EXPECT_THAT(get("/program?token=right"), HasSubstr("G1 X5 F600"));
}

}  // namespace
}  // namespace trammel::panel
