#include "calibration.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdlib>

#include "common/errors.hpp"
#include "trammel/machine/scale.hpp"

namespace trammel::app {
namespace {

using machine::Machine;
using machine::MachineAxis;

// A ratio outside these bounds indicates a wrong setting of the drive or a wrong unit; a scale must not hide that.
constexpr double kLeastRatio = 0.5;
constexpr double kMostRatio = 2;

bool is_rotary(char letter) { return letter == 'A' || letter == 'B' || letter == 'C'; }

char letter_of(const Measured& measured, const Machine& machine) {
  const char letter =
      measured.axis.size() == 1 ? static_cast<char>(std::toupper(static_cast<unsigned char>(measured.axis[0]))) : ' ';
  if (!machine.axis(letter))
    throw UsageError(fmt::format("calibrate: the machine has no axis {}", measured.axis.substr(0, 40)));
  return letter;
}

void check_distances(const Measured& measured, char letter) {
  const double ratio = measured.actual / measured.commanded;
  if (!std::isfinite(ratio) || ratio == 0)
    throw UsageError("calibrate: COMMANDED and MEASURED must be distances other than 0");
  if (ratio < 0) {
    throw UsageError(
        fmt::format("calibrate: {} moved in the opposite direction. Change `inverted` in [axis.{}], then measure again",
                    letter, static_cast<char>(std::tolower(static_cast<unsigned char>(letter)))));
  }
  if (measured.force || (ratio >= kLeastRatio && ratio <= kMostRatio)) return;
  throw UsageError(
      fmt::format("calibrate: {} moved {:.4g} times as far as commanded, outside {} to {}. Check the drive's microstep "
                  "switches and the units; if the distances are right, give --force",
                  letter, ratio, kLeastRatio, kMostRatio));
}

// With crossed belts both motors move X and Y, so only a factor for both corrects the measured axis.
std::string letters_to_change(const Machine& machine, char letter) {
  const bool belts = machine.kinematics.name == "corexy" && (letter == 'X' || letter == 'Y');
  return belts ? "XY" : std::string(1, letter);
}

// Positions that were possibly measured on the axis in the old scale, and are slightly wrong now.
std::string doubt_about(const MachineAxis& axis) {
  const bool limits = std::isfinite(axis.min) || std::isfinite(axis.max);
  if (!limits && !axis.homing) return {};
  return fmt::format(
      "{}{}{} of axis {} were not changed. Measure again those that you read off the machine in the old scale",
      limits ? "min and max" : "", limits && axis.homing ? " and " : "", axis.homing ? "[homing] distances" : "",
      axis.letter);
}

}  // namespace

Calibration calibrate(const Measured& measured, const std::string& text, const std::string& name) {
  const Machine machine = machine::parse_machine(text, name);
  const char letter = letter_of(measured, machine);
  check_distances(measured, letter);
  const char* const unit = is_rotary(letter) ? "degrees" : "mm";
  Calibration result{
      text,
      fmt::format("{}: {:g} {} commanded, {:g} {} measured", letter, measured.commanded, unit, measured.actual, unit),
      {},
      measured.commanded != measured.actual};
  if (!result.changed) {
    result.said += ": steps_per_mm is right as it is\n";
    return result;
  }
  result.said += fmt::format(", {:+.3g} %\n", 100 * (measured.actual / measured.commanded - 1));
  for (const char each : letters_to_change(machine, letter)) {
    const MachineAxis& axis = machine.axes[*machine.axis(each)];
    const std::string number = machine::calibrated_scale(axis.steps_per_mm, measured.commanded, measured.actual);
    const machine::ChangedText changed = machine::with_steps_per_mm(result.text, name, each, number);
    result.text = changed.text;
    result.said += fmt::format("{}: steps_per_mm {:g} -> {} ({:+.3g} %)\n{}:{}: {}\n", each, axis.steps_per_mm, number,
                               100 * (std::strtod(number.c_str(), nullptr) / axis.steps_per_mm - 1), name, changed.line,
                               changed.line_is_now);
    if (each == letter) result.doubt = doubt_about(axis);
  }
  return result;
}

}  // namespace trammel::app
