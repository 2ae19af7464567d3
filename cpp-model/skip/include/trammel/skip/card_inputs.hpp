// Adaptors of the card's inputs: pins, filters, roles. See horizon.hpp.
#pragma once

#include <algorithm>
#include <cstdint>

#include "trammel/model/card_inputs.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

inline std::uint64_t horizon(const model::InputPins& block, const model::InputPins::Inputs& in) {
  const model::InputPins::State& s = block.state();
  return forever_if(!in.setting.set && (in.pins & block.present()) == s.last && s.last == s.seen);
}
inline void advance(model::InputPins&, const model::InputPins::Inputs&, std::uint64_t) {}

// Ends when an input that differs from its output passes.
std::uint64_t horizon(const model::InputFilter& block, const model::InputFilter::Inputs& in);
void advance(model::InputFilter& block, const model::InputFilter::Inputs& in, std::uint64_t clocks);

inline std::uint64_t horizon(const model::RoleScan& block, const model::RoleScan::Inputs& in) {
  return forever_if(block.settled(in));
}
void advance(model::RoleScan& block, const model::RoleScan::Inputs& in, std::uint64_t clocks);

std::uint64_t horizon(const model::CardInputs& block, const model::CardInputs::Inputs& in);
void advance(model::CardInputs& block, const model::CardInputs::Inputs& in, std::uint64_t clocks);

}  // namespace trammel::skip
