// What the counters' test looks at and changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// The tick count but for its four fast bits: 36 bits, which stand still while no tick is taken.
std::uint64_t slow_count(const Vdut& dut);
void set_slow_count(Vdut& dut, std::uint64_t count);
