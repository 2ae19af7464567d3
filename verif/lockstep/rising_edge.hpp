// One clock of a Verilated model. Compiled together with what Verilator wrote (cmake/JoinVerilated.cmake), not with the
// test: a test then knows a block by its ports alone and links with any copy of it. The model was evaluated before.
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

// All that eval() finds to do at a rising edge when nothing in the RTL happens at another: the functions that Verilator
// 5.006 wrote for what depends on inputs and for the edge, without the search for triggers before, between and after
// them. clk_i and Verilator's memory of it stay as they are, so eval() finds no edge afterwards. JoinVerilated.cmake
// refuses other events than posedge clk_i, but for the flip-flop that the emergency stop sets asynchronously: it counts
// with the clock here.
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
