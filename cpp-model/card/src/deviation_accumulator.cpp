#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::model {
namespace {

using Word = DeviationPath::Word;

// Halfwords come lowest first: each one enters at the top and shifts the others down.
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

void DeviationAccumulator::take(const LoadWord& load) {
  DeviationPath::State& state = state_.path.state;
  switch (load.target) {
    case load_target::kDeviation:
      return shift_gradient(state.deviation, load.word);
    case load_target::kGradientX:
      return shift_gradient(state.gradient_x, load.word);
    case load_target::kGradientY:
      return shift_gradient(state.gradient_y, load.word);
    case load_target::kHalfX:
      return shift_half(state.half_x, load.word);
    case load_target::kHalfY:
      return shift_half(state.half_y, load.word);
    case load_target::kEndX:
      return shift_end(state.left_x, load.word);
    case load_target::kEndY:
      return shift_end(state.left_y, load.word);
    case load_target::kQuadrants:
      state.quadrants = load.word;
      return;
    default:
      state.clockwise = (load.word & 1U) != 0;
      state.eight_directions = (load.word & 2U) != 0;
  }
}

}  // namespace trammel::model
