// The build numbers of simulated cards (sim/CMakeLists.txt gives the RTL the same numbers). Internal to the simulated
// cards and their lockstep.
#pragma once

#include "trammel/model/card_model.hpp"

namespace trammel::sim {

// Only the cards with 3 axes have build numbers, so that the lockstep tests registers with and without them.
inline void set_build_numbers(model::CardModel::Config& config) {
  if (config.axes != 3) return;
  config.build_id = 0x89AB'CDEF;
  config.build_dirty = true;
  config.board_id = 0x7654'3210;
}

}  // namespace trammel::sim
