// Values that the counters' test reads and changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// The tick count without its four fast bits: 36 bits, which are constant while no tick is taken.
std::uint64_t slow_count(const Vdut& dut);
void set_slow_count(Vdut& dut, std::uint64_t count);
