// CRC-32 as in Ethernet and zlib: polynomial 0x04C11DB7, lowest bit first, initial value all ones, inverted at the end.
// Check value: "123456789" gives 0xCBF43926.
#pragma once

#include <cstddef>
#include <cstdint>

namespace trammel::frames {

class Crc32 {
 public:
  // The register after data followed by their CRC, lowest byte first: the same value for all undamaged data.
  static constexpr std::uint32_t kResidue = 0xDEBB20E3;

  void add(std::uint8_t byte);
  std::uint32_t value() const { return ~state_; }
  bool whole() const { return state_ == kResidue; }
  std::uint32_t state() const { return state_; }

 private:
  std::uint32_t state_ = 0xFFFFFFFF;
};

std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count);

}  // namespace trammel::frames
