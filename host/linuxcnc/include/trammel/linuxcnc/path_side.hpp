// Who moves the card while LinuxCNC's planner module commands it by path operations (TRAMMEL_PERIOD_PATH).
//
// The bridge calls serve() when a period asks for the path: the card then stands, is not faulted, and has no stream
// open. serve() moves the card, and calls `meanwhile` at each of its turns. It returns when `meanwhile` has returned
// false and the card stands: before that it brings the card to rest on the path. Exceptions: driver::Error for what the
// link or the card does; the bridge then reports the fault, and calls serve() again only when it was cleared.
//
// Thread-safety: all calls come from the thread that uses the card.
#pragma once

#include <functional>
#include <memory>

#include "trammel/driver/card.hpp"
#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

class PathSide {
 public:
  virtual ~PathSide() = default;

  // `meanwhile` is the bridge's turn: it takes the periods that have come (their targets move nothing), publishes the
  // status, and returns false once the path is no longer asked for, the machine is off, or the owner shall end. It
  // takes up to about 1 ms and is to be called at least each 5 ms.
  virtual void serve(const std::function<bool()>& meanwhile) = 0;

  // The fields of `status` that belong to the path, from operations_done on; `text` where an operation was refused; and
  // TRAMMEL_STATUS_AT_REST, which it sets among the flags and never clears. Called before each publication, inside
  // serve() and outside.
  virtual void report(trammel_status& status) const = 0;
};

// Refuses each operation by name: for an owner that is built without a planner. `region` must outlive it; it takes
// operations only inside serve(), and holds the card where it stands.
std::unique_ptr<PathSide> refuse_paths(trammel_region& region);

}  // namespace trammel::linuxcnc
