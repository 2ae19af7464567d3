// What the sequencers' test looks at and changes inside the RTL: the path's tick counter, which also counts at
// barriers.
#pragma once

#include <cstdint>

class Vdut;

// Its four fast bits.
std::uint32_t fast_count(const Vdut& dut);
// The other 36 bits become 0.
void clear_slow_count(Vdut& dut);
