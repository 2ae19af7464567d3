#include "text_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "trammel/world/world_file.hpp"

namespace trammel::world {

std::string text_of_file(const std::string& path, const char* what) {
  if (path.empty()) throw WorldError(fmt::format("the {} file has no name", what));
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::array<char, 4096> part{};
  while (file && text.size() <= kLongestWorldText) {
    file.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad() || (!file.eof() && text.size() <= kLongestWorldText)) {
    throw WorldError(fmt::format("{}: cannot read the {} file: {}", path, what, std::strerror(errno)));
  }
  if (text.size() > kLongestWorldText) {
    throw WorldError(fmt::format("{}:1: longer than {} bytes: no {} file", path, kLongestWorldText, what));
  }
  return text;
}

}  // namespace trammel::world
