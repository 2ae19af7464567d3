// Converts machine files from TOML to Machine.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <toml.hpp>

#include "entries.hpp"
#include "machine_checks.hpp"
#include "machine_homing.hpp"
#include "machine_inputs.hpp"
#include "machine_outputs.hpp"
#include "numbers.hpp"
#include "text.hpp"
#include "trammel/card_map.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

struct Entry {
  const char* name;
  double MachineAxis::*member;
  Range range;
  bool required;
};

constexpr std::array<Entry, 13> kEntries = {{
    {"steps_per_mm", &MachineAxis::steps_per_mm, kStepsPerMm, true},
    {"max_velocity", &MachineAxis::max_velocity, kSpeed, true},
    {"max_acceleration", &MachineAxis::max_acceleration, kAcceleration, true},
    {"max_jerk", &MachineAxis::max_jerk, kJerk, false},
    {"step_length_ns", &MachineAxis::step_length_ns, kPulseTime, true},
    {"step_space_ns", &MachineAxis::step_space_ns, kPulseTime, true},
    {"direction_setup_ns", &MachineAxis::direction_setup_ns, kDirectionTime, true},
    {"direction_hold_ns", &MachineAxis::direction_hold_ns, kDirectionTime, true},
    {"min", &MachineAxis::min, kPlace, false},
    {"max", &MachineAxis::max, kPlace, false},
    {"overtravel", &MachineAxis::overtravel, kOvertravel, false},
    {"home", &MachineAxis::home, kPlace, false},
    {"second_home", &MachineAxis::second_home, kPlace, false},
}};
constexpr const char* kInverted = "inverted";

struct Switch {
  const char* name;
  bool MachineAxis::*member;
};
constexpr std::array<Switch, 5> kSwitches = {{
    {kInverted, &MachineAxis::inverted},
    {"second_motor", &MachineAxis::second_motor},
    {"second_inverted", &MachineAxis::second_inverted},
    {"keeps_place", &MachineAxis::keeps_place},
    {"endless", &MachineAxis::endless},
}};

// An entry of the table [motion].
struct MotionEntry {
  const char* name;
  double MotionSettings::*member;
  double least;
  double most;
  bool whole;
};

constexpr std::array<MotionEntry, 6> kMotionEntries = {{
    {"junction_deviation", &MotionSettings::junction_deviation, 0, 1000, false},
    {"max_override", &MotionSettings::max_override, 1, 2, false},
    {"hold_reserve", &MotionSettings::hold_reserve, 0, 0.9, false},
    {"window", &MotionSettings::window, 2, 1 << 20, true},
    {"watchdog", &MotionSettings::watchdog, 0, 40, false},
    {"stale_periods", &MotionSettings::stale_periods, 0, 65535, true},
}};

// A bare key of TOML cannot contain a point: G59.1 is g59_1.
constexpr std::array<const char*, kCoordinateSystems> kSystems = {"g54", "g55",   "g56",   "g57",  "g58",
                                                                  "g59", "g59_1", "g59_2", "g59_3"};

std::optional<std::size_t> coordinate_system(const std::string& key) {
  const auto found = std::find(kSystems.begin(), kSystems.end(), key);
  if (found == kSystems.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kSystems.begin());
}

std::vector<std::string> axis_entries() {
  std::vector<std::string> names = {kInverted};
  for (const Entry& entry : kEntries) {
    names.emplace_back(entry.name);
  }
  for (std::size_t i = 1; i < kSwitches.size(); ++i) {
    names.emplace_back(kSwitches[i].name);
  }
  names.insert(names.end(), kSystems.begin(), kSystems.end());
  return names;
}

void set_axis_entry(const Source& source, MachineAxis& axis, const std::string& table, const std::string& key,
                    const toml::value& value) {
  const std::string path = table + key;
  for (const Switch& entry : kSwitches) {
    if (key == entry.name) {
      axis.*entry.member = true_or_false(source, path, value);
      return;
    }
  }
  if (const auto system = coordinate_system(key)) {
    axis.offsets[*system] = number(source, path, value, kPlace);
    return;
  }
  for (const Entry& entry : kEntries) {
    if (key == entry.name) {
      axis.*entry.member = number(source, path, value, entry.range);
      return;
    }
  }
  refuse_key(source, value, table, key, axis_entries());
}

// Sets the entries of one table [axis.x]. `place`: reported for an error that concerns several entries.
void set_axis(const Source& source, MachineAxis& axis, const std::string& name, const toml::table& table,
              const toml::value& place) {
  const std::string path = "axis." + name + ".";
  for (const auto& [key, entry] : table) {
    set_axis_entry(source, axis, path, key, entry);
  }
  if (!(axis.min < axis.max)) {
    const toml::value& wrong = table.count("min") != 0 ? table.at("min") : place;
    refuse(fmt::format("{}{}min must be less than {}max: {} and {}", source.at(wrong), path, path, axis.min, axis.max));
  }
}

