#include "position_streaming_inside.hpp"

#include "Vdut.h"
#include "Vdut___024root.h"

std::uint64_t& ticks_left(Vdut& dut) { return dut.rootp->position_streaming__DOT__left_q; }
