// Moves the card while LinuxCNC's planner module commands it by path operations (TRAMMEL_PERIOD_PATH). All calls come
// from the thread that uses the card.
#pragma once

#include <chrono>
#include <functional>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

// LinuxCNC's usual servo period. The bus below a PathSide never sleeps longer without a look at the shared memory.
inline constexpr std::chrono::nanoseconds kServoPeriod = std::chrono::milliseconds(1);

class PathSide {
 public:
  virtual ~PathSide() = default;
  // At the call the card is at rest, has no fault, and has no stream open. Runs path operations until `meanwhile`,
  // which is called about once per millisecond, returns false. The card is then at rest again; if it moved, it was
  // stopped on the path. Throws driver::Error for errors of the link or the card, and exceptions of `meanwhile`.
  virtual void serve(const std::function<bool()>& meanwhile) = 0;
  // Writes the fields of `status` that belong to the path, from operations_done on; `text` if a path was refused; and
  // TRAMMEL_STATUS_AT_REST in the flags, which it sets or clears. May be called from within `meanwhile` and outside.
  virtual void write_status(trammel_status& status) const = 0;
};

}  // namespace trammel::linuxcnc
