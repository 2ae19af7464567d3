// The error message of a call, for tests.
#pragma once

#include <string>

#include "trammel/driver/errors.hpp"

namespace trammel::driver {

// The message of the ErrorType that `call` throws; empty if it throws nothing. Other exceptions pass through.
template <typename ErrorType, typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const ErrorType& error) {
    return error.what();
  }
  return "";
}

template <typename Call>
std::string argument_error(Call call) {
  return message_of<ArgumentError>(call);
}

}  // namespace trammel::driver
