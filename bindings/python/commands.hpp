// The command object of the Python module.
#pragma once

#include "trammel/driver/commands.hpp"

namespace trammel::python {

// Wraps the variant, because nanobind would convert a bare variant to one of its alternatives.
struct PythonCommand {
  driver::Command command;
};

}  // namespace trammel::python
