// The options that name a curve, for every subcommand that takes one.
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
  // The one curve that was named. Throws UsageError when there is none, more than one, or one that no method can do.
  interpolation::Curve curve() const;
};

// The second paper's f and v, for the methods that know clocks.
struct VelocityChoice {
  std::optional<std::uint64_t> clock_hz;
  std::optional<std::uint64_t> velocity;

  void add_to(CLI::App& command);
  // 10 MHz and 5000 lines a second where not given; a default velocity that a long line cannot keep is lowered to one
  // pulse in two clocks on its longest axis.
  interpolation::Options options(const interpolation::Curve& curve) const;
};

}  // namespace trammel::app
