// What the motion core's test changes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// As if so many more MARKs had passed. For a core with path commands.
void add_marks(Vdut& dut, std::uint32_t marks);
