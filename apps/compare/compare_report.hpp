// The results of `trammel compare`, as tables and as JSON. The measures are defined in trammel/model/measure and in
// docs/user/compare.md.
#pragma once

#include <string>
#include <vector>

#include "trammel/interpolation/curve.hpp"
#include "trammel/measure/comparison.hpp"
#include "trammel/measure/motor.hpp"

namespace trammel::app {

struct Refusal {
  interpolation::Method method;
  std::string reason;
};

struct Comparison {
  std::string title;
  std::size_t axes = 2;
  double length = 0;  // pulses
  bool is_line = true;
  interpolation::Options options;
  std::vector<measure::MethodMeasures> methods;
  std::vector<Refusal> refused;  // methods for this kind of curve that cannot execute this one
  measure::MotorRun motor;
  std::vector<double> speeds;                           // pulses/s
  std::vector<std::vector<measure::Vibration>> sweeps;  // by method, by speed
};

std::string table_of(const Comparison& comparison);
std::string json_text(const Comparison& comparison);

std::string table_of(const measure::RandomLines& lines, const std::vector<measure::RandomMeasures>& measures);
std::string json_text(const measure::RandomLines& lines, const std::vector<measure::RandomMeasures>& measures);

}  // namespace trammel::app
