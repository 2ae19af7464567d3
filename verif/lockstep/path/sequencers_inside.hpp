// Values that the sequencers' test reads and changes inside the RTL: the path's tick counter, which also counts
// during barriers.
#pragma once

#include <cstdint>

class Vdut;

// The four fast bits of the counter.
std::uint32_t fast_count(const Vdut& dut);
// Clears the other 36 bits.
void clear_slow_count(Vdut& dut);