std::vector<std::string> motion_entries() {
  std::vector<std::string> names;
  for (const MotionEntry& entry : kMotionEntries) names.emplace_back(entry.name);
  return names;
}

void set_motion(const Source& source, MotionSettings& motion, const toml::table& table) {
  for (const auto& [key, value] : table) {
    const auto entry = std::find_if(kMotionEntries.begin(), kMotionEntries.end(),
                                    [&key = key](const MotionEntry& known) { return key == known.name; });
    if (entry == kMotionEntries.end()) refuse_key(source, value, "motion.", key, motion_entries());
    const double given = number(source, "motion." + key, value);
    if (given < entry->least || given > entry->most || (entry->whole && given != std::floor(given))) {
      refuse(fmt::format("{}motion.{} must be {}from {} to {}, not {}", source.at(value), key,
                         entry->whole ? "a whole number " : "", entry->least, entry->most, given));
    }
    motion.*entry->member = given;
  }
}

void set_kinematics(const Source& source, MachineKinematics& kinematics, const toml::table& table) {
  struct MotorEntry {
    std::string_view name;
    double JointLimits::*member;
    Range range;
  };
  static constexpr std::array<MotorEntry, 3> kMotorEntries{
      {{"motor_velocity", &JointLimits::velocity, kSpeed},
       {"motor_acceleration", &JointLimits::acceleration, kAcceleration},
       {"motor_jerk", &JointLimits::jerk, kJerk}}};
  for (const auto& [key, value] : table) {
    const std::string path = "kinematics." + key;
    const auto* const motor = std::find_if(kMotorEntries.begin(), kMotorEntries.end(),
                                           [&key = key](const MotorEntry& known) { return key == known.name; });
    if (motor != kMotorEntries.end()) {
      kinematics.motor.*motor->member = number(source, path, value, motor->range);
    } else if (key == "name") {
      const bool known = value.is_string() && std::find(kKinematics.begin(), kKinematics.end(),
                                                        std::string_view(value.as_string().str)) != kKinematics.end();
      if (!known) refuse(fmt::format("{}{} must be one of {}", source.at(value), path, fmt::join(kKinematics, ", ")));
      kinematics.name = value.as_string().str;
    } else {
      refuse_key(source, value, "kinematics.", key, {"name", "motor_velocity", "motor_acceleration", "motor_jerk"});
    }
  }
}

void set_probe(const Source& source, Probe& probe, const toml::table& table) {
  for (const auto& [key, value] : table) {
    if (key == "input") {
      if (!value.is_integer() || value.as_integer() < 0 || value.as_integer() >= kMaxInputs) {
        refuse(fmt::format("{}probe.input must be an input's number, 0 to {}", source.at(value), kMaxInputs - 1));
      }
      probe.input = static_cast<unsigned>(value.as_integer());
    } else if (key == "touched_level") {
      if (!value.is_integer() || (value.as_integer() != 0 && value.as_integer() != 1)) {
        refuse(source.at(value) + "probe.touched_level must be 0 or 1");
      }
      probe.touched_level = value.as_integer() == 1;
    } else {
      refuse_key(source, value, "probe.", key, {"input", "touched_level"});
    }
  }
}

unsigned tool_number(const Source& source, const std::string& key, const toml::value& value) {
  unsigned number = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
  if (error != std::errc{} || end != key.data() + key.size() || number == 0 || number > kLargestTool) {
    refuse(fmt::format("{}[tools.{}]: a tool has a number from 1 to {}", source.at(value), one_line(key, kLongestQuote),
                       kLargestTool));
  }
  return number;
}

// Tool offsets are for the machine's axes, which must be set before.
void set_tools(const Source& source, Machine& machine, const toml::table& table) {
  for (const auto& [key, value] : table) {
    const unsigned which = tool_number(source, key, value);
    if (!value.is_table()) refuse(fmt::format("{}tools.{} must be a table", source.at(value), which));
    auto tool = std::find_if(machine.tools.begin(), machine.tools.end(),
                             [&](const Tool& known) { return known.number == which; });
    if (tool == machine.tools.end()) tool = machine.tools.insert(tool, Tool{which, {}});
    std::vector<std::string> letters;
    for (const MachineAxis& axis : machine.axes) {
      letters.emplace_back(1, static_cast<char>(std::tolower(static_cast<unsigned char>(axis.letter))));
    }
    const std::string path = fmt::format("tools.{}.", which);
    for (const auto& [letter, offset] : value.as_table()) {
      const auto axis = std::find(letters.begin(), letters.end(), letter);
      if (axis == letters.end()) refuse_key(source, offset, path, letter, letters);
      tool->offsets[static_cast<std::size_t>(axis - letters.begin())] = number(source, path + letter, offset, kPlace);
    }
  }
}

