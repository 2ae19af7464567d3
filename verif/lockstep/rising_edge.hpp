// One clock of a Verilated model. It is compiled together with Verilator's output (cmake/JoinVerilated.cmake), not
// with the test: a test then depends only on the ports of a block, and links with any copy of it. The model must have
// been evaluated before.
#pragma once

#include <cstddef>

namespace trammel::lockstep {

template <class Dut>
void rising_edge(Dut& dut) {
  dut.clk_i = 0;
  dut.eval();
  dut.clk_i = 1;
  dut.eval();
}

// Does all that eval() does at a rising edge, provided that nothing in the RTL reacts to another event: it calls the
// functions that Verilator 5.006 generated for changes of the inputs and for the edge, without the searches for
// triggers before, between and after them. clk_i and Verilator's copy of it do not change, so eval() finds no edge
// afterwards. JoinVerilated.cmake refuses events other than posedge clk_i, except the flip-flop that the emergency
// stop sets asynchronously, which here acts with the clock.
template <class Root>
void evaluate_inputs(Root& root, void (*eval_ico)(Root*)) {
  root.__VicoTriggered.at(0) = true;
  eval_ico(&root);
}
template <std::size_t kTriggers>
void set_all(VlTriggerVec<kTriggers>& triggered) {
  for (std::size_t i = 0; i < kTriggers; ++i) triggered.at(i) = true;
}
template <class Root>
void evaluate_edge(Root& root, void (*eval_nba)(Root*)) {
  set_all(root.__VnbaTriggered);
  eval_nba(&root);
}

}  // namespace trammel::lockstep
