// LBP16, the protocol of Mesa's Ethernet cards: a datagram is a sequence of reads and writes of memory spaces; the
// answer is the data of its reads, in order. Numbers are little-endian. Source of the facts: LinuxCNC's driver hm2_eth
// (src/hal/drivers/mesa-hostmot2/lbp16.h). Pure functions and plain data, thread-safe.
//
// A command is a word of 16 bits, an address of 16 bits, and for a write its data:
//
//   bit 15     write
//   bit 14     an address follows; commands without one are refused: they continue from the address of the previous
//              datagram, which may have been lost
//   bit 13     read the description of a space; refused
//   bits 12-10 space
//   bits 9-8   unit: 1, 2, 4 or 8 bytes
//   bit 7      the address increments with each unit
//   bits 6-0   number of units, 1 to 127
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace trammel::hm2 {

using Bytes = std::vector<std::uint8_t>;

inline constexpr std::uint16_t kUdpPort = 27181;
// Size of the largest datagram in one Ethernet frame of 1,500 bytes.
inline constexpr std::size_t kMaxDatagram = 1472;
inline constexpr unsigned kMaxUnits = 127;

enum class Space : std::uint8_t { kHostmot2 = 0, kEeprom = 2, kTimer = 4, kControl = 6, kInfo = 7 };

struct Command {
  bool write = false;
  bool increment = false;
  std::uint8_t space = 0;              // 0 to 7; Space names the spaces of this card
  std::uint8_t unit = 4;               // bytes: 1, 2, 4, 8
  std::uint8_t units = 1;              // 1 to kMaxUnits
  std::uint16_t address = 0;           // bytes
  const std::uint8_t* data = nullptr;  // data of a write: size() bytes, inside the datagram
  std::size_t size() const { return std::size_t{unit} * units; }
  // Number of bytes of its space that the command covers.
  std::size_t reach() const { return increment ? size() : unit; }
};

// Why a datagram is refused as a whole.
enum class Defect : std::uint8_t {
  kNone,
  kShort,         // the datagram ends inside a command, or has none
  kForm,          // no address, a read of a space's description, or no unit
  kSpace,         // a space, or a part of one, that the card does not have
  kUnit,          // a unit that the space does not support
  kAlignment,     // an address that is not a multiple of the unit
  kReadOnly,      // a write to a read-only space
  kAnswerTooLong  // more than kMaxDatagram bytes
};
inline constexpr unsigned kDefects = 8;
const char* name_of(Defect defect);

// Splits a datagram into commands; `commands` is replaced, and points into `bytes`. Does not check whether the spaces
// exist.
Defect decode(const std::uint8_t* bytes, std::size_t size, std::vector<Command>& commands);

std::uint32_t word_of(const std::uint8_t* bytes);
void append_word(Bytes& bytes, std::uint32_t word);

// The driver's side: appends commands with an incrementing address. `units`: 1 to kMaxUnits.
void append_read(Bytes& bytes, Space space, unsigned unit, std::uint16_t address, unsigned units);
void append_write(Bytes& bytes, std::uint16_t address, const std::vector<std::uint32_t>& words);  // to hostmot2
void append_write(Bytes& bytes, Space space, unsigned unit, std::uint16_t address, const Bytes& data);

}  // namespace trammel::hm2
