// Changes that the register file's test makes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// Adds `clocks` to the time of snapshots.
void advance_time(Vdut& dut, std::uint64_t clocks);
