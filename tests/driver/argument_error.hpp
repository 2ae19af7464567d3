// What a call says of its arguments, for tests.
#pragma once

#include <string>

#include "trammel/driver/errors.hpp"

namespace trammel::driver {

// The message of the ArgumentError that it throws; empty when it throws none.
template <typename Call>
std::string argument_error(Call call) {
  try {
    call();
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "";
}

}  // namespace trammel::driver
