// Changes that the motion core's test makes inside the RTL.
#pragma once

#include <cstdint>

class Vdut;

// Adds to the count of MARKs that have passed. For a core with path commands.
void add_marks(Vdut& dut, std::uint32_t marks);
