#include "trammel/hm2/lbp16.hpp"

namespace trammel::hm2 {
namespace {

constexpr unsigned kWrite = 0x8000;
constexpr unsigned kAddress = 0x4000;
constexpr unsigned kDescription = 0x2000;
constexpr unsigned kSpaceShift = 10;
constexpr unsigned kUnitShift = 8;
constexpr unsigned kIncrement = 0x0080;
constexpr std::size_t kHead = 4;  // command and address

unsigned half_of(const std::uint8_t* bytes) { return bytes[0] | unsigned{bytes[1]} << 8; }

unsigned log_of(unsigned unit) { return unit == 8 ? 3 : unit == 4 ? 2 : unit == 2 ? 1 : 0; }

void append_head(Bytes& bytes, unsigned flags, Space space, unsigned unit, std::uint16_t address, std::size_t units) {
  const unsigned word = flags | kAddress | kIncrement | static_cast<unsigned>(space) << kSpaceShift |
                        log_of(unit) << kUnitShift | static_cast<unsigned>(units);
  for (const unsigned half : {word, unsigned{address}}) {
    bytes.push_back(static_cast<std::uint8_t>(half));
    bytes.push_back(static_cast<std::uint8_t>(half >> 8));
  }
}

}  // namespace

const char* name_of(Defect defect) {
  switch (defect) {
    case Defect::kNone:
      return "good";
    case Defect::kShort:
      return "too short";
    case Defect::kForm:
      return "unknown form of command";
    case Defect::kSpace:
      return "unknown space";
    case Defect::kUnit:
      return "wrong unit";
    case Defect::kAlignment:
      return "odd address";
    case Defect::kReadOnly:
      return "write of a read-only space";
    case Defect::kAnswerTooLong:
      return "answer too long";
  }
  return "?";
}

Defect decode(const std::uint8_t* bytes, std::size_t size, std::vector<Command>& commands) {
  commands.clear();
  std::size_t at = 0;
  std::size_t answer = 0;
  while (at != size) {
    if (size - at < 2) return Defect::kShort;
    const unsigned word = half_of(bytes + at);
    if ((word & kAddress) == 0 || (word & kDescription) != 0 || (word & kMaxUnits) == 0) return Defect::kForm;
    if (size - at < kHead) return Defect::kShort;
    Command command;
    command.write = (word & kWrite) != 0;
    command.increment = (word & kIncrement) != 0;
    command.space = static_cast<std::uint8_t>(word >> kSpaceShift & 7);
    command.unit = static_cast<std::uint8_t>(1U << (word >> kUnitShift & 3));
    command.units = static_cast<std::uint8_t>(word & kMaxUnits);
    command.address = static_cast<std::uint16_t>(half_of(bytes + at + 2));
    at += kHead;
    if (command.write) {
      if (size - at < command.size()) return Defect::kShort;
      command.data = bytes + at;
      at += command.size();
    } else {
      answer += command.size();
    }
    commands.push_back(command);
  }
  if (commands.empty()) return Defect::kShort;
  return answer > kMaxDatagram ? Defect::kAnswerTooLong : Defect::kNone;
}

std::uint32_t word_of(const std::uint8_t* bytes) { return half_of(bytes) | std::uint32_t{half_of(bytes + 2)} << 16; }

void append_word(Bytes& bytes, std::uint32_t word) {
  for (unsigned n = 0; n < 4; ++n) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * n)));
}

void append_read(Bytes& bytes, Space space, unsigned unit, std::uint16_t address, unsigned units) {
  append_head(bytes, 0, space, unit, address, units);
}

void append_write(Bytes& bytes, std::uint16_t address, const std::vector<std::uint32_t>& words) {
  append_head(bytes, kWrite, Space::kHostmot2, 4, address, words.size());
  for (const std::uint32_t word : words) append_word(bytes, word);
}

void append_write(Bytes& bytes, Space space, unsigned unit, std::uint16_t address, const Bytes& data) {
  append_head(bytes, kWrite, space, unit, address, data.size() / unit);
  bytes.insert(bytes.end(), data.begin(), data.end());
}

}  // namespace trammel::hm2
