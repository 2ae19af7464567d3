// Numbers of a machine file: their ranges and positions.
#pragma once

#include <cstddef>
#include <string>
#include <toml.hpp>

namespace trammel::machine {

// The source of a text, for messages: a file (with line numbers), or one override.
struct Source {
  std::string name;
  bool has_lines;

  std::string at_line(std::size_t line) const;
  std::string at(const toml::value& value) const { return at_line(value.location().line()); }
};

// The range of a number, its unit and the reason for the range, which ends the error message. The bounds are beyond any
// real machine, and within the values that the card and the planner's doubles represent without loss; within them every
// plan is finite.
struct Range {
  double least;
  double most;
  const char* unit;
  const char* reason;
};

inline constexpr Range kStepsPerMm{1e-3, 1e6, "pulses/mm", "a pulse a metre to a pulse a nanometre"};
inline constexpr Range kSpeed{1e-3, 1e7, "mm/s", "3.6 mm an hour to 10 km/s"};
inline constexpr Range kAcceleration{1e-3, 1e9, "mm/s^2", "1 mm/s in 1,000 s to 100,000 g"};
inline constexpr Range kJerk{1e-3, 1e13, "mm/s^3", "1 mm/s^2 in 1,000 s to 100,000 g in 0.1 ms"};
// 65,535 clocks take less than 100 s at the slowest clock.
inline constexpr Range kPulseTime{1e-3, 1e11, "ns", "a register holds 65,535 clocks, 100 s at the slowest clock"};
inline constexpr Range kDirectionTime{0, 1e11, "ns", "a register holds 65,535 clocks, 100 s at the slowest clock"};
inline constexpr Range kOvertravel{0, 2.2e12, "mm", "2^31 pulses at the coarsest scale"};
inline constexpr Range kFilter{0, 20, "ms", "switches bounce for a few milliseconds"};
inline constexpr Range kDriveDelay{0, 2680, "ms", "a register holds 65,535 times 4,096 clocks, 2.68 s at 100 MHz"};
inline constexpr Range kDriveIdle{0, 680, "s", "a register holds 65,535 times 2^20 clocks, 687 s at 100 MHz"};
inline constexpr Range kChargePump{10, 1e5, "Hz", "charge pumps take some kilohertz"};
inline constexpr Range kPlace{-2.2e12, 2.2e12, "mm", "2^31 pulses at the coarsest scale"};

// The value, if it is a finite number; otherwise throws a MachineError with file and line.
double number(const Source& source, const std::string& path, const toml::value& value);
// The same, and checks the range.
double number(const Source& source, const std::string& path, const toml::value& value, const Range& range);

}  // namespace trammel::machine
