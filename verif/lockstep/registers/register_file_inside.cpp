#include "register_file_inside.hpp"

#include "Vdut.h"
#include "Vdut___024root.h"

void set_time_low(Vdut& dut, std::uint32_t clocks) { dut.rootp->register_file__DOT__i_ram__DOT__time_lo_q = clocks; }
