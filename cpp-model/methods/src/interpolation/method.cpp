#include "trammel/interpolation/method.hpp"

namespace trammel::interpolation {

const std::array<MethodInfo, kMethodCount>& methods() {
  static constexpr std::array<MethodInfo, kMethodCount> kMethods{{
      {Method::kSteer, "steer", "Goldberg & Goldberg: sign of F, 16-entry table", 2, true, true, "step", true},
      {Method::kPointByPoint, "point-by-point", "textbook point by point: F = xe*y - ye*x", 2, false, false, "step",
       true},
      {Method::kMinF4, "min-f-4", "4 directions, the step that leaves the smaller |F|", 2, false, false, "step", true},
      {Method::kMinDeviation8, "min-deviation-8", "8 directions, minimum deviation", 4, true, true, "step", true},
      {Method::kDda, "dda", "digital differential analyser, accumulators start at 0", 4, true, false, "iteration",
       false},
      {Method::kDdaHalf, "dda-half", "digital differential analyser, accumulators start at one half", 4, true, false,
       "iteration", false},
      {Method::kOneShot, "one-shot", "one-shot velocity, phase starts at one half: what the card does", 4, false, false,
       "clock", false},
      {Method::kOneShotZero, "one-shot-zero", "one-shot velocity, phase starts at 0", 4, false, false, "clock", false},
      {Method::kDivider, "divider", "one-shot velocity by integer clock dividers: the counter-example", 4, false, false,
       "clock", false},
      {Method::kRotation, "rotation", "arc generator: chords by rotation", 0, true, false, "tick", false},
  }};
  return kMethods;
}

const MethodInfo& info(Method method) { return methods()[static_cast<std::size_t>(method)]; }

std::optional<Method> method_named(std::string_view name) {
  for (const MethodInfo& entry : methods()) {
    if (entry.name == name) return entry.method;
  }
  return std::nullopt;
}

}  // namespace trammel::interpolation
