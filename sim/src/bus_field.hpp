// A field of one of the RTL's bundles, in the words or integers that Verilator uses for a port.
#pragma once

#include <cstdint>
#include <type_traits>

namespace trammel::bus {

struct Field {
  unsigned offset;  // index of the lowest bit
  unsigned bits;    // 1 to 64
};

constexpr std::uint64_t mask_of(const Field& field) {
  return field.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.bits) - 1;
}

// The field's value. `port` is an integer, or wide: 32-bit words, lowest first.
template <class Port>
std::uint64_t get(const Port& port, const Field& field) {
  if constexpr (std::is_integral_v<Port>) {
    return std::uint64_t{port} >> field.offset & mask_of(field);
  } else {
    std::uint64_t value = 0;
    for (unsigned bit = 0; bit < field.bits;) {
      const unsigned at = field.offset + bit;
      value |= std::uint64_t{port[at / 32] >> at % 32} << bit;
      bit += 32 - at % 32;
    }
    return value & mask_of(field);
  }
}

// The same field in one of several equal bundles side by side, offset by `base` bits.
constexpr Field up(const Field& field, unsigned base) { return {field.offset + base, field.bits}; }

// The value shifted to the field's position; bits above the field are dropped.
constexpr std::uint64_t in_place(const Field& field, std::uint64_t value) {
  return (value & mask_of(field)) << field.offset;
}

// Sets a field of a port, integer or wide.
template <class Port>
void put(Port& port, const Field& field, std::uint64_t value) {
  if constexpr (std::is_integral_v<Port>) {
    port = static_cast<Port>((port & ~(mask_of(field) << field.offset)) | in_place(field, value));
  } else {
    for (unsigned bit = 0; bit < field.bits; ++bit) {
      const unsigned at = field.offset + bit;
      const std::uint32_t one = std::uint32_t{1} << at % 32;
      port[at / 32] = (value >> bit & 1) != 0 ? port[at / 32] | one : port[at / 32] & ~one;
    }
  }
}

}  // namespace trammel::bus
