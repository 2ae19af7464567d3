// Internal to the runner.
#pragma once

#include "trammel/card_map.hpp"

namespace trammel::run {

// Parts of a pulse in which an arc's centre is given.
constexpr double kCentreScale = 1U << card_map::constant::kCentreFractionBits;

}  // namespace trammel::run
