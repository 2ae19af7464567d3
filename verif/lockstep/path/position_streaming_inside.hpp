// Values that the test of position streaming reads and changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// Ticks left of the present round, 40 bits.
std::uint64_t& ticks_left(Vdut& dut);
