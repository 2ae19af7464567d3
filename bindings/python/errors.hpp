// The module's exceptions.
#pragma once

#include "module.hpp"

namespace trammel::python {

struct ErrorTypes {
  nb::handle error, link, identification, refused, fault, state, held, stopped, interrupted, argument, timeout, homing;
};
inline ErrorTypes error_types;  // live as long as the module, which Python never unloads

}  // namespace trammel::python
