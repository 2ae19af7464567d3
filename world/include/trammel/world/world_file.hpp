// World files: a Description as TOML. examples/world.toml is the default, with comments; docs/user/world.md describes
// the format. Pure functions, except those that read a file; thread-safe.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/world/description.hpp"

namespace trammel::world {

// The message is one line: "file:line: what is wrong, and what would be right".
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::size_t kLongestWorldText = 1 << 18;  // bytes

// Each throws WorldError for the first entry that is unknown, missing, out of range or in conflict with another one,
// and for a file that cannot be read or is longer than kLongestWorldText. A World can be made of the result, at any
// clock frequency.
Description load_world(const std::string& path);
Description parse_world(const std::string& toml_text, const std::string& name);

// A script, one event per line: "at 1.5 s press estop", "at 250 ms release estop", "at 3 s alarm X", "at 4 s clear X".
// Empty lines, and text after a '#', are ignored. Both throw WorldError, also for a button that `world` does not have.
std::vector<Event> load_events(const std::string& path, const Description& world);
std::vector<Event> parse_events(const std::string& text, const std::string& name, const Description& world);

// The text of examples/world.toml, and the world that it describes.
const std::string& default_world_text();
Description default_world();

}  // namespace trammel::world
