#include "trammel/machine/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <toml.hpp>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::machine {
namespace {

// What an entry's number must be.
enum class Range { kAny, kNotNegative, kPositive };

struct Entry {
  const char* name;
  double MachineAxis::*member;
  Range range;
  bool required;
};

constexpr std::array<Entry, 9> kEntries = {{
    {"steps_per_mm", &MachineAxis::steps_per_mm, Range::kPositive, true},
    {"max_velocity", &MachineAxis::max_velocity, Range::kPositive, true},
    {"max_acceleration", &MachineAxis::max_acceleration, Range::kPositive, true},
    {"max_jerk", &MachineAxis::max_jerk, Range::kPositive, true},
    {"step_length_ns", &MachineAxis::step_length_ns, Range::kPositive, true},
    {"step_space_ns", &MachineAxis::step_space_ns, Range::kPositive, true},
    {"direction_setup_ns", &MachineAxis::direction_setup_ns, Range::kNotNegative, true},
    {"direction_hold_ns", &MachineAxis::direction_hold_ns, Range::kNotNegative, true},
    {"home", &MachineAxis::home, Range::kAny, false},
}};

// Where a text came from, for messages: a file (with line numbers), or one override.
struct Source {
  std::string name;
  bool has_lines;

  std::string at(const toml::value& value) const {
    return has_lines ? fmt::format("{}:{}: ", name, value.location().line()) : name + ": ";
  }
};

double number(const Source& source, const std::string& path, const toml::value& value, Range range) {
  double result = 0;
  if (value.is_integer()) {
    result = static_cast<double>(value.as_integer());
  } else if (value.is_floating()) {
    result = value.as_floating();
  } else {
    throw MachineError(source.at(value) + path + " must be a number");
  }
  if (!std::isfinite(result)) {
    throw MachineError(source.at(value) + path + " must be a finite number");
  }
  if (range == Range::kPositive && result <= 0) {
    throw MachineError(fmt::format("{}{} must be greater than 0, not {}", source.at(value), path, result));
  }
  if (range == Range::kNotNegative && result < 0) {
    throw MachineError(fmt::format("{}{} must not be negative, not {}", source.at(value), path, result));
  }
  return result;
}

// "g54" .. "g59" to 0 .. 5.
std::optional<std::size_t> coordinate_system(const std::string& key) {
  if (key.size() != 3 || key[0] != 'g' || key[1] != '5' || key[2] < '4' || key[2] > '9') {
    return std::nullopt;
  }
  return static_cast<std::size_t>(key[2] - '4');
}

void set_axis_entry(const Source& source, MachineAxis& axis, const std::string& path, const std::string& key,
                    const toml::value& value) {
  if (key == "inverted") {
    if (!value.is_boolean()) {
      throw MachineError(source.at(value) + path + " must be true or false");
    }
    axis.inverted = value.as_boolean();
    return;
  }
  if (const auto system = coordinate_system(key)) {
    axis.offsets[*system] = number(source, path, value, Range::kAny);
    return;
  }
  for (const Entry& entry : kEntries) {
    if (key == entry.name) {
      axis.*entry.member = number(source, path, value, entry.range);
      return;
    }
  }
  throw MachineError(source.at(value) + "unknown entry " + path);
}

void set_clock(const Source& source, Machine& machine, const toml::value& value) {
  const double clock = number(source, "card.clock_hz", value, Range::kPositive);
  if (clock != std::floor(clock) || clock > std::numeric_limits<std::uint32_t>::max()) {
    throw MachineError(source.at(value) + "card.clock_hz must be a whole number below 2^32");
  }
  machine.clock_hz = static_cast<std::uint32_t>(clock);
}

const toml::table& table_of(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_table()) {
    throw MachineError(source.at(value) + path + " must be a table");
  }
  return value.as_table();
}

// The letter of a table [axis.x]; throws for any other name.
char axis_letter(const Source& source, const std::string& key, const toml::value& value) {
  const char letter = key.size() == 1 ? static_cast<char>(std::toupper(static_cast<unsigned char>(key[0]))) : ' ';
  if (kAxisLetters.find(letter) == std::string_view::npos || key[0] == letter) {
    throw MachineError(fmt::format("{}unknown axis [axis.{}]: one of x y z a b c u v w e", source.at(value), key));
  }
  return letter;
}

// Fits the 16-bit registers at this clock?
void check_times(const std::string& where, const Machine& machine) {
  for (const MachineAxis& axis : machine.axes) {
    for (const double time :
         {axis.step_length_ns, axis.step_space_ns, axis.direction_setup_ns, axis.direction_hold_ns}) {
      try {
        clocks_from_ns(time, machine.clock_hz);
      } catch (const std::out_of_range& error) {
        throw MachineError(fmt::format("{}: axis {}: {}", where, axis.letter, error.what()));
      }
    }
  }
}

