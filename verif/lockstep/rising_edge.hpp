// One clock of a Verilated model. Compiled together with what Verilator wrote (cmake/JoinVerilated.cmake), not with the
// test: a test then knows a block by its ports alone and links with any copy of it. The model was evaluated before.
#pragma once

namespace trammel::lockstep {

template <class Dut>
void rising_edge(Dut& dut) {
  dut.clk_i = 0;
  dut.eval();
  dut.clk_i = 1;
  dut.eval();
}

// All that eval() finds to do at a rising edge when nothing in the RTL happens at another (JoinVerilated.cmake refuses
// other events than posedge clk_i): the functions that Verilator 5.006 wrote for what depends on inputs and for the
// edge, without the search for triggers before, between and after them. clk_i and Verilator's memory of it stay as they
// are, so eval() finds no edge afterwards.
template <class Root>
void evaluate_inputs(Root& root, void (*eval_ico)(Root*)) {
  root.__VicoTriggered.at(0) = true;
  eval_ico(&root);
}
template <class Root>
void evaluate_edge(Root& root, void (*eval_nba)(Root*)) {
  root.__VnbaTriggered.at(0) = true;
  eval_nba(&root);
}

}  // namespace trammel::lockstep
