// Where a run was interrupted, from what the card has kept of its stop. Pure, thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "trammel/driver/card_state.hpp"
#include "trammel/run/run_settings.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::run {

// How a run begins.
struct RunBegin {
  RunSettings::Place place;
  std::uint64_t first = 0;  // counted commands of the program before the first one that is sent
  bool silent = false;      // it begins with a silent piece
};
// Of a run with these settings, as it was planned.
RunBegin begin_of(const RunSettings& settings, const Plan& plan);

// `zero`: MACHINE_ZERO by axis of the card. None where the card stopped at once in a motion: at which tick it stands is
// not known then. A stop before the first step leaves the run at its begin.
std::optional<RunSettings::Place> place_of(const RunBegin& begin, const driver::Rest& rest,
                                           const std::array<std::int32_t, card_map::kMaxAxes>& zero = {});

}  // namespace trammel::run
