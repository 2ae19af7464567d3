#include "events.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "table.hpp"
#include "text_file.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::world {

namespace {

constexpr const char* kForm =
    "an event is `at 1.5 s press NAME`, `at 1.5 s release NAME`, `at 1.5 s alarm X` or "
    "`at 1.5 s clear X`";
constexpr double kLongest = 1e9;  // s

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

void require_button(const std::string& name, const std::string& file, std::size_t line, const Description& world) {
  std::vector<std::string> names;
  for (const ButtonDescription& button : world.buttons) names.push_back(button.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  refuse_at(file, line,
            fmt::format("{}: the world has no such button: it has {}", name,
                        names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace

Event parse_event(const std::string& text, const std::string& file, std::size_t line, const Description& world) {
  const std::vector<std::string> words = words_of(text);
  if (words.size() != 5 || words[0] != "at") refuse_at(file, line, fmt::format("{}: {}", text, kForm));
  double time = 0;
  const char* const end = words[1].data() + words[1].size();
  const auto [rest, error] = std::from_chars(words[1].data(), end, time);
  if (error != std::errc() || rest != end || (words[2] != "s" && words[2] != "ms")) {
    refuse_at(file, line, fmt::format("{} {}: a time is a number and s or ms, as 1.5 s", words[1], words[2]));
  }
  const double seconds = words[2] == "ms" ? time / 1000 : time;
  if (!(seconds >= 0) || seconds > kLongest) {
    refuse_at(file, line, fmt::format("{} {}: a time is 0 s to {:g} s", words[1], words[2], kLongest));
  }
  Event event;
  event.nanoseconds = static_cast<std::uint64_t>(std::llround(seconds * 1e9));
  event.press = words[3] == "press" || words[3] == "alarm";
  const bool alarm = words[3] == "alarm" || words[3] == "clear";
  if (!event.press && words[3] != "release" && words[3] != "clear") {
    refuse_at(file, line, fmt::format("{}: {}", words[3], kForm));
  }
  event.button = alarm && words[4].size() == 1 ? alarm_name(words[4][0]) : words[4];
  require_button(event.button, file, line, world);
  return event;
}

std::vector<Event> parse_events(const std::string& text, const std::string& name, const Description& world) {
  std::vector<Event> events;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::string event = line.substr(0, line.find('#'));
    if (!words_of(event).empty()) events.push_back(parse_event(event, name, number, world));
  }
  return events;
}

std::vector<Event> load_events(const std::string& path, const Description& world) {
  return parse_events(text_of_file(path, "events"), path, world);
}

}  // namespace trammel::world
