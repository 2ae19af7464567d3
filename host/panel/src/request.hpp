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
  std::int64_t clock = 0;  // session time in ms of the last state that the page had received when it sent this
  std::uint64_t id = 0;    // number of the jog
  std::size_t axis = 0;    // axis of the machine
  int way = 0;
  double step = 0;     // mm or degrees
  double percent = 0;  // percent of the axis's max_velocity
  int change = 0;      // change of an override, percent
  bool hold = true;
  std::string text;

  // None if the message is not an object with "do", or has a value of a wrong type.
  static std::optional<Request> parse(std::string_view message);
};

}  // namespace trammel::panel
