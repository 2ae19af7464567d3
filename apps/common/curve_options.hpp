// The options that define a curve, for every subcommand with a curve.
#pragma once

#include <optional>
#include <string>

#include "command_line.hpp"
#include "trammel/interpolation/curve.hpp"

namespace trammel::app {

struct CurveChoice {
  std::optional<std::string> line;
  std::optional<std::string> circle;
  std::optional<std::string> arc;
  std::optional<std::string> ellipse;
  bool clockwise = false;

  void add_to(CLI::App& command);
  bool given() const { return line || circle || arc || ellipse; }
  // The curve. Throws UsageError if none or more than one is given, or if no method supports it.
  interpolation::Curve curve() const;
};

// The second paper's f and v, for the methods that count clocks.
struct VelocityChoice {
  std::optional<std::uint64_t> clock_hz;
  std::optional<std::uint64_t> velocity;

  void add_to(CLI::App& command);
  // Defaults: 10 MHz and 5000 lines per second. If a long line cannot be made at the default velocity, it is lowered to
  // one pulse in two clocks on the longest axis.
  interpolation::Options options(const interpolation::Curve& curve) const;
};

}  // namespace trammel::app
