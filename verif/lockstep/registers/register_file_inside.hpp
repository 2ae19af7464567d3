// What the register file's test changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// Lets `clocks` pass for the time that snapshots take.
void advance_time(Vdut& dut, std::uint64_t clocks);
