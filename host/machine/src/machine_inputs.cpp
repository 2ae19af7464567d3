#include "machine_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "entries.hpp"
#include "text.hpp"
#include "trammel/driver/roles.hpp"
#include "trammel/machine/stop_ways.hpp"

namespace trammel::machine {

namespace {

using driver::AxisRole;
using driver::CardRole;
using driver::Role;

struct AxisKey {
  const char* name;  // after "x_"
  AxisRole role;
};
constexpr std::array<AxisKey, 6> kAxisKeys{{{"limit_minus", AxisRole::kLimitMinus},
                                            {"limit_plus", AxisRole::kLimitPlus},
                                            {"home", AxisRole::kHome},
                                            {"index", AxisRole::kIndex},
                                            {"drive_fault", AxisRole::kDriveFault},
                                            {"in_position", AxisRole::kInPosition}}};
constexpr const char* kBothLimits = "limit";
constexpr const char* kSecondHome = "second_home";  // home switch of an axis's second motor

struct CardKey {
  const char* name;
  CardRole role;
};
constexpr std::array<CardKey, 4> kCardKeys{{{"tool_setter", CardRole::kToolSetter},
                                            {"feed_hold", CardRole::kFeedHold},
                                            {"cycle_start", CardRole::kCycleStart},
                                            {"spindle_at_speed", CardRole::kSpindleAtSpeed}}};

bool is_limit(std::size_t role) { return role / 8 <= static_cast<std::size_t>(AxisRole::kLimitPlus); }

std::vector<std::string> known_keys(const Machine& machine) {
  std::vector<std::string> names{"filter",   "closed_level",   "on_limit",     "on_drive_fault",
                                 "on_probe", "on_tool_setter", "on_soft_limit"};
  for (const CardKey& key : kCardKeys) names.emplace_back(key.name);
  for (const MachineAxis& axis : machine.axes) {
    const std::string letter(1, static_cast<char>(std::tolower(static_cast<unsigned char>(axis.letter))));
    for (const AxisKey& key : kAxisKeys) names.push_back(letter + "_" + key.name);
    names.push_back(letter + "_" + kBothLimits);
    if (axis.second_motor) names.push_back(letter + "_" + kSecondHome);
  }
  return names;
}

// The roles of a key; empty for an unknown key. "x_limit" is a switch that serves both ends.
std::vector<Role> roles_of(const Machine& machine, const std::string& key) {
  for (const CardKey& known : kCardKeys) {
    if (key == known.name) return {known.role};
  }
  if (key.size() < 3 || key[1] != '_') return {};
  const auto axis = machine.axis(static_cast<char>(std::toupper(static_cast<unsigned char>(key[0]))));
  if (!axis || std::isupper(static_cast<unsigned char>(key[0])) != 0) return {};
  const unsigned n = static_cast<unsigned>(*axis);
  const std::string what = key.substr(2);
  if (what == kSecondHome && machine.axes[n].second_motor) {
    const std::vector<std::size_t> seconds = machine.second_motors();
    const auto before = std::find(seconds.begin(), seconds.end(), n) - seconds.begin();
    return {{AxisRole::kHome, static_cast<unsigned>(machine.axes.size() + static_cast<std::size_t>(before))}};
  }
  if (what == kBothLimits) return {{AxisRole::kLimitMinus, n}, {AxisRole::kLimitPlus, n}};
  for (const AxisKey& known : kAxisKeys) {
    if (what == known.name) return {{known.role, n}};
  }
  return {};
}

std::uint32_t input_bit(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_integer() || value.as_integer() < 0 || value.as_integer() >= kMaxInputs) {
    refuse(fmt::format("{}{} must be an input's number, 0 to {}, or a list of such", source.at(value), path,
                       kMaxInputs - 1));
  }
  return std::uint32_t{1} << value.as_integer();
}

std::uint32_t input_bits(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_array()) return input_bit(source, path, value);
  std::uint32_t bits = 0;
  for (const toml::value& one : value.as_array()) bits |= input_bit(source, path, one);
  return bits;
}

// An input's number, a list of them, or a table: { input = 3, normally = "open", filter = 2.0 }.
InputRole read_role(const Source& source, const std::string& path, const toml::value& value) {
  InputRole role;
  role.place = source.at(value);
  if (!value.is_table()) {
    role.inputs = input_bits(source, path, value);
    return role;
  }
  for (const auto& [key, entry] : value.as_table()) {
    const std::string name = path + "." + key;
    if (key == "input") {
      role.inputs = input_bits(source, name, entry);
    } else if (key == "normally") {
      role.closed = word(source, name, entry, {"open", "closed"}) == "closed";
    } else if (key == "filter") {
      role.filter = number(source, name, entry, kFilter);
    } else {
      refuse_key(source, entry, path + ".", key, {"input", "normally", "filter"});
    }
  }
  if (role.inputs == 0) refuse(fmt::format("{}{} names no input", source.at(value), path));
  return role;
}

