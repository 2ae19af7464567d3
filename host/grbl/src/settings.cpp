#include "trammel/grbl/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "trammel/gcode/parameter_numbers.hpp"

namespace trammel::grbl {
namespace {

constexpr std::string_view kAxes = "XYZ";
constexpr double kMinute = 60;

// Grbl's defaults for settings that a machine file does not have, or does not express as one number.
const std::map<int, double>& grbl_defaults() {
  static const std::map<int, double> kDefaults{{1, 25},  {2, 0},      {4, 0},    {5, 0},  {6, 0},
                                               {10, 1},  {12, 0.002}, {13, 0},   {21, 0}, {23, 0},
                                               {24, 25}, {25, 500},   {26, 250}, {27, 1}, {31, 0}};
  return kDefaults;
}

// Whether a setting is an integer: a switch, a mask or a time in milliseconds.
bool is_whole(int number) {
  constexpr std::array<int, 7> kFractions{11, 12, 24, 25, 27, 30, 31};
  return number < 100 && std::find(kFractions.begin(), kFractions.end(), number) == kFractions.end();
}

bool is_shown_whole(int number) { return is_whole(number) || number == 30 || number == 31; }

// Converts the whole text to one finite number.
std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::optional<int> key_in(const std::string& text) {
  const bool digits = !text.empty() && text.size() < 6 && text.find_first_not_of("0123456789") == std::string::npos;
  return digits ? std::optional<int>(std::stoi(text)) : std::nullopt;
}

Status check_value(int number, double value) {
  if (value < 0) return Status::kNegativeValue;
  if (number == 0 && value < 3) return Status::kStepPulseTooShort;
  const bool positive = number >= 100 && number < 130;
  const bool good = std::isfinite(value) && value <= 1e9 && !(positive && value == 0);
  return good ? Status::kOk : Status::kInvalidStatement;
}

double travel_of(const machine::MachineAxis& axis) {
  return std::isfinite(axis.min) && std::isfinite(axis.max) ? axis.max - axis.min : 0;
}

std::map<int, double> defaults_of(const machine::Machine& machine) {
  std::map<int, double> values = grbl_defaults();
  values[0] = 10;
  values[3] = 0;
  values[11] = machine.motion.junction_deviation;
  values[20] = 0;
  values[22] = 0;
  values[30] = machine.outputs.max_s;
  values[32] = machine.outputs.laser ? 1 : 0;
  for (std::size_t n = 0; n < kAxes.size(); ++n) {
    const int at = static_cast<int>(n);
    const auto index = machine.axis(kAxes[n]);
    const machine::MachineAxis axis = index ? machine.axes[*index] : machine::MachineAxis{};
    values[0] = index && n == 0 ? axis.step_length_ns / 1000 : values[0];
    if (axis.inverted) values[3] += 1U << n;
    if (std::isfinite(axis.min) || std::isfinite(axis.max)) values[20] = 1;
    if (axis.homing) values[22] = 1;
    values[100 + at] = axis.steps_per_mm;
    values[110 + at] = axis.max_velocity * kMinute;
    values[120 + at] = axis.max_acceleration;
    values[130 + at] = travel_of(axis);
  }
  return values;
}

void apply_axis(machine::MachineAxis& axis, std::size_t n, const std::map<int, double>& changed, bool limits) {
  const auto change = [&](int number, auto set) {
    const auto found = changed.find(number);
    if (found != changed.end()) set(found->second);
  };
  const int at = static_cast<int>(n);
  change(0, [&](double us) { axis.step_length_ns = us * 1000; });
  change(3, [&](double mask) { axis.inverted = (static_cast<unsigned>(mask) >> n & 1U) != 0; });
  change(100 + at, [&](double steps) { axis.steps_per_mm = steps; });
  change(110 + at, [&](double rate) { axis.max_velocity = rate / kMinute; });
  change(120 + at, [&](double acceleration) { axis.max_acceleration = acceleration; });
  change(130 + at, [&](double travel) {
    if (travel <= 0) return;
    if (std::isfinite(axis.min) && !std::isfinite(axis.max)) {
      axis.max = axis.min + travel;
    } else {
      axis.max = std::isfinite(axis.max) ? axis.max : 0;
      axis.min = axis.max - travel;
    }
  });
  if (limits) return;
  axis.min = -std::numeric_limits<double>::infinity();
  axis.max = std::numeric_limits<double>::infinity();
}

}  // namespace

Settings::Settings(const machine::Machine& machine, std::string file)
    : base_(machine), machine_(machine), file_(std::move(file)), defaults_(defaults_of(machine)) {
  if (!file_.empty()) read();
  apply();
}

double Settings::value(int number) const {
  const auto found = changed_.find(number);
  return found != changed_.end() ? found->second : defaults_.at(number);
}

std::string Settings::text_of(int number) const {
  return is_shown_whole(number) ? fmt::format("${}={:.0f}", number, value(number))
                                : fmt::format("${}={:.3f}", number, value(number));
}

std::vector<std::string> Settings::lines() const {
  std::vector<std::string> lines;
  for (const auto& [number, value] : defaults_) lines.push_back(text_of(number));
  return lines;
}

Status Settings::set(int number, double value) {
  if (value < 0) return Status::kNegativeValue;
  if (defaults_.count(number) == 0) return Status::kInvalidStatement;
  if (const Status status = check_value(number, value); status != Status::kOk) return status;
  if (number == 20 && value != 0 && !flag(22)) return Status::kSoftLimitsNeedHoming;
  changed_[number] = is_whole(number) ? std::floor(value) : value;
  if (number == 22 && value == 0) changed_[20] = 0;
  apply();
  write();
  return Status::kOk;
}

bool Settings::changes_machine(int number) {
  constexpr std::array<int, 7> kOfMachine{0, 3, 11, 20, 22, 30, 32};
  return number >= 100 || std::find(kOfMachine.begin(), kOfMachine.end(), number) != kOfMachine.end();
}

void Settings::set_startup(std::size_t n, const std::string& line) {
  startup_.at(n) = line;
  write();
}

void Settings::set_parameters(const std::map<int, double>& parameters) {
  std::map<int, double> kept;
  for (const auto& [number, value] : parameters) {
    // G92 and the active coordinate system are not kept, as in Grbl.
    const bool lost = number >= gcode::parameter::kShifted && number <= gcode::parameter::kSystem;
    if (!lost && value != 0) kept[number] = value;
  }
  if (kept == parameters_) return;
  parameters_ = kept;
  write();
}

void Settings::set_build_text(const std::string& text) {
  build_text_ = text;
  write();
}

void Settings::restore() {
  changed_.clear();
  apply();
  write();
}

void Settings::apply() {
  machine_ = base_;
  for (std::size_t n = 0; n < kAxes.size(); ++n) {
    const auto index = machine_.axis(kAxes[n]);
    if (index) apply_axis(machine_.axes[*index], n, changed_, flag(20));
  }
  if (changed_.count(11) != 0) machine_.motion.junction_deviation = changed_.at(11);
  if (changed_.count(30) != 0 && changed_.at(30) > 0) machine_.outputs.max_s = changed_.at(30);
  if (changed_.count(32) != 0) machine_.outputs.laser = changed_.at(32) != 0;
}

void Settings::read() {
  std::ifstream in(file_);
  std::error_code unknown;
  if (!in && std::filesystem::exists(file_, unknown)) throw std::runtime_error(file_ + ": cannot be read");
  for (std::string line; std::getline(in, line);) {
    if (!read_line(line)) {
      throw std::runtime_error(fmt::format("{}: not a setting: {}", file_, line.substr(0, 80)));
    }
  }
  if (in.bad()) throw std::runtime_error(file_ + ": cannot be read");
}

bool Settings::read_line(const std::string& line) {
  const std::size_t equal = line.find('=');
  if (equal == std::string::npos || equal < 2 || (line[0] != '$' && line[0] != '#')) return false;
  const std::string name = line.substr(1, equal - 1);
  const std::string value = line.substr(equal + 1);
  if (line[0] == '$' && (name == "N0" || name == "N1")) {
    startup_.at(name == "N0" ? 0 : 1) = value;
    return true;
  }
  if (line[0] == '$' && name == "I") {
    build_text_ = value;
    return true;
  }
  const auto key = key_in(name);
  const auto number = number_in(value);
  if (!key || !number) return false;
  const bool setting = line[0] == '$';
  if (setting && (defaults_.count(*key) == 0 || check_value(*key, *number) != Status::kOk)) return false;
  (setting ? changed_ : parameters_)[*key] = *number;
  return true;
}

// Writes a new file first, so the old one stays intact if the write fails.
void Settings::write() {
  if (file_.empty()) return;
  const std::string fresh = file_ + ".new";
  std::ofstream out(fresh);
  for (const auto& [number, value] : changed_) out << fmt::format("${}={}\n", number, value);
  for (const auto& [number, value] : parameters_) out << fmt::format("#{}={}\n", number, value);
  for (std::size_t n = 0; n < kStartupLines; ++n) {
    if (!startup_[n].empty()) out << fmt::format("$N{}={}\n", n, startup_[n]);
  }
  if (!build_text_.empty()) out << fmt::format("$I={}\n", build_text_);
  out.close();
  if (!out || std::rename(fresh.c_str(), file_.c_str()) != 0) {
    trouble_ = fmt::format("{}: the settings cannot be written; they hold until the end", file_);
  }
}

}  // namespace trammel::grbl
