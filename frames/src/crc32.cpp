#include "trammel/frames/crc32.hpp"

#include <array>

namespace trammel::frames {

namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320;  // 0x04C11DB7 with its bits reversed

constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t state = byte;
    for (int bit = 0; bit < 8; ++bit) state = state >> 1 ^ ((state & 1) != 0 ? kPolynomial : 0);
    table[byte] = state;
  }
  return table;
}

constexpr std::array<std::uint32_t, 256> kTable = make_table();

}  // namespace

void Crc32::add(std::uint8_t byte) { state_ = state_ >> 8 ^ kTable[(state_ ^ byte) & 0xFF]; }

std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count) {
  Crc32 crc;
  for (std::size_t i = 0; i < count; ++i) crc.add(bytes[i]);
  return crc.value();
}

}  // namespace trammel::frames
