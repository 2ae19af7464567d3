// What a world is like, and what one asks of it, as lines of text: for programs beside the one that moves the card
// (serve/, docs/user/world.md). Pure functions of a world that nobody changes meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "trammel/world/world.hpp"

namespace trammel::world {

// The path that the card has made since somebody began to count.
struct PathCount {
  std::uint64_t steps = 0;
  std::string identity;  // equal for equal lists of steps (run::PathIdentity); empty: nobody counts
};

// One line of JSON without an end: time_s, axes (each with axis, carriage_mm, commanded_mm, carriage, commanded, lost
// and powered), switches and buttons (each with name, input and pressed), pressed, inputs, emergency_stop, path. Places
// without a unit in their name are pulses. docs/user/world.md explains them.
std::string state_json(const World& world, const PathCount& path = {});

// A line of a client: "state", "count", "press NAME", "release NAME", "alarm X", "clear X". Behind each but "state" and
// "count" a condition may stand: "when X > 40" (mm of the carriage, as state_json() has it) or "when steps > 2000" (of
// the path); '<' as well.
struct Request {
  enum class Kind { kState, kCount, kPress, kRelease };
  struct Condition {
    std::optional<std::size_t> axis;  // of the world; none: steps of the path
    bool above = true;
    double bound = 0;  // mm or steps
  };
  Kind kind = Kind::kState;
  std::string button;  // of kPress and kRelease; it is there
  std::optional<Condition> when;
};

// Throws std::invalid_argument, with what is right, for a line that is no request, and for a name that `world` does not
// have.
Request parse_request(const std::string& line, const World& world);
bool holds(const Request::Condition& condition, const World& world, std::uint64_t steps);

}  // namespace trammel::world
