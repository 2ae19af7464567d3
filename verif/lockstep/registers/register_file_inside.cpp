#include "register_file_inside.hpp"

#include "Vdut.h"
#include "Vdut___024root.h"

void advance_time(Vdut& dut, std::uint64_t clocks) { dut.rootp->register_file__DOT__i_snapshot__DOT__time_q += clocks; }
