#include "curve_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "engine_options.hpp"
#include "errors.hpp"
#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::app {
namespace {

namespace interpolation = interpolation;
using interpolation::Arc;
using interpolation::Curve;

// Converts `text` to `count` integers separated by commas. Throws UsageError.
std::vector<std::int64_t> numbers(const char* option, std::string_view text, std::size_t count) {
  std::vector<std::int64_t> result;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    std::int64_t value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error == std::errc::result_out_of_range)
      throw UsageError(fmt::format("{} {}: a number does not fit in 64 bits", option, text));
    if (error != std::errc{}) throw UsageError(fmt::format("{} {}: not whole numbers of pulses", option, text));
    result.push_back(value);
    at = next;
    if (at == end) break;
    if (*at != ',') throw UsageError(fmt::format("{} {}: not whole numbers of pulses", option, text));
    ++at;
  }
  if (result.size() != count) {
    throw UsageError(fmt::format("{} {}: {} numbers given, {} needed", option, text, result.size(), count));
  }
  return result;
}

Curve named(const CurveChoice& choice) {
  if (choice.line) {
    const auto v = numbers("--line", *choice.line, 4);
    return interpolation::make_line({v[0], v[1]}, {v[2], v[3]});
  }
  if (choice.circle) return interpolation::make_circle(numbers("--circle", *choice.circle, 1)[0], choice.clockwise);
  if (choice.arc) {
    const auto v = numbers("--arc", *choice.arc, 6);
    return Arc{{v[2], v[3]}, {v[0], v[1]}, {v[4], v[5]}, choice.clockwise, 0, 0};
  }
  const auto v = numbers("--ellipse", *choice.ellipse, 2);
  if (v[0] < 1 || v[1] < 1)
    throw UsageError(fmt::format("--ellipse {}: each semi-axis must be 1 pulse or more", *choice.ellipse));
  return interpolation::make_ellipse(v[0], v[1], choice.clockwise);
}

}  // namespace

void CurveChoice::add_to(CLI::App& command) {
  command.add_option("--line", line, "line from X0,Y0 to X1,Y1, pulses")->type_name("X0,Y0,X1,Y1");
  command.add_option("--circle", circle, "full circle about (0,0), begun at (R,0), pulses")->type_name("R");
  command
      .add_option(
          "--arc", arc,
          "arc from X0,Y0 about the centre CX,CY to X1,Y1, pulses. If end and start are equal, it is a full circle")
      ->type_name("X0,Y0,CX,CY,X1,Y1");
  command
      .add_option("--ellipse", ellipse,
                  "full ellipse about (0,0), begun at (A,0), with semi-axis A along x and B along y, pulses")
      ->type_name("A,B");
  command.add_flag("--clockwise", clockwise,
                   "run along the curve clockwise, with x to the right and y up (default: counter-clockwise)");
}

Curve CurveChoice::curve() const {
  const int count = line.has_value() + circle.has_value() + arc.has_value() + ellipse.has_value();
  if (count != 1) throw UsageError("give one of --line, --circle, --arc and --ellipse");
  if (circle && numbers("--circle", *circle, 1)[0] < 0) throw UsageError("--circle: the radius must not be negative");
  const Curve result = named(*this);
  try {
    interpolation::check_curve(result);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return result;
}

void VelocityChoice::add_to(CLI::App& command) {
  // The range of make_interpolator().
  constexpr std::uint64_t kMax = std::uint64_t{1} << 30;
  command.add_option("--clock", clock_hz, "clock of the one-shot and divider methods (default 10000000)")
      ->transform(whole_number(1, kMax, "Hz"))
      ->type_name("HZ");
  command.add_option("--velocity", velocity, "lines per second, v of the second paper (default 5000)")
      ->transform(whole_number(1, kMax, "lines/s"));
}

interpolation::Options VelocityChoice::options(const Curve& curve) const {
  interpolation::Options result;
  if (clock_hz) result.clock_hz = *clock_hz;
  if (velocity) {
    result.velocity = *velocity;
    return result;
  }
  const auto* line_curve = std::get_if<interpolation::Line>(&curve);
  if (line_curve == nullptr) return result;
  const std::uint64_t longest = interpolation::longest_axis(*line_curve);
  if (result.clock_hz == 0 || longest <= result.clock_hz / result.velocity) return result;
  // clock * 2 * longest / clock clocks; divisor and velocity stay within the ranges of make_interpolator().
  if (result.clock_hz > static_cast<std::uint64_t>(interpolation::kMaxLine)) return result;
  result.velocity = result.clock_hz;
  result.velocity_divisor = 2 * longest;
  return result;
}

}  // namespace trammel::app
