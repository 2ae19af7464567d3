// What the owner of the card needs of whoever runs path operations. One thread.
#pragma once

#include <functional>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

class PathSide {
 public:
  virtual ~PathSide() = default;
  // Runs path operations until `meanwhile`, which is called about once a millisecond, gives false; the card stands
  // then.
  virtual void serve(const std::function<bool()>& meanwhile) = 0;
  // The part of the status that tells of path operations.
  virtual void write_status(trammel_status& status) const = 0;
};

}  // namespace trammel::linuxcnc
