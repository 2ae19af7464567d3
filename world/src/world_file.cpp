#include "trammel/world/world_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "table.hpp"
#include "text_file.hpp"
#include "trammel/world/world.hpp"
#include "world_entries.hpp"

namespace trammel::world {

namespace {

// Refuses texts whose nesting would exhaust the stack of the recursive parser.
void refuse_depth(const std::string& text, const std::string& name) {
  constexpr std::ptrdiff_t kMost = 2000;
  const auto count = [&](char c) { return std::count(text.begin(), text.end(), c); };
  if (count('[') + count('{') > kMost || count('.') > 2 * kMost) {
    refuse_at(name, 1, fmt::format("more than {} brackets, or {} dots: no world file", kMost, 2 * kMost));
  }
}

toml::value parse_toml(const std::string& text, const std::string& name) {
  if (text.size() > kLongestWorldText) refuse_at(name, 1, fmt::format("longer than {} bytes", kLongestWorldText));
  refuse_depth(text, name);
  std::istringstream stream(text);
  try {
    return toml::parse(stream, name);
  } catch (const toml::syntax_error& error) {
    // The message has several lines; the first one contains the reason.
    const std::string what = error.what();
    const std::string first = what.substr(0, what.find('\n'));
    const auto colon = first.rfind(": ");
    refuse_at(name, error.location().line(),
              "not TOML: " + (colon == std::string::npos ? first : first.substr(colon + 2)));
  } catch (const std::exception& error) {
    refuse_at(name, 1, std::string("not TOML: ") + error.what());
  }
}

// Makes a World to find errors that concern several parts of the file.
void check_whole(const Reading& reading, const std::string& name) {
  constexpr std::uint32_t kAnyClock = 1'000'000;
  try {
    const World world(reading.world, kAnyClock);
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    const std::string part = what.substr(0, what.find(':'));
    const auto found = std::find_if(reading.lines.begin(), reading.lines.end(),
                                    [&](const auto& place) { return place.first == part; });
    refuse_at(name, found == reading.lines.end() ? 1 : found->second, what);
  }
}

}  // namespace

Description parse_world(const std::string& toml_text, const std::string& name) {
  const toml::value document = parse_toml(toml_text, name);
  Table root(name, "", document);
  Reading reading;
  reading.world.seed = root.whole("seed", INT64_MAX, 1);
  reading.world.closed_level = root.whole("closed_level", 1, 0) == 1;
  read_axes(root, reading);
  for (Table& table : root.tables("switch")) read_switch(table, reading);
  for (Table& table : root.tables("button")) read_button(table, reading);
  read_events(root, reading);
  root.refuse_other_keys();
  check_whole(reading, name);
  return reading.world;
}

Description load_world(const std::string& path) { return parse_world(text_of_file(path, "world"), path); }

Description default_world() { return parse_world(default_world_text(), "default world"); }

}  // namespace trammel::world
