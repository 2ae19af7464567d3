#include "trammel/world/state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace trammel::world {

namespace {

constexpr const char* kRequestForm =
    "a request is `state`, `count`, `press NAME`, `release NAME`, `alarm X` or `clear X`, the last four with "
    "`when X > MM` or `when steps > N` behind it where it shall wait";

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  }
  return out + '"';
}

std::string axis_json(const World& world, std::size_t n) {
  const Carriage& carriage = world.carriage(n);
  const double scale = world.axis(n).pulses_a_mm;
  return fmt::format(
      R"({{"axis":"{}","carriage_mm":{:.4f},"commanded_mm":{:.4f},"carriage":{},"commanded":{},"lost":{},"powered":{}}})",
      world.axis(n).letter, carriage.position() / scale, static_cast<double>(carriage.commanded()) / scale,
      carriage.place(), carriage.commanded(), carriage.lost(), carriage.motor().powered());
}

std::string contact_json(const World::ContactState& contact) {
  return fmt::format(R"({{"name":{},"input":{},"pressed":{}}})", quoted(contact.name),
                     contact.input ? std::to_string(*contact.input) : "\"estop\"", contact.pressed);
}

std::vector<std::string> words_of_line(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::optional<std::size_t> axis_of(const std::string& word, const World& world) {
  for (std::size_t n = 0; word.size() == 1 && n < world.axes(); ++n) {
    if (std::toupper(static_cast<unsigned char>(word[0])) == world.axis(n).letter) return n;
  }
  return std::nullopt;
}

// Parses "X > 40" or "steps > 2000".
Request::Condition parse_condition(const std::vector<std::string>& words, const World& world) {
  Request::Condition condition;
  if (words.size() != 3 || (words[1] != ">" && words[1] != "<")) throw std::invalid_argument(kRequestForm);
  condition.axis = axis_of(words[0], world);
  if (!condition.axis && words[0] != "steps") {
    throw std::invalid_argument(fmt::format("{}: the world has no such axis: {}", words[0], kRequestForm));
  }
  condition.above = words[1] == ">";
  const char* const end = words[2].data() + words[2].size();
  const auto [rest, error] = std::from_chars(words[2].data(), end, condition.bound);
  if (error != std::errc() || rest != end || !std::isfinite(condition.bound)) {
    throw std::invalid_argument(fmt::format("{}: is no number: {}", words[2], kRequestForm));
  }
  return condition;
}

// The JSON of all switches and buttons, and the names of the pressed ones.
struct Lists {
  std::vector<std::string> switches;
  std::vector<std::string> buttons;
  std::vector<std::string> pressed;
};

Lists lists_of(const World& world) {
  Lists lists;
  for (const World::ContactState& contact : world.contacts()) {
    (contact.is_button ? lists.buttons : lists.switches).push_back(contact_json(contact));
    if (contact.pressed) lists.pressed.push_back(quoted(contact.name));
  }
  return lists;
}

}  // namespace

std::string state_json(const World& world, const PathCount& path) {
  std::vector<std::string> axes;
  for (std::size_t n = 0; n < world.axes(); ++n) axes.push_back(axis_json(world, n));
  const Lists lists = lists_of(world);
  return fmt::format(R"({{"time_s":{:.6f},"axes":[{}],"switches":[{}],"buttons":[{}],"pressed":[{}],"inputs":{},)"
                     R"("emergency_stop":{},"path":{{"steps":{},"identity":{}}}}})",
                     static_cast<double>(world.now()) / world.clock_hz(), fmt::join(axes, ","),
                     fmt::join(lists.switches, ","), fmt::join(lists.buttons, ","), fmt::join(lists.pressed, ","),
                     world.levels(), world.emergency_stop(), path.steps, quoted(path.identity));
}

Request parse_request(const std::string& line, const World& world) {
  const std::vector<std::string> words = words_of_line(line);
  Request request;
  if (words.size() == 1 && words[0] == "state") return request;
  request.kind = Request::Kind::kCount;
  if (words.size() == 1 && words[0] == "count") return request;
  const std::string verb = words.empty() ? "" : words[0];
  const bool alarm = verb == "alarm" || verb == "clear";
  const bool press = verb == "press" || verb == "alarm";
  if (words.size() < 2 || (!press && verb != "release" && verb != "clear")) throw std::invalid_argument(kRequestForm);
  request.kind = press ? Request::Kind::kPress : Request::Kind::kRelease;
  request.button = alarm && words[1].size() == 1 ? alarm_name(words[1][0]) : words[1];
  world.require_button(request.button);
  if (words.size() == 2) return request;
  if (words[2] != "when") throw std::invalid_argument(kRequestForm);
  request.when = parse_condition({words.begin() + 3, words.end()}, world);
  return request;
}

bool holds(const Request::Condition& condition, const World& world, std::uint64_t steps) {
  const double now = condition.axis
                         ? world.carriage(*condition.axis).position() / world.axis(*condition.axis).pulses_a_mm
                         : static_cast<double>(steps);
  return condition.above ? now > condition.bound : now < condition.bound;
}

}  // namespace trammel::world
