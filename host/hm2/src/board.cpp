#include "trammel/hm2/board.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "trammel/hm2/register_map.hpp"

namespace trammel::hm2 {
namespace {

// Byte offsets of 16-bit words in the small spaces.
constexpr std::size_t kHardwareAddress = 2;  // EEPROM, last byte first
constexpr std::size_t kEepromName = 16;
constexpr std::size_t kMicroseconds = 0;  // timer
constexpr std::size_t kRefused = 2;       // control
constexpr std::size_t kReceived = 8;
constexpr std::size_t kReceivedUdp = 10;
constexpr std::size_t kReceivedBad = 12;
constexpr std::size_t kSent = 14;
constexpr std::size_t kSentUdp = 16;
constexpr std::size_t kProtocolVersion = 16;  // info, after the name
constexpr unsigned kLbp16Version = 3;

// The driver uses the first four characters for its name: hm2_tram.0.
constexpr char kName[] = "trammel";

template <class Memory>
void put(Memory& memory, std::size_t at, std::uint64_t value) {
  memory[at] = static_cast<std::uint8_t>(value);
  memory[at + 1] = static_cast<std::uint8_t>(value >> 8);
}

}  // namespace

std::uint64_t Board::Counts::all_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

Board::Board(Hostmot2& hostmot2, const std::array<std::uint8_t, 6>& hardware, std::uint32_t clock_hz)
    : hostmot2_(hostmot2), clock_hz_(clock_hz) {
  std::reverse_copy(hardware.begin(), hardware.end(), eeprom_.begin() + kHardwareAddress);
  std::memcpy(&eeprom_[kEepromName], kName, sizeof(kName));
  std::memcpy(info_.data(), kName, sizeof(kName));
  put(info_, kProtocolVersion, kLbp16Version);
}

Board::Memory& Board::memory_of(std::uint8_t space) {
  switch (static_cast<Space>(space)) {
    case Space::kEeprom:
      return eeprom_;
    case Space::kTimer:
      return timer_;
    case Space::kControl:
      return control_;
    default:
      return info_;
  }
}

Defect Board::judge(const Command& command) {
  const auto space = static_cast<Space>(command.space);
  const bool small =
      space == Space::kEeprom || space == Space::kTimer || space == Space::kControl || space == Space::kInfo;
  if (!small && space != Space::kHostmot2) return Defect::kSpace;
  if (command.unit != (small ? 2 : 4)) return Defect::kUnit;
  if (command.address % command.unit != 0) return Defect::kAlignment;
  if (command.address + command.reach() > (small ? kSpaceBytes : map::kBytes)) return Defect::kSpace;
  return command.write && small && space != Space::kTimer ? Defect::kReadOnly : Defect::kNone;
}

const Bytes& Board::answer(const std::uint8_t* bytes, std::size_t size) {
  answer_.clear();
  ++counts_.datagrams;
  Defect defect = decode(bytes, size, commands_);
  for (auto command = commands_.begin(); defect == Defect::kNone && command != commands_.end(); ++command) {
    defect = judge(*command);
  }
  if (defect != Defect::kNone) {
    ++counts_.refused[static_cast<std::size_t>(defect)];
    return answer_;
  }
  show_counts();
  hostmot2_.begin();
  for (const Command& command : commands_) run(command);
  if (!answer_.empty()) ++counts_.answers;
  return answer_;
}

void Board::show_counts() {
  put(control_, kRefused, counts_.all_refused());
  put(control_, kReceived, counts_.datagrams);
  put(control_, kReceivedUdp, counts_.datagrams);
  put(control_, kReceivedBad, counts_.all_refused());
  put(control_, kSent, counts_.answers);
  put(control_, kSentUdp, counts_.answers);
  put(timer_, kMicroseconds, hostmot2_.now() * 1'000'000 / clock_hz_);
}

void Board::run(const Command& command) {
  if (static_cast<Space>(command.space) == Space::kHostmot2) return run_hostmot2(command);
  Memory& memory = memory_of(command.space);
  for (unsigned n = 0; n < command.units; ++n) {
    std::uint8_t* place = &memory[command.address + (command.increment ? n * command.unit : 0)];
    if (command.write) {
      std::memcpy(place, command.data + std::size_t{n} * command.unit, command.unit);
    } else {
      answer_.insert(answer_.end(), place, place + command.unit);
    }
  }
}

void Board::run_hostmot2(const Command& command) {
  for (unsigned n = 0; n < command.units; ++n) {
    const std::uint32_t address = command.address + (command.increment ? n * 4 : 0);
    if (command.write) {
      hostmot2_.write(address, word_of(command.data + std::size_t{n} * 4));
    } else {
      append_word(answer_, hostmot2_.read(address));
    }
  }
}

}  // namespace trammel::hm2
