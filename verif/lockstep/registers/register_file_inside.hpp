// What the register file's test changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// The low word of the time that snapshots take.
void set_time_low(Vdut& dut, std::uint32_t clocks);
