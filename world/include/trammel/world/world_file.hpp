// World files: a Description as TOML; examples/world.toml is the commented default, docs/user/world.md its page. Pure
// functions, but for those that read a file; thread-safe.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "trammel/world/description.hpp"

namespace trammel::world {

// Message, one line: "file:line: what is wrong, and what would be right".
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::size_t kLongestWorldText = 1 << 18;  // bytes

// Each throws WorldError for the first entry that is unknown, missing, out of range or against another one, and for
// what cannot be read or is longer than kLongestWorldText. A World can be made of what they return, at any clock.
Description load_world(const std::string& path);
Description parse_world(const std::string& toml_text, const std::string& name);

// A script, an event a line: "at 1.5 s press estop", "at 250 ms release estop", "at 3 s alarm X", "at 4 s clear X".
// Empty lines and what follows a '#' mean nothing. Throw WorldError, also for a button that `world` does not have.
std::vector<Event> load_events(const std::string& path, const Description& world);
std::vector<Event> parse_events(const std::string& text, const std::string& name, const Description& world);

// The text of examples/world.toml, and the world that it describes.
const std::string& default_world_text();
Description default_world();

}  // namespace trammel::world
