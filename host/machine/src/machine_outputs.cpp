#include "machine_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "entries.hpp"
#include "text.hpp"
#include "trammel/card_map.hpp"

namespace trammel::machine {
namespace {

struct OutputEntry {
  const char* name;
  std::uint16_t MachineOutputs::*member;
};
constexpr std::array<OutputEntry, 12> kOutputEntries = {{
    {"m3", &MachineOutputs::m3},
    {"m4", &MachineOutputs::m4},
    {"m7", &MachineOutputs::m7},
    {"m8", &MachineOutputs::m8},
    {"off_at_cause", &MachineOutputs::off_at_cause},
    {"off_at_rest", &MachineOutputs::off_at_rest},
    {"on_at_cause", &MachineOutputs::on_at_cause},
    {"on_at_rest", &MachineOutputs::on_at_rest},
    {"enable", &MachineOutputs::enable},
    {"brake", &MachineOutputs::brake},
    {"charge_pump", &MachineOutputs::charge_pump},
    {"healthy", &MachineOutputs::healthy},
}};
struct OutputNumber {
  const char* name;
  double MachineOutputs::*member;
  Range range;
};
constexpr std::array<OutputNumber, 6> kOutputNumbers = {{
    {"brake_release_ms", &MachineOutputs::brake_release_ms, kDriveDelay},
    {"enable_delay_ms", &MachineOutputs::enable_delay_ms, kDriveDelay},
    {"stop_delay_ms", &MachineOutputs::stop_delay_ms, kDriveDelay},
    {"brake_set_ms", &MachineOutputs::brake_set_ms, kDriveDelay},
    {"enable_idle_s", &MachineOutputs::enable_idle_s, kDriveIdle},
    {"charge_pump_hz", &MachineOutputs::charge_pump_hz, kChargePump},
}};
struct FaultName {
  const char* name;
  std::uint32_t mask;
};
constexpr std::array<FaultName, 9> kFaultNames = {{
    {"limit", card_map::field::kFaultLimit},
    {"emergency_stop", card_map::field::kFaultEmergencyStop},
    {"drive_fault", card_map::field::kFaultDriveFault},
    {"watchdog", card_map::field::kFaultWatchdog},
    {"soft_limit", card_map::field::kFaultSoftLimit},
    {"probe", card_map::field::kFaultProbe},
    {"tool_setter", card_map::field::kFaultToolSetter},
    {"step", card_map::field::kFaultStep},
    {"path_incomplete", card_map::field::kFaultPathIncomplete},
}};

// "p7": the output that M62 to M65 switch with P7; none for another key.
std::optional<std::size_t> numbered_of(const std::string& key) {
  for (std::size_t n = 0; n < kMaxOutputs; ++n) {
    if (key == fmt::format("p{}", n)) return n;
  }
  return std::nullopt;
}

constexpr const char* kEnableManual = "enable_manual";
constexpr const char* kEnableAxes = "enable_axes";
constexpr const char* kOnEmergencyStop = "on_emergency_stop";

char small(char letter) { return static_cast<char>(std::tolower(static_cast<unsigned char>(letter))); }
char large(char letter) { return static_cast<char>(std::toupper(static_cast<unsigned char>(letter))); }

std::uint16_t output_bit(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_integer() || value.as_integer() < 0 || value.as_integer() >= kMaxOutputs) {
    refuse(fmt::format("{}{} must be an output's number, 0 to {}, or a list of such", source.at(value), path,
                       kMaxOutputs - 1));
  }
  return static_cast<std::uint16_t>(1U << value.as_integer());
}

std::uint32_t faults_of(const Source& source, const std::string& path, const toml::value& value) {
  std::uint32_t faults = 0;
  std::string known;
  for (const FaultName& fault : kFaultNames) known += fmt::format("{}{}", known.empty() ? "" : ", ", fault.name);
  const auto refuse_it = [&] { refuse(fmt::format("{}{} must be a list of {}", source.at(value), path, known)); };
  if (!value.is_array()) refuse_it();
  for (const toml::value& one : value.as_array()) {
    const std::string name = one.is_string() ? one.as_string().str : "";
    const auto fault = std::find_if(kFaultNames.begin(), kFaultNames.end(),
                                    [&name](const FaultName& entry) { return entry.name == name; });
    if (fault == kFaultNames.end()) refuse_it();
    faults |= fault->mask;
  }
  return faults;
}

// Reads letters of axes of the machine; the result is in the machine's order.
std::string axes_of(const Source& source, const Machine& machine, const std::string& path, const toml::value& value) {
  std::string known;
  for (const MachineAxis& axis : machine.axes) {
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", small(axis.letter));
  }
  const auto refuse_it = [&] {
    refuse(fmt::format("{}{} must be a list of axes of the machine: {}; leave it out for all of them", source.at(value),
                       path, known));
  };
  if (!value.is_array() || value.as_array().empty()) refuse_it();
  std::string letters;
  for (const MachineAxis& axis : machine.axes) {
    const auto& names = value.as_array();
    const bool named = std::any_of(names.begin(), names.end(), [&axis](const toml::value& name) {
      return name.is_string() && name.as_string().str == std::string(1, small(axis.letter));
    });
    if (named) letters += axis.letter;
  }
  for (const toml::value& name : value.as_array()) {
    const std::string letter = name.is_string() ? name.as_string().str : "";
    const bool lower = letter.size() == 1 && std::islower(static_cast<unsigned char>(letter[0])) != 0;
    if (!lower || letters.find(large(letter[0])) == std::string::npos) refuse_it();
  }
  return letters;
}

std::vector<std::string> output_keys() {
  std::vector<std::string> names;
  for (const OutputEntry& entry : kOutputEntries) names.emplace_back(entry.name);
  for (std::size_t n = 0; n < kMaxOutputs; ++n) names.push_back(fmt::format("p{}", n));
  for (const OutputNumber& entry : kOutputNumbers) names.emplace_back(entry.name);
  names.insert(names.end(), {"disable_on", kEnableManual, kEnableAxes, kOnEmergencyStop});
  return names;
}

std::uint16_t output_bits(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_array()) return output_bit(source, path, value);
  std::uint16_t bits = 0;
  for (const toml::value& one : value.as_array()) bits |= output_bit(source, path, one);
  return bits;
}

