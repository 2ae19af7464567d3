// The interpolators by name, and the capabilities of each.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace trammel::interpolation {

enum class Method {
  kSteer,          // Goldberg & Goldberg: sign of F, Table 2
  kPointByPoint,   // textbook point by point: F = xe*y - ye*x
  kMinF4,          // 4 directions, the step that leaves the smaller |F|
  kMinDeviation8,  // 8 directions, minimum deviation
  kDda,            // digital differential analyser, accumulators start at 0
  kDdaHalf,        // the same, accumulators start at one half
  kOneShot,        // one-shot velocity, phase starts at one half: the method of the card
  kOneShotZero,    // one-shot velocity, phase starts at 0
  kDivider,        // one-shot velocity with integer clock dividers: the counter-example
  kRotation,       // arc generator: chords by rotation
};
inline constexpr unsigned kMethodCount = 10;

struct MethodInfo {
  Method method;
  std::string_view name;
  std::string_view brief;
  unsigned line_axes;          // maximum axes of a line; 0: no lines
  bool circles;                // full circles and arcs of circles
  bool ellipses;               // full ellipses and arcs of ellipses
  std::string_view time_unit;  // unit of time(): "step", "iteration", "clock" or "tick"
  bool deviation;              // the method has an F
};

// In the order of the enumeration.
const std::array<MethodInfo, kMethodCount>& methods();

const MethodInfo& info(Method method);

// Nothing if no method has that name.
std::optional<Method> method_named(std::string_view name);

}  // namespace trammel::interpolation
