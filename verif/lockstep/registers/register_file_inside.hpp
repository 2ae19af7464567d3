// What the register file's test changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// Lets `clocks` pass for the low word of the time that snapshots take, which must not carry.
void advance_time(Vdut& dut, std::uint32_t clocks);
