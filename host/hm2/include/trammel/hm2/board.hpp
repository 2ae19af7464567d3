// A card as Mesa's driver sees it over Ethernet: memory spaces that LBP16 datagrams read and write.
//
// A datagram is checked as a whole first. A malformed datagram, or one that uses a space that the card does not have,
// changes nothing and gets no answer. Addresses: bytes. Errors: LinkError. Used by one thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "trammel/hm2/hostmot2.hpp"
#include "trammel/hm2/lbp16.hpp"

namespace trammel::hm2 {

class Board {
 public:
  struct Counts {
    std::uint64_t datagrams = 0;
    std::uint64_t answers = 0;
    std::array<std::uint64_t, kDefects> refused{};  // by Defect
    std::uint64_t all_refused() const;
  };

  // `hardware`: the Ethernet address shown to drivers, first byte first. `hostmot2` must outlive the board.
  Board(Hostmot2& hostmot2, const std::array<std::uint8_t, 6>& hardware, std::uint32_t clock_hz);

  // The answer to a datagram; empty if it reads nothing or was refused.
  const Bytes& answer(const std::uint8_t* bytes, std::size_t size);
  const Counts& counts() const { return counts_; }

 private:
  static constexpr std::size_t kSpaceBytes = 64;
  using Memory = std::array<std::uint8_t, kSpaceBytes>;

  static Defect judge(const Command& command);
  void show_counts();
  void run(const Command& command);
  void run_hostmot2(const Command& command);
  Memory& memory_of(std::uint8_t space);

  Hostmot2& hostmot2_;
  std::uint32_t clock_hz_;
  Memory eeprom_{};
  Memory timer_{};
  Memory control_{};
  Memory info_{};
  std::vector<Command> commands_;
  Bytes answer_;
  Counts counts_;
};

}  // namespace trammel::hm2