OnInput reaction(const Source& source, const std::string& path, const toml::value& value) {
  const std::string text = word(source, path, value, {"nothing", "ramp", "immediate"});
  return text == "ramp" ? OnInput::kRamp : text == "immediate" ? OnInput::kImmediate : OnInput::kNothing;
}

OnInput ramp_or_immediate(const Source& source, const std::string& path, const toml::value& value) {
  return word(source, path, value, {"ramp", "immediate"}) == "ramp" ? OnInput::kRamp : OnInput::kImmediate;
}

OnLimit on_limit(const Source& source, const std::string& path, const toml::value& value) {
  const std::string text = word(source, path, value, {"automatic", "ramp", "immediate"});
  return text == "ramp" ? OnLimit::kRamp : text == "immediate" ? OnLimit::kImmediate : OnLimit::kAutomatic;
}

// Whether the inputs of a role are normally closed.
bool closed_of(const InputRole& role, std::size_t number) { return role.closed.value_or(is_limit(number)); }

}  // namespace

void set_inputs(const Source& source, Machine& machine, const toml::table& table) {
  MachineInputs& inputs = machine.inputs;
  for (const auto& [key, value] : table) {
    const std::string path = "inputs." + key;
    if (key == "filter") {
      inputs.filter = number(source, path, value, kFilter);
    } else if (key == "closed_level") {
      if (!value.is_integer() || (value.as_integer() != 0 && value.as_integer() != 1)) {
        refuse(source.at(value) + path + " must be 0 or 1");
      }
      inputs.closed_level = value.as_integer() == 1;
    } else if (key == "on_limit") {
      inputs.on_limit = on_limit(source, path, value);
      inputs.on_limit_place = source.at(value);
    } else if (key == "on_drive_fault") {
      inputs.on_drive_fault = ramp_or_immediate(source, path, value);
    } else if (key == "on_soft_limit") {
      inputs.on_soft_limit = ramp_or_immediate(source, path, value);
    } else if (key == "on_probe") {
      inputs.on_probe = reaction(source, path, value);
    } else if (key == "on_tool_setter") {
      inputs.on_tool_setter = reaction(source, path, value);
    } else {
      const std::vector<Role> roles = roles_of(machine, key);
      if (roles.empty()) refuse_key(source, value, "inputs.", key, known_keys(machine));
      for (const Role role : roles) inputs.roles[role.number()] = read_role(source, path, value);
    }
  }
}

void check_inputs(const Machine& machine) {
  const auto& roles = machine.inputs.roles;
  for (std::size_t a = 0; a < roles.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const std::uint32_t both = roles[a].inputs & roles[b].inputs;
      if (both == 0 || !roles[a].closed || !roles[b].closed || *roles[a].closed == *roles[b].closed) continue;
      unsigned input = 0;
      while ((both >> input & 1) == 0) ++input;
      refuse(fmt::format("{}input {} is normally open for one of its roles and closed for another", roles[a].place,
                         input));
    }
  }
  if (machine.inputs.on_limit != OnLimit::kRamp) return;
  const std::vector<StopWay> ways = stop_ways(machine);
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (ramp_fits(ways[i], machine.axes[i])) continue;
    refuse(
        fmt::format("{}inputs.on_limit: axis {}: a ramp needs {:.3g} mm behind the switch at max_velocity (filter and "
                    "half of the ramp of {:.3g} s), its overtravel is {:g} mm",
                    machine.inputs.on_limit_place, machine.axes[i].letter, ways[i].behind_switch(),
                    hold_seconds(machine), machine.axes[i].overtravel));
  }
}

std::uint32_t MachineInputs::used() const {
  std::uint32_t bits = 0;
  for (const InputRole& role : roles) bits |= role.inputs;
  return bits;
}

std::uint32_t MachineInputs::inverted() const {
  std::uint32_t told_closed = 0;
  std::uint32_t told_open = 0;
  std::uint32_t closed = 0;
  for (std::size_t n = 0; n < roles.size(); ++n) {
    if (roles[n].closed) (*roles[n].closed ? told_closed : told_open) |= roles[n].inputs;
    if (closed_of(roles[n], n)) closed |= roles[n].inputs;
  }
  closed = (closed & ~told_open) | told_closed;
  // A normally closed input is active when it opens.
  return used() & (closed_level ? closed : ~closed);
}

double MachineInputs::filter_of(unsigned input) const {
  std::optional<double> longest;
  for (const InputRole& role : roles) {
    if ((role.inputs >> input & 1) != 0 && role.filter) longest = std::max(longest.value_or(0), *role.filter);
  }
  return longest.value_or(filter);
}

}  // namespace trammel::machine