void set_output(const Source& source, Machine& machine, const std::string& key, const toml::value& value) {
  MachineOutputs& outputs = machine.outputs;
  const std::string path = "outputs." + key;
  const auto is_it = [&key](const auto& known) { return key == known.name; };
  const auto* const number_entry = std::find_if(kOutputNumbers.begin(), kOutputNumbers.end(), is_it);
  const auto* const entry = std::find_if(kOutputEntries.begin(), kOutputEntries.end(), is_it);
  if (number_entry != kOutputNumbers.end()) {
    outputs.*number_entry->member = number(source, path, value, number_entry->range);
  } else if (entry != kOutputEntries.end()) {
    outputs.*entry->member = output_bits(source, path, value);
  } else if (const auto n = numbered_of(key)) {
    outputs.numbered[*n] = output_bits(source, path, value);
  } else if (key == "disable_on") {
    outputs.disable_on = faults_of(source, path, value);
  } else if (key == kEnableManual) {
    outputs.enable_manual = true_or_false(source, path, value);
  } else if (key == kEnableAxes) {
    outputs.enable_axes = axes_of(source, machine, path, value);
  } else if (key == kOnEmergencyStop) {
    outputs.emergency_stop_ramps = word(source, path, value, {"ramp", "immediate"}) == "ramp";
  } else {
    refuse_key(source, value, "outputs.", key, output_keys());
  }
}

// Rules between entries. A violation was introduced by this table, so at least one of the entries is in it.
class Rules {
 public:
  Rules(const Source& source, const toml::table& table) : source_(source), table_(table) {}

  // In the message, `why` follows the first of `keys`.
  void require(bool holds, const std::vector<const char*>& keys, const std::string& why) const {
    if (holds) return;
    const auto key = std::find_if(keys.begin(), keys.end(), [this](const char* k) { return table_.count(k) != 0; });
    const std::string place = key != keys.end() ? source_.at(table_.at(*key)) : source_.at_line(1);
    refuse(fmt::format("{}outputs.{}{}", place, keys.front(), why));
  }

  // An output has only one safe level.
  void one_level(const char* on, std::uint16_t on_outputs, const char* off, std::uint16_t off_outputs) const {
    const unsigned both = unsigned{on_outputs} & off_outputs;
    unsigned output = 0;
    while (both != 0 && (both >> output & 1U) == 0) ++output;
    require(
        both == 0, {on, off},
        fmt::format(": output {} is named by {} too, and goes to one level: take it out of one of them", output, off));
  }

 private:
  const Source& source_;
  const toml::table& table_;
};

void check_rules(const Source& source, const MachineOutputs& outputs, const toml::table& table) {
  const Rules rules(source, table);
  rules.one_level("on_at_cause", outputs.on_at_cause, "off_at_cause", outputs.off_at_cause);
  rules.one_level("on_at_rest", outputs.on_at_rest, "off_at_rest", outputs.off_at_rest);
  const bool drives = (outputs.enable | outputs.brake) != 0;
  constexpr const char* kNoDrives = ": no output is named for enable or brake: name one, or take this entry out";
  rules.require(drives || !outputs.enable_manual, {kEnableManual, "enable", "brake"}, kNoDrives);
  rules.require(drives || outputs.enable_axes.empty(), {kEnableAxes, "enable", "brake"}, kNoDrives);
  rules.require(!drives || !outputs.emergency_stop_ramps.value_or(false), {kOnEmergencyStop, "enable", "brake"},
                ": no ramp can be made, since the card disables the drives of enable and brake at once: choose "
                "\"immediate\", or take enable and brake out");
}

}  // namespace

void set_outputs(const Source& source, Machine& machine, const toml::table& table) {
  for (const auto& [key, value] : table) set_output(source, machine, key, value);
  check_rules(source, machine.outputs, table);
}

}  // namespace trammel::machine
