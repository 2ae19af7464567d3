// A command of the stream as Python holds it.
#pragma once

#include "trammel/driver/commands.hpp"

namespace trammel::python {

// nanobind would take a variant apart into its alternatives.
struct PythonCommand {
  driver::Command command;
};

}  // namespace trammel::python
