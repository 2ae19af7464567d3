// One clock of a Verilated model. Compiled together with what Verilator wrote (cmake/JoinVerilated.cmake), not with the
// test: a test then knows a block by its ports alone and links with any copy of it.
#pragma once

namespace trammel::lockstep {

// Nothing in the RTL happens at the falling edge (JoinVerilated.cmake refuses other events than posedge clk_i), so all
// that evaluating it does is to let Verilator remember that the clock was low. Where that memory is known by name it is
// set directly, which saves the evaluation; false where it is not.
template <class Root>
auto remember_low(Root& root, int) -> decltype(root.__Vtrigrprev__TOP__clk_i, bool()) {
  root.__Vtrigrprev__TOP__clk_i = 0;
  return true;
}
template <class Root>
bool remember_low(Root&, long) {
  return false;
}

// The model was evaluated before.
template <class Dut>
void rising_edge(Dut& dut) {
  if (!remember_low(*dut.rootp, 0)) {
    dut.clk_i = 0;
    dut.eval();
  }
  dut.clk_i = 1;
  dut.eval();
}

}  // namespace trammel::lockstep