MachineAxis read_axis(const Source& source, const std::string& name, const toml::value& value) {
  MachineAxis axis;
  const std::string path = "axis." + name;
  const toml::table& table = table_of(source, path, value);
  axis.letter = axis_letter(source, name, value);
  for (const auto& [key, entry] : table) {
    set_axis_entry(source, axis, path + "." + key, key, entry);
  }
  for (const Entry& entry : kEntries) {
    if (entry.required && table.count(entry.name) == 0) {
      throw MachineError(fmt::format("{}[{}] has no {}", source.at(value), path, entry.name));
    }
  }
  if (table.count("inverted") == 0) {
    throw MachineError(fmt::format("{}[{}] has no inverted", source.at(value), path));
  }
  return axis;
}

// toml11's messages are several lines; the first says what, the location says where.
toml::value parse(const Source& source, const std::string& text) {
  std::istringstream stream(text);
  try {
    return toml::parse(stream, source.name);
  } catch (const toml::syntax_error& error) {
    std::string what = error.what();
    what = what.substr(0, what.find('\n'));
    if (const auto colon = what.rfind(": "); colon != std::string::npos) {
      what = what.substr(colon + 2);
    }
    const std::string where =
        source.has_lines ? fmt::format("{}:{}: ", source.name, error.location().line()) : source.name + ": ";
    throw MachineError(where + "not TOML: " + what);
  }
}

void check_top_level(const Source& source, const toml::table& root) {
  for (const auto& [key, value] : root) {
    if (key != "card" && key != "axis") {
      throw MachineError(source.at(value) + "unknown entry " + key);
    }
    for (const auto& [inner_key, inner] : table_of(source, key, value)) {
      if (key == "card" && inner_key != "clock_hz") {
        throw MachineError(source.at(inner) + "unknown entry card." + inner_key);
      }
    }
  }
}

std::size_t card_order(char letter) { return kAxisLetters.find(letter); }

}  // namespace

std::optional<std::size_t> Machine::axis(char letter) const {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].letter == letter) {
      return i;
    }
  }
  return std::nullopt;
}

std::uint16_t clocks_from_ns(double nanoseconds, std::uint32_t clock_hz) {
  // 1 ns at 4 GHz is 4 clocks: the slack of 1e-6 clock takes the rounding of the product, never a clock.
  const double clocks = std::ceil(nanoseconds * clock_hz / 1e9 - 1e-6);
  if (clocks > std::numeric_limits<std::uint16_t>::max()) {
    throw std::out_of_range(fmt::format("{} ns at {} Hz are more than the card's 65535 clocks", nanoseconds, clock_hz));
  }
  const double least = nanoseconds > 0 ? 1 : 0;
  return static_cast<std::uint16_t>(std::max(clocks, least));
}

Machine parse_machine(const std::string& toml_text, const std::string& name) {
  const Source source{name, true};
  const toml::value document = parse(source, toml_text);
  const toml::table& root = document.as_table();
  check_top_level(source, root);
  if (root.count("card") == 0 || root.at("card").as_table().count("clock_hz") == 0) {
    throw MachineError(name + ":1: no [card] clock_hz");
  }
  if (root.count("axis") == 0 || root.at("axis").as_table().empty()) {
    throw MachineError(name + ":1: no axis: at least one table [axis.<letter>]");
  }
  Machine machine;
  set_clock(source, machine, root.at("card").as_table().at("clock_hz"));
  for (const auto& [key, value] : root.at("axis").as_table()) {
    machine.axes.push_back(read_axis(source, key, value));
  }
  if (machine.axes.size() > card_map::kMaxAxes) {
    throw MachineError(
        fmt::format("{}:1: {} axes, the card has at most {}", name, machine.axes.size(), card_map::kMaxAxes));
  }
  std::sort(machine.axes.begin(), machine.axes.end(),
            [](const MachineAxis& a, const MachineAxis& b) { return card_order(a.letter) < card_order(b.letter); });
  check_times(name + ":1", machine);
  return machine;
}

Machine load_machine(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file || file.bad()) {
    throw MachineError(path + ": cannot read the machine file");
  }
  return parse_machine(text, path);
}

void apply_override(Machine& machine, const std::string& text) {
  const Source source{"--set " + text, false};
  Machine changed = machine;
  const toml::value document = parse(source, text);
  const toml::table& root = document.as_table();
  check_top_level(source, root);
  if (root.empty()) {
    throw MachineError(source.name + ": not an assignment such as axis.x.steps_per_mm=20");
  }
  if (root.count("card") != 0) {
    set_clock(source, changed, root.at("card").as_table().at("clock_hz"));
  }
  if (root.count("axis") != 0) {
    for (const auto& [name, value] : root.at("axis").as_table()) {
      const std::string path = "axis." + name;
      const toml::table& table = table_of(source, path, value);
      const auto index = changed.axis(axis_letter(source, name, value));
      if (!index) {
        throw MachineError(fmt::format("{}: the machine has no axis {}", source.name, name));
      }
      for (const auto& [key, entry] : table) {
        set_axis_entry(source, changed.axes[*index], path + "." + key, key, entry);
      }
    }
  }
  check_times(source.name, changed);
  machine = changed;
}

}  // namespace trammel::machine
