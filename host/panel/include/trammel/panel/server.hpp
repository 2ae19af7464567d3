// HTTP and WebSocket for one page at a time, by Boost.Beast. Used by one thread: turn() processes received and due data
// without waiting.
//   GET /?token=T         the page
//   GET /program?token=T  text of the program that the session has
//   GET /socket?token=T   WebSocket: messages of the page, states of the session
// A request without the token gets 403. A new page replaces the previous one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "trammel/panel/session.hpp"

namespace trammel::panel {

struct ServerSettings {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;  // 0: any free port
  std::string token;       // letters, digits, '-', '_'
  std::string_view page;
};

class PanelServer {
 public:
  // `session` must outlive the server. Throws std::runtime_error if the address is not available.
  PanelServer(const ServerSettings& settings, PanelSession& session);
  ~PanelServer();
  PanelServer(const PanelServer&) = delete;
  PanelServer& operator=(const PanelServer&) = delete;

  void turn();
  // The page's address, with the token.
  std::string url() const;
  bool has_page() const;

 private:
  class Shared;
  class Exchange;
  class PageLink;
  std::unique_ptr<Shared> shared_;
};

// Whether `target` of a request contains token=`token`. The duration of the comparison does not depend on how much of
// the token agrees.
bool has_token(std::string_view target, std::string_view token);

}  // namespace trammel::panel
