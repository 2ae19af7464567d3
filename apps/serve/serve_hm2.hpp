// `trammel serve --hm2`: the simulated card in front of LinuxCNC's driver hm2_eth.
#pragma once

#include "served_card.hpp"

namespace trammel::app {

// Until a signal; with --once until the first driver has gone.
void serve_hm2(const ServeOptions& options);

}  // namespace trammel::app
