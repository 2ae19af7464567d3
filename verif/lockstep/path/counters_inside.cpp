#include "counters_inside.hpp"

#include "Vdut.h"
#include "Vdut___024root.h"

namespace {

constexpr std::uint32_t kTop = (1U << 20) - 1;

}  // namespace

// The RTL stores both parts inverted.
std::uint64_t slow_count(const Vdut& dut) {
  const std::uint64_t top = dut.rootp->counters__DOT__ticks__DOT__top_q ^ kTop;
  return top << 16 | (dut.rootp->counters__DOT__ticks__DOT__mid_q ^ 0xFFFFU);
}

void set_slow_count(Vdut& dut, std::uint64_t count) {
  dut.rootp->counters__DOT__ticks__DOT__top_q = static_cast<IData>(count >> 16 ^ kTop) & kTop;
  dut.rootp->counters__DOT__ticks__DOT__mid_q = static_cast<SData>(count ^ 0xFFFF);
}
