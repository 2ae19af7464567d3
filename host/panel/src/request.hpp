// A message of the page.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "trammel/panel/session.hpp"

namespace trammel::panel {

struct PanelSession::Request {
  std::string what;
  std::int64_t clock = 0;  // the session's, ms, of the last state that the page had when it sent this
  std::uint64_t id = 0;    // of a jog
  std::size_t axis = 0;    // of the machine
  int way = 0;
  double step = 0;     // mm or degrees
  double percent = 0;  // of the axis's max_velocity
  int change = 0;      // of an override, percent
  bool hold = true;
  std::string text;

  // Nothing for what is no object with "do", or has a value of another type.
  static std::optional<Request> parse(std::string_view message);
};

}  // namespace trammel::panel
