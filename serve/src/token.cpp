#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "trammel/serve/card_server.hpp"

namespace trammel::serve {

std::string random_token() {
  std::random_device random;  // the system's random numbers
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", random());
  return token;
}

bool is_token(const std::string& text) {
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  };
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), fits);
}

}  // namespace trammel::serve
