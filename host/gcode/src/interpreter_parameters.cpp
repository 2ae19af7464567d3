// The parts of the state that programs can read, with LinuxCNC's numbers and names.
#include <iterator>

#include "interpreter.hpp"

namespace trammel::gcode {
namespace {

constexpr int kProbeResults = 5061;
constexpr int kProbeSuccess = 5070;
constexpr int kTool = 5400;
constexpr int kToolOffsets = 5401;
constexpr int kPosition = 5420;

// Index 0 to 8 of the axis letter in "_x" and so on; -1 for other names.
int axis_name(std::string_view name) {
  constexpr std::string_view kNames = "xyzabcuvw";
  if (name.size() != 2 || name[0] != '_') return -1;
  const std::size_t found = kNames.find(name[1]);
  return found == std::string_view::npos ? -1 : static_cast<int>(found);
}

Value flag(bool holds) { return {holds ? 1.0 : 0.0, false}; }

}  // namespace

// A machine coordinate as a program coordinate, in the program's units.
double Interpreter::to_program(std::size_t axis, double machine) const {
  const double mm = machine - offsets_.total(axis);
  return modes_.inches && !is_rotary(axis) ? mm / kMmPerInch : mm;
}

Value Interpreter::numbered(int number) const {
  if (number >= kProbeResults && number < kProbeResults + kParameterAxes) {
    return probe_results_[static_cast<std::size_t>(number - kProbeResults)];
  }
  if (number == kProbeSuccess) return probe_success_;
  if (number == kTool) return {static_cast<double>(tools_.current()), false};
  if (const auto axis = parameter_axis(machine_, number - kToolOffsets)) {
    return {tools_.offset(tools_.current(), *axis), false};
  }
  if (const auto axis = parameter_axis(machine_, number - kPosition)) {
    return {to_program(*axis, here_.at[*axis]), here_.is_later(*axis) || offsets_.later(*axis)};
  }
  return offsets_.parameter(number).value_or(Value{});
}

std::optional<Value> Interpreter::named(std::string_view name) const {
  if (const int nth = axis_name(name); nth >= 0) return numbered(kPosition + nth);
  const auto system = static_cast<int>(offsets_.system());
  const struct {
    std::string_view name;
    Value value;
  } kNames[] = {
      {"_line", {static_cast<double>(line_), false}},
      {"_motion_mode", {static_cast<double>(modes_.motion.value_or(-10)), false}},
      {"_plane", {static_cast<double>(modes_.plane), false}},
      {"_coord_system", {static_cast<double>(system < 6 ? 540 + 10 * system : 585 + system), false}},
      {"_metric", flag(!modes_.inches)},
      {"_imperial", flag(modes_.inches)},
      {"_absolute", flag(modes_.absolute)},
      {"_incremental", flag(!modes_.absolute)},
      {"_inverse_time", flag(modes_.inverse_time)},
      {"_units_per_minute", flag(!modes_.inverse_time)},
      {"_units_per_rev", flag(false)},
      {"_retract_r_plane", flag(!modes_.retract_to_start)},
      {"_retract_old_z", flag(modes_.retract_to_start)},
      {"_tool_offset", flag(offsets_.has_tool())},
      {"_current_tool", {static_cast<double>(tools_.current()), false}},
      {"_selected_tool", {static_cast<double>(tools_.selected().value_or(0)), false}},
      {"_feed", {modes_.feed.value_or(0), modes_.feed_later}},
      {"_rpm", {modes_.spindle_speed, false}},
  };
  for (const auto& known : kNames) {
    if (known.name == name) return known.value;
  }
  return std::nullopt;
}

void Interpreter::collect(std::map<int, double>& numbers) const {
  offsets_.collect(numbers);
  if (tools_.current() != 0) numbers[kTool] = tools_.current();
}

void Interpreter::preset(int number, double value) {
  if (number == kTool && value >= 0 && value <= 1e6) tools_.preset_current(static_cast<unsigned>(value));
  offsets_.preset(number, value);
}

}  // namespace trammel::gcode
