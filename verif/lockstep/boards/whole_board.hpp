// A whole board, its top as it is synthesised but for what stands for PLL and pins: a host at its UART, a motor at each
// pair of pins. Every board is judged by the same; what is judged are the steps at the pins. Each throws Mismatch when
// the board does otherwise.
#pragma once

#include <cstdint>
#include <string>

namespace trammel::lockstep {

// The top, whatever its name.
class BoardTop {
 public:
  struct Pins {
    bool tx;
    std::uint32_t step;
    std::uint32_t dir;
    std::uint32_t output;
  };

  virtual ~BoardTop() = default;
  // One clock of the card with this level at RX.
  virtual Pins clock(bool rx) = 0;
  // The emergency stop's pin: pressed or open is high.
  virtual void press(bool pressed) = 0;
};

// What stands at the inputs, bit n: input n, as many as there are.
constexpr std::uint32_t kInputLevels = 0xA5C3;

// Of board.toml, and the rate at which a host speaks to it.
struct BoardFacts {
  std::string name;
  std::uint32_t board_id = 0;
  std::uint32_t clock_hz = 0;
  unsigned axes = 0;
  unsigned inputs = 0;
  unsigned outputs = 0;
  bool arc_generator = false;
  double baud = 0;
};

// With the driver: what it says of itself and of its inputs; a line, an arc where it has the generator, another line in
// one stream, with a hold in the middle; the emergency stop.
void streams_and_holds(BoardTop& top, const BoardFacts& facts);

// By trammel info, trammel line and a program by trammel run, at the highest rate: 25 clocks a bit.
void obeys_commands(BoardTop& top, const BoardFacts& facts);

}  // namespace trammel::lockstep
