#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::model {
namespace {

using Word = DeviationPath::Word;

// Halfwords come lowest first, so each one enters at the top and moves the others down.
void shift_gradient(Word& chain, std::uint16_t word) {
  const Word below = (chain >> (DeviationPath::kAlign + 16)) << DeviationPath::kAlign;
  chain = below | static_cast<Word>(word) << 112;
}

void shift_half(std::uint64_t& chain, std::uint16_t word) {
  chain = chain >> 16 | static_cast<std::uint64_t>(word) << 32;
}

void shift_end(std::uint32_t& chain, std::uint16_t word) {
  chain = chain >> 16 | static_cast<std::uint32_t>(word) << 16;
}

}  // namespace

void DeviationAccumulator::shift_in(std::uint16_t load, std::uint16_t word) {
  DeviationPath::State& state = path_.state;
  if (load & 1u << 0) shift_gradient(state.deviation, word);
  if (load & 1u << 1) shift_gradient(state.gradient_x, word);
  if (load & 1u << 2) shift_gradient(state.gradient_y, word);
  if (load & 1u << 3) shift_half(state.half_x, word);
  if (load & 1u << 4) shift_half(state.half_y, word);
  if (load & 1u << 5) shift_end(state.left_x, word);
  if (load & 1u << 6) shift_end(state.left_y, word);
  if (load & 1u << 7) state.quadrants = word;
  if (load & 1u << 8) state.clockwise = (word & 1u) != 0;
}

}  // namespace trammel::model
