// Finds the place at which a run was interrupted, from the card's record of its stop. Pure, thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trammel/driver/card_state.hpp"
#include "trammel/run/run_settings.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {

// The beginning of a run.
struct RunBegin {
  RunSettings::Place place;
  std::uint64_t first = 0;  // counted commands of the program before the first one that is sent
  bool silent = false;      // the run begins with a silent feed piece
};
// The beginning of a planned run with these settings.
RunBegin begin_of(const RunSettings& settings, const Plan& plan);

// The place at which the run was interrupted. `zero`: MACHINE_ZERO by axis of the card. None if the card cut a motion,
// because the tick of the stop is then unknown. If the card stopped before the first step, the result is the place at
// which the run begins.
std::optional<RunSettings::Place> place_of(const RunBegin& begin, const driver::Rest& rest,
                                           const std::array<std::int32_t, card_map::kMaxAxes>& zero = {});

}  // namespace trammel::run
