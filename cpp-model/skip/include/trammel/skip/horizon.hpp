// Skipping: many clocks of a block at once. Each block of trammel::model has an adaptor of two functions:
//
//   std::uint64_t horizon(const Block& block, const Block::Inputs& in);
//     For how many clocks under these inputs no output of the block changes; kForever where none ever will. 0: the next
//     clock changes an output, or the adaptor does not know.
//   void advance(Block& block, const Block::Inputs& in, std::uint64_t clocks);
//     The state that so many calls of clock(in) leave; clocks <= horizon(block, in).
//
// tests/model/skip_test.cpp holds every adaptor to this. Functions are pure but for the block; no errors are reported.
#pragma once

#include <cstdint>

namespace trammel::skip {

inline constexpr std::uint64_t kForever = UINT64_MAX;

// For adaptors of blocks that do not move at all within their horizon.
inline std::uint64_t forever_if(bool nothing_moves) { return nothing_moves ? kForever : 0; }

}  // namespace trammel::skip
