// What `trammel compare` found, as tables and as JSON. The measures are defined in trammel/model/measure and in
// docs/user/compare.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trammel/model/interpolation/curve.hpp"
#include "trammel/model/measure/comparison.hpp"
#include "trammel/model/measure/motor.hpp"

namespace trammel::app {

struct Refusal {
  model::interpolation::Method method;
  std::string reason;
};

struct Comparison {
  std::string title;
  std::size_t axes = 2;
  double length = 0;  // pulses
  bool is_line = true;
  model::interpolation::Options options;
  std::vector<model::measure::MethodMeasures> methods;
  std::vector<Refusal> refused;  // methods of this kind of curve that cannot do this one
  model::measure::MotorRun motor;
  std::vector<double> speeds;                                  // pulses/s
  std::vector<std::vector<model::measure::Vibration>> sweeps;  // by method, by speed
};

std::string table_of(const Comparison& comparison);
nlohmann::ordered_json json_of(const Comparison& comparison);

std::string table_of(const model::measure::RandomLines& lines,
                     const std::vector<model::measure::RandomMeasures>& measures);
nlohmann::ordered_json json_of(const model::measure::RandomLines& lines,
                               const std::vector<model::measure::RandomMeasures>& measures);

}  // namespace trammel::app
