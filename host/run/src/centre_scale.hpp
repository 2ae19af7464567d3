// Internal to the runner.
#pragma once

#include "trammel/card_map.hpp"

namespace trammel::run {

// An arc's centre is given in units of 1/kCentreScale pulse.
constexpr double kCentreScale = 1U << card_map::constant::kCentreFractionBits;

}  // namespace trammel::run
