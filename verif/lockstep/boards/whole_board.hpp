// A whole board: its top as synthesised, except for the replacements of the PLL and of pin primitives, with a host at
// its UART and a motor at each pair of pins. The same tests judge every board, by the steps at its pins. Each test
// throws Mismatch if the board fails it.
#pragma once

#include <cstdint>
#include <string>

namespace trammel::lockstep {

// Interface to the top, which has a different name on each board.
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

// The levels at the inputs; bit n: input n, as many as the board has.
constexpr std::uint32_t kInputLevels = 0xA5C3;

// Data from board.toml, and the baud rate of the host.
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

// Uses the driver: checks the identification and the inputs; sends a line, an arc if the board has the generator, and
// another line in one stream, with a hold in the middle; checks the emergency stop.
void streams_and_holds(BoardTop& top, const BoardFacts& facts);

// Uses trammel info, trammel line, and trammel run with a program, at the highest rate: 25 clocks per bit.
void obeys_commands(BoardTop& top, const BoardFacts& facts);

}  // namespace trammel::lockstep
