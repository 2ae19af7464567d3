// `trammel serve --hm2`: the simulated card in front of LinuxCNC's driver hm2_eth.
#pragma once

#include "served_card.hpp"

namespace trammel::app {

// Serves until a signal arrives; with --once until the first driver has disconnected.
void serve_hm2(const ServeOptions& options);

}  // namespace trammel::app
