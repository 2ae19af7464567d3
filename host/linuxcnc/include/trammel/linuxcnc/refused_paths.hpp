// The side for path operations of an owner without a planner: takes each operation, and refuses lines and arcs by
// name. The card stands meanwhile. One thread.
#pragma once

#include <memory>

#include "trammel/linuxcnc/path_side.hpp"

namespace trammel::linuxcnc {

// `region` must outlive it. serve() throws what `meanwhile` throws, and nothing else.
std::unique_ptr<PathSide> refuse_paths(trammel_region& region);

}  // namespace trammel::linuxcnc
