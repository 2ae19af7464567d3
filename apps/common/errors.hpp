// A subcommand throws it for unusable input: exit status 2. Any other exception gives exit status 1.
#pragma once

#include <stdexcept>

namespace trammel::app {

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;

}  // namespace trammel::app
