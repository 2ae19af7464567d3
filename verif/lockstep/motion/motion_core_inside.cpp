#include "motion_core_inside.hpp"

#include "Vdut.h"
#include "Vdut___024root.h"

void add_marks(Vdut& dut, std::uint32_t marks) {
  dut.rootp->motion_core__DOT__geometry__DOT__commands_of_path__DOT__gen_built__DOT__marks += marks;
  dut.rootp->motion_core__DOT__geometry__DOT__commands_of_path__DOT__gen_built__DOT__instants__DOT__taken_q += marks;
}
