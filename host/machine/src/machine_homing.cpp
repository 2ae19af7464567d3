#include "machine_homing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "entries.hpp"
#include "machine_inputs.hpp"
#include "text.hpp"
#include "trammel/driver/roles.hpp"

namespace trammel::machine {
namespace {

using driver::AxisRole;
using driver::Role;

constexpr Range kVelocity{-1e7, 1e7, "mm/s", "10 km/s either way"};
constexpr Range kFinalVelocity{0, 1e7, "mm/s", "0 stands for max_velocity"};
constexpr Range kDistance{0, 2.2e12, "mm", "2^31 pulses at the coarsest scale"};

struct NumberEntry {
  const char* name;
  double AxisHoming::*member;
  Range range;
};
constexpr std::array<NumberEntry, 7> kNumbers{{{"search_velocity", &AxisHoming::search_velocity, kVelocity},
                                               {"latch_velocity", &AxisHoming::latch_velocity, kVelocity},
                                               {"final_velocity", &AxisHoming::final_velocity, kFinalVelocity},
                                               {"offset", &AxisHoming::offset, kPlace},
                                               {"final_position", &AxisHoming::final_position, kPlace},
                                               {"search_distance", &AxisHoming::search_distance, kDistance},
                                               {"squaring", &AxisHoming::squaring, kDistance}}};
struct SwitchEntry {
  const char* name;
  bool AxisHoming::*member;
};
constexpr std::array<SwitchEntry, 4> kSwitches{{{"use_index", &AxisHoming::use_index},
                                                {"ignore_limits", &AxisHoming::ignore_limits},
                                                {"shared", &AxisHoming::shared},
                                                {"at_speed", &AxisHoming::at_speed}}};
constexpr const char* kSequence = "sequence";
constexpr unsigned kMostSequence = 31;

std::vector<std::string> entries() {
  std::vector<std::string> names;
  for (const NumberEntry& entry : kNumbers) names.emplace_back(entry.name);
  for (const SwitchEntry& entry : kSwitches) names.emplace_back(entry.name);
  names.emplace_back(kSequence);
  return names;
}

void set_entry(const Source& source, AxisHoming& homing, const std::string& table, const std::string& key,
               const toml::value& value) {
  const std::string path = table + key;
  for (const NumberEntry& entry : kNumbers) {
    if (key != entry.name) continue;
    homing.*entry.member = number(source, path, value, entry.range);
    return;
  }
  for (const SwitchEntry& entry : kSwitches) {
    if (key != entry.name) continue;
    if (!value.is_boolean()) refuse(source.at(value) + path + " must be true or false");
    homing.*entry.member = value.as_boolean();
    return;
  }
  if (key != kSequence) refuse_key(source, value, table, key, entries());
  if (!value.is_integer() || value.as_integer() < 0 || value.as_integer() > kMostSequence) {
    refuse(fmt::format("{}{} must be a whole number from 0 to {}", source.at(value), path, kMostSequence));
  }
  homing.sequence = static_cast<unsigned>(value.as_integer());
}

// The error in the velocities of an axis's homing, to follow "homing.x: "; empty if there is none.
std::string velocities_of(const MachineAxis& axis, const AxisHoming& homing) {
  if (homing.search_velocity == 0) return "search_velocity is missing, mm/s towards the switch, such as -20";
  const double search = std::abs(homing.search_velocity);
  const double latch = std::abs(homing.latch_velocity);
  if (search > axis.max_velocity)
    return fmt::format("search_velocity is {:g} mm/s, and the axis's max_velocity {:g}", search, axis.max_velocity);
  if (latch > search) return fmt::format("latch_velocity, {:g} mm/s, is above search_velocity, {:g}", latch, search);
  if (homing.final_velocity > axis.max_velocity)
    return fmt::format("final_velocity is {:g} mm/s, and the axis's max_velocity {:g}", homing.final_velocity,
                       axis.max_velocity);
  if (homing.at_speed && homing.latch_velocity != 0)
    return "at_speed is for a search whose edge counts: leave latch_velocity out";
  if (homing.use_index && homing.latch_velocity == 0) return "use_index needs a latch_velocity";
  return "";
}

std::string wrong_homing(const Machine& machine, std::size_t n) {
  const MachineAxis& axis = machine.axes[n];
  const AxisHoming& homing = *axis.homing;
  const auto inputs = [&](AxisRole role) {
    return machine.inputs.roles[Role(role, static_cast<unsigned>(n)).number()].inputs;
  };
  const char letter = static_cast<char>(std::tolower(static_cast<unsigned char>(axis.letter)));
  const std::uint32_t home = inputs(AxisRole::kHome);
  if (home == 0) return fmt::format("no input has the role: give {}_home in [inputs]", letter);
  if ((home & (home - 1)) != 0) return fmt::format("{}_home must be one input: its edge is captured", letter);
  if ((home & (inputs(AxisRole::kLimitMinus) | inputs(AxisRole::kLimitPlus))) != 0 && !homing.ignore_limits)
    return fmt::format("{}_home is a limit as well, which would stop the search: give ignore_limits = true", letter);
  if (homing.use_index && inputs(AxisRole::kIndex) == 0)
    return fmt::format("use_index: no input has the role: give {}_index in [inputs]", letter);
  std::string wrong = velocities_of(axis, homing);
  if (!wrong.empty()) return wrong;
  if (homing.search_distance == 0 && !std::isfinite(axis.max - axis.min))
    return "give search_distance, mm, or min and max of the axis: a switch that never comes must end the search";
  if (homing.final_position < axis.min || homing.final_position > axis.max)
    return fmt::format("final_position, {:g}, is outside the soft limits, {:g} to {:g}", homing.final_position,
                       axis.min, axis.max);
  return "";
}

}  // namespace

void set_homing(const Source& source, Machine& machine, const toml::table& axes) {
  std::vector<std::string> letters;
  for (const MachineAxis& axis : machine.axes)
    letters.emplace_back(1, static_cast<char>(std::tolower(static_cast<unsigned char>(axis.letter))));
  for (const auto& [name, value] : axes) {
    const auto found = std::find(letters.begin(), letters.end(), name);
    if (found == letters.end()) refuse_key(source, value, "homing.", name, letters);
    if (!value.is_table()) refuse(fmt::format("{}homing.{} must be a table", source.at(value), name));
    MachineAxis& axis = machine.axes[static_cast<std::size_t>(found - letters.begin())];
    AxisHoming homing = axis.homing.value_or(AxisHoming{});
    homing.place = source.at(value);
    for (const auto& [key, entry] : value.as_table()) set_entry(source, homing, "homing." + name + ".", key, entry);
    axis.homing = homing;
  }
}

void check_homing(const Machine& machine) {
  for (std::size_t n = 0; n < machine.axes.size(); ++n) {
    if (!machine.axes[n].homing) continue;
    const std::string wrong = wrong_homing(machine, n);
    if (wrong.empty()) continue;
    refuse(fmt::format("{}homing.{}: {}", machine.axes[n].homing->place,
                       static_cast<char>(std::tolower(static_cast<unsigned char>(machine.axes[n].letter))), wrong));
  }
}

}  // namespace trammel::machine
