// The error in the line being read. Internal to the reader, which adds file and line.
#pragma once

#include <string>
#include <utility>

#include "trammel/gcode/error.hpp"

namespace trammel::gcode {

struct Problem {
  ErrorCode code{};
  std::string message;
  std::string unknown;  // the refused word at the beginning of the line, if its lines may be left out

  // Returns false, so that a failing function can return it.
  bool set(ErrorCode wrong, std::string what) {
    code = wrong;
    message = std::move(what);
    unknown.clear();
    return false;
  }
};

}  // namespace trammel::gcode
