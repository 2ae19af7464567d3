// What is wrong with the line being read. Internal to the reader, which adds the place.
#pragma once

#include <string>
#include <utility>

#include "trammel/gcode/error.hpp"

namespace trammel::gcode {

struct Problem {
  ErrorCode code{};
  std::string message;
  std::string unknown;  // the word at the beginning of the line that is refused, where it could be left out

  // False, so that a function that fails can return it.
  bool set(ErrorCode wrong, std::string what) {
    code = wrong;
    message = std::move(what);
    unknown.clear();
    return false;
  }
};

}  // namespace trammel::gcode
