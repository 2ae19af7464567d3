// The card under test in the scenarios.
#pragma once

#include <cstdint>
#include <optional>

#include "build_numbers.hpp"
#include "lockstep_card.hpp"

namespace trammel::test {

// In lockstep with its golden model, just after reset. `idle_level`: strap, {second pins, first pins}.
inline sim::LockstepCard card_under_test(unsigned axes, std::uint64_t seed, std::uint32_t idle_level) {
  model::CardModel::Config config;
  config.engines = model::RegisterFile::kMaxEngines;
  config.axes = axes;
  config.inputs = sim::kInputs;
  config.idle_level = idle_level & ((1U << 2 * axes) - 1);
  sim::set_build_numbers(config);
  return {sim::make_verilated_card(axes, {config.clock_hz, config.idle_level}, std::nullopt), config, seed};
}

}  // namespace trammel::test
