// A variant that writes its signals to an FST file, two time steps a clock.
#pragma once

#include <verilated_fst_c.h>

#include <stdexcept>

#include "card_variant.hpp"

namespace trammel::sim {

template <class Dut, unsigned kAxes>
class TracedVariant : public BothEdgesVariant<Dut, kAxes> {
 public:
  TracedVariant(const CardStraps& straps, const std::string& path) : BothEdgesVariant<Dut, kAxes>(straps) {
    Verilated::threadContextp(&this->dut_.context());
    this->dut_.context().traceEverOn(true);
    this->dut_->trace(&file_, 99);
    file_.open(path.c_str());
    if (!file_.isOpen()) throw std::runtime_error("cannot write the trace file " + path);
  }
  ~TracedVariant() override {
    Verilated::threadContextp(&this->dut_.context());
    file_.close();
  }

 private:
  void at_edge() override { file_.dump(time_++); }

  VerilatedFstC file_;
  std::uint64_t time_ = 0;
};

}  // namespace trammel::sim