void set_clock(const Source& source, Machine& machine, const toml::value& value) {
  const double clock = number(source, "card.clock_hz", value);
  if (clock != std::floor(clock) || clock < kSlowestClock || clock > kFastestClock) {
    refuse(fmt::format("{}card.clock_hz must be a whole number of Hz from {} to {}, not {}", source.at(value),
                       kSlowestClock, kFastestClock, clock));
  }
  machine.clock_hz = static_cast<std::uint32_t>(clock);
}

constexpr std::array<const char*, 2> kCardEntries = {"clock_hz", "require_home"};

void set_card(const Source& source, Machine& machine, const toml::table& table) {
  for (const auto& [key, value] : table) {
    if (key == "clock_hz") {
      set_clock(source, machine, value);
    } else if (key == "require_home") {
      machine.require_home = true_or_false(source, "card.require_home", value);
    }
  }
}

const toml::table& table_of(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_table()) {
    refuse(source.at(value) + one_line(path, kLongestQuote) + " must be a table");
  }
  return value.as_table();
}

// The letter of a table [axis.x]; throws for any other name.
char axis_letter(const Source& source, const std::string& key, const toml::value& value) {
  const char letter = key.size() == 1 ? static_cast<char>(std::toupper(static_cast<unsigned char>(key[0]))) : ' ';
  if (kAxisLetters.find(letter) == std::string_view::npos || key[0] == letter) {
    refuse(fmt::format("{}unknown axis [axis.{}]: one of x y z a b c u v w e", source.at(value),
                       one_line(key, kLongestQuote)));
  }
  return letter;
}

MachineAxis read_axis(const Source& source, const std::string& name, const toml::value& value) {
  MachineAxis axis;
  const std::string path = "axis." + name;
  const toml::table& table = table_of(source, path, value);
  axis.letter = axis_letter(source, name, value);
  set_axis(source, axis, name, table, value);
  const auto require = [&](const char* key) {
    if (table.count(key) == 0) {
      refuse(fmt::format("{}[{}] has no {}", source.at(value), path, key));
    }
  };
  for (const Entry& entry : kEntries) {
    if (entry.required) {
      require(entry.name);
    }
  }
  require(kInverted);
  return axis;
}

// toml11's messages have several lines; only the first describes the error, and its location is added separately.
std::string first_line_of(const std::exception& error) {
  std::string what = error.what();
  what = what.substr(0, what.find('\n'));
  if (const auto colon = what.rfind(": "); colon != std::string::npos) {
    what = what.substr(colon + 2);
  }
  return what;
}

// What to do about a line such as `on_limit = ramp`, whose value is text without quotation marks; "" for other lines. A
// shell removes marks that are not quoted themselves.
std::string hint_for(const Source& source, const std::string& line) {
  const auto trimmed = [](const std::string& text) {
    const auto from = text.find_first_not_of(" \t\r");
    return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(" \t\r") + 1 - from);
  };
  const auto equals = line.find('=');
  if (equals == std::string::npos) return "";
  const std::string key = trimmed(line.substr(0, equals));
  const std::string value = trimmed(line.substr(equals + 1, line.find('#', equals) - equals - 1));
  const bool text = !value.empty() && std::isalpha(static_cast<unsigned char>(value.front())) != 0 &&
                    value.find_first_of("\"'[]{}=\\") == std::string::npos;
  if (!text || value.size() > kLongestQuote || key.size() > kLongestQuote) return "";
  const std::string quoted = fmt::format("{}{}\"{}\"", key, source.has_lines ? " = " : "=", value);
  return fmt::format("{} is neither a number nor true or false, and text needs quotation marks: {}", value,
                     source.has_lines ? quoted : fmt::format("--set '{}'", quoted));
}

toml::value parse(const Source& source, const std::string& text) {
  // A machine file has two levels of tables.
  constexpr std::size_t kDeepest = 16;
  if (text.size() > kLongestMachineText) {
    refuse(fmt::format("{}more than {} bytes", source.at_line(1), kLongestMachineText));
  }
  if (const std::size_t line = too_deep_line(text, kDeepest); line != 0) {
    refuse(fmt::format("{}nested deeper than {}", source.at_line(line), kDeepest));
  }
  std::istringstream stream(text);
  try {
    return toml::parse(stream, source.name);
  } catch (const toml::syntax_error& error) {
    const std::string hint = hint_for(source, error.location().line_str());
    refuse(source.at_line(error.location().line()) + "not TOML: " + (hint.empty() ? first_line_of(error) : hint));
  } catch (const std::exception& error) {
    refuse(source.at_line(1) + "not TOML: " + first_line_of(error));
  }
}

