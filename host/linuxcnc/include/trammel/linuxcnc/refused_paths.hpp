// A PathSide for an owner without a planner: takes each operation, and refuses lines and arcs with a message. The card
// is at rest meanwhile. Used by one thread.
#pragma once

#include <memory>

#include "trammel/linuxcnc/path_side.hpp"

namespace trammel::linuxcnc {

// `region` must outlive the returned object. serve() throws only exceptions of `meanwhile`.
std::unique_ptr<PathSide> refuse_paths(trammel_region& region);

}  // namespace trammel::linuxcnc
