// The state of a world, and requests to it, as lines of text: for programs beside the one that moves the card (serve/,
// docs/user/world.md). Pure functions; no other thread may change the world during a call.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "trammel/world/world.hpp"

namespace trammel::world {

// The path that the card has made since the count was last restarted.
struct PathCount {
  std::uint64_t steps = 0;
  std::string identity;  // equal for equal lists of steps (run::PathIdentity); empty: not counted
};

// One line of JSON without a newline: time_s, axes (each with axis, carriage_mm, commanded_mm, carriage, commanded,
// lost and powered), switches and buttons (each with name, input and pressed), pressed, inputs, emergency_stop, path.
// Positions without a unit in their name are pulses. docs/user/world.md explains them.
std::string state_json(const World& world, const PathCount& path = {});

// A client's request: "state", "count", "press NAME", "release NAME", "alarm X", "clear X". All except "state" and
// "count" may be followed by a condition: "when X > 40" (mm of the carriage, as in state_json()) or "when steps > 2000"
// (of the path); '<' is possible too.
struct Request {
  enum class Kind { kState, kCount, kPress, kRelease };
  struct Condition {
    std::optional<std::size_t> axis;  // axis of the world; nullopt: steps of the path
    bool above = true;
    double bound = 0;  // mm or steps
  };
  Kind kind = Kind::kState;
  std::string button;  // button of kPress and kRelease; it exists
  std::optional<Condition> when;
};

// Throws std::invalid_argument, whose message shows the right form, for a line that is not a request, and for a name
// that `world` does not have.
Request parse_request(const std::string& line, const World& world);
bool holds(const Request::Condition& condition, const World& world, std::uint64_t steps);

}  // namespace trammel::world
