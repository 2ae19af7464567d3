// Records the steps and output changes of a card, for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/driver/steps.hpp"

namespace trammel::test {

class Steps final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& step) override { pins.push_back(step); }
  void path_step(const driver::PathStep& step) override { path.push_back(step); }
  void outputs_changed(const driver::OutputChange& change) override { outputs.push_back(change); }

  // Position of an axis relative to its start, pulses: the sum of its steps at the pins up to and including `cycle`.
  std::int64_t position(std::size_t axis, std::uint64_t cycle = ~std::uint64_t{0}) const {
    std::int64_t sum = 0;
    for (const driver::PinStep& step : pins) sum += step.axis == axis && step.cycle <= cycle ? step.direction : 0;
    return sum;
  }

  std::vector<driver::PinStep> pins;
  std::vector<driver::PathStep> path;
  std::vector<driver::OutputChange> outputs;
};

}  // namespace trammel::test
