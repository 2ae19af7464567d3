// Skipping: many clocks of a block at once. Each block of trammel::model has an adaptor of two functions:
//
//   std::uint64_t horizon(const Block& block, const Block::Inputs& in);
//     The number of clocks for which these inputs change no output of the block; kForever if they never do. 0: the
//     next clock changes an output, or the adaptor does not know.
//   void advance(Block& block, const Block::Inputs& in, std::uint64_t clocks);
//     Leaves the state that this number of calls of clock(in) leaves; clocks <= horizon(block, in).
//
// tests/model/skip_test.cpp checks every adaptor against this. The functions change nothing but the block; no errors
// are reported.
#pragma once

#include <cstdint>

namespace trammel::skip {

inline constexpr std::uint64_t kForever = UINT64_MAX;

// For adaptors of blocks that do not change at all within their horizon.
inline std::uint64_t forever_if(bool nothing_moves) { return nothing_moves ? kForever : 0; }

}  // namespace trammel::skip
