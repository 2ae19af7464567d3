// Who moves the card while LinuxCNC's planner module commands it by path operations (TRAMMEL_PERIOD_PATH). All calls
// come from the thread that uses the card.
#pragma once

#include <chrono>
#include <functional>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

// LinuxCNC's, as a rule: the bus below a PathSide sleeps no longer without a look at the shared memory.
inline constexpr std::chrono::nanoseconds kServoPeriod = std::chrono::milliseconds(1);

class PathSide {
 public:
  virtual ~PathSide() = default;
  // The card stands at the call, is not faulted, and has no stream open. Runs path operations until `meanwhile`, which
  // is called about once a millisecond, gives false; the card then stands again, stopped on the path if it moved.
  // Throws driver::Error for what the link or the card does, and what `meanwhile` throws.
  virtual void serve(const std::function<bool()>& meanwhile) = 0;
  // The fields of `status` that belong to the path, from operations_done on; `text` where a path was refused; and
  // TRAMMEL_STATUS_AT_REST among the flags, which it sets or clears. From within `meanwhile` and outside.
  virtual void write_status(trammel_status& status) const = 0;
};

}  // namespace trammel::linuxcnc
