// HTTP and WebSocket for one page at a time, by Boost.Beast. One thread: turn() takes what has come and sends what is
// due, without waiting.
//   GET /?token=T         the page
//   GET /program?token=T  text of the program that the session has
//   GET /socket?token=T   WebSocket: messages of the page, states of the session
// A request without the token gets 403. The newest page takes the place of the one before.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "trammel/panel/session.hpp"

namespace trammel::panel {

struct ServerSettings {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;  // 0: one that is free
  std::string token;       // letters, digits, '-', '_'
  std::string_view page;
};

class PanelServer {
 public:
  // `session` must outlive it. Throws std::runtime_error where the address cannot be had.
  PanelServer(const ServerSettings& settings, PanelSession& session);
  ~PanelServer();
  PanelServer(const PanelServer&) = delete;
  PanelServer& operator=(const PanelServer&) = delete;

  void turn();
  // With the token.
  std::string url() const;
  bool has_page() const;

 private:
  class Shared;
  class Exchange;
  class PageLink;
  std::unique_ptr<Shared> shared_;
};

// Whether `target` of a request has token=`token`; in a time that does not tell how much of it agrees.
bool has_token(std::string_view target, std::string_view token);

}  // namespace trammel::panel
