#include "sequencers_inside.hpp"

#include "Vdut.h"
#include "Vdut___024root.h"

std::uint32_t fast_count(const Vdut& dut) { return dut.rootp->sequencers__DOT__geometry__DOT__ticks__DOT__low_q; }

// The RTL stores them inverted.
void clear_slow_count(Vdut& dut) {
  dut.rootp->sequencers__DOT__geometry__DOT__ticks__DOT__mid_q = 0xFFFF;
  dut.rootp->sequencers__DOT__geometry__DOT__ticks__DOT__top_q = (1U << 20) - 1;
}