constexpr std::array<const char*, 10> kTables = {"card",    "axis",  "kinematics", "motion", "outputs",
                                                 "spindle", "tools", "probe",      "inputs", "homing"};

void check_top_level(const Source& source, const toml::table& root) {
  for (const auto& [key, value] : root) {
    if (std::find(kTables.begin(), kTables.end(), key) == kTables.end()) {
      refuse_key(source, value, "", key, {kTables.begin(), kTables.end()});
    }
    for (const auto& [inner_key, inner] : table_of(source, key, value)) {
      if (key == "card" && std::find(kCardEntries.begin(), kCardEntries.end(), inner_key) == kCardEntries.end()) {
        refuse_key(source, inner, "card.", inner_key, {kCardEntries.begin(), kCardEntries.end()});
      }
    }
  }
}

// The table [name], or null if it is missing or empty.
const toml::table* find_table(const toml::table& root, const char* name) {
  const auto found = root.find(name);
  return found != root.end() && !found->second.as_table().empty() ? &found->second.as_table() : nullptr;
}

std::size_t card_order(char letter) { return kAxisLetters.find(letter); }

// Sets the tables that a file and an override have in common: all except the axes, which must be set before. Returns
// whether there was one.
bool set_tables(const Source& source, Machine& machine, const toml::table& root) {
  bool any = false;
  const auto set = [&](const char* name, auto with) {
    const toml::table* table = find_table(root, name);
    if (table == nullptr) return;
    with(*table);
    any = true;
  };
  set("card", [&](const toml::table& card) { set_card(source, machine, card); });
  set("kinematics", [&](const toml::table& entries) { set_kinematics(source, machine.kinematics, entries); });
  set("motion", [&](const toml::table& motion) { set_motion(source, machine.motion, motion); });
  set("outputs", [&](const toml::table& outputs) { set_outputs(source, machine, outputs); });
  set("spindle", [&](const toml::table& spindle) { set_spindle(source, machine, spindle); });
  set("tools", [&](const toml::table& tools) { set_tools(source, machine, tools); });
  set("probe", [&](const toml::table& probe) { set_probe(source, machine.probe, probe); });
  set("inputs", [&](const toml::table& inputs) { set_inputs(source, machine, inputs); });
  set("homing", [&](const toml::table& axes) { set_homing(source, machine, axes); });
  return any;
}

void check(const std::string& where, const Machine& machine) {
  check_motors(where, machine);
  check_kinematics(where, machine);
  check_ramps(where, machine);
  check_times(where, machine);
  check_soft_limits(where, machine);
  check_outputs(where, machine.outputs);
  check_inputs(machine);
  check_homing(machine);
}

}  // namespace

Machine parse_machine(const std::string& toml_text, const std::string& name) {
  const Source source{name, true};
  const toml::value document = parse(source, toml_text);
  const toml::table& root = document.as_table();
  check_top_level(source, root);
  const toml::table* card = find_table(root, "card");
  if (card == nullptr || card->count("clock_hz") == 0) {
    refuse(name + ":1: no [card] clock_hz");
  }
  const toml::table* axes = find_table(root, "axis");
  if (axes == nullptr) {
    refuse(name + ":1: no axis: at least one table [axis.<letter>]");
  }
  Machine machine;
  for (const auto& [key, value] : *axes) {
    machine.axes.push_back(read_axis(source, key, value));
  }
  check_motors(name + ":1", machine);
  std::sort(machine.axes.begin(), machine.axes.end(),
            [](const MachineAxis& a, const MachineAxis& b) { return card_order(a.letter) < card_order(b.letter); });
  set_tables(source, machine, root);
  check(name + ":1", machine);
  return machine;
}

Machine default_machine() { return parse_machine(default_machine_text(), "default machine"); }

Machine load_machine(const std::string& path) {
  if (path.empty()) {
    refuse("the machine file has no name");
  }
  return parse_machine(text_of_file(path), path);
}

void apply_override(Machine& machine, const std::string& text) {
  const Source source{"--set " + one_line(text, kLongestQuote), false};
  Machine changed = machine;
  const toml::value document = parse(source, text);
  const toml::table& root = document.as_table();
  check_top_level(source, root);
  bool any = set_tables(source, changed, root);
  if (const toml::table* axes = find_table(root, "axis")) {
    for (const auto& [name, value] : *axes) {
      const toml::table& table = table_of(source, "axis." + name, value);
      const auto index = changed.axis(axis_letter(source, name, value));
      if (!index) {
        refuse(fmt::format("{}: the machine has no axis {}", source.name, name));
      }
      set_axis(source, changed.axes[*index], name, table, value);
      any = any || !table.empty();
    }
  }
  if (!any) {
    refuse(source.name + ": not an assignment such as axis.x.steps_per_mm=20");
  }
  check(source.name, changed);
  machine = changed;
}

}  // namespace trammel::machine
