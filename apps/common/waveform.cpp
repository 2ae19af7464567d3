#include "waveform.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <stdexcept>

namespace trammel::app {

void require_whole_waveform(const std::string& path, const std::string& name) {
  constexpr int kHeader = 0;
  constexpr int kGeometry = 3;
  constexpr int kHierarchies[] = {4, 6, 7};  // three compression formats
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(in.tellg(), 0));
  std::uint64_t at = 0;
  bool geometry = false;
  bool hierarchy = false;
  bool sound = in.good();
  while (sound && at < size) {
    std::array<unsigned char, 9> head{};  // kind; length of the rest, including its own 8 bytes
    in.seekg(static_cast<std::streamoff>(at));
    in.read(reinterpret_cast<char*>(head.data()), head.size());
    std::uint64_t length = 0;
    for (std::size_t i = 1; i < head.size(); ++i) length = length << 8U | head[i];
    sound = in.good() && length >= 8 && length < size - at && (at != 0 || head[0] == kHeader);
    geometry |= head[0] == kGeometry;
    for (const int kind : kHierarchies) hierarchy |= head[0] == kind;
    at += length + 1;
  }
  if (!sound || !geometry || !hierarchy) {
    throw std::runtime_error(fmt::format("{}: the waveform could not be written to its end", name));
  }
}

}  // namespace trammel::app
