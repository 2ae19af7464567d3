// A variant that writes its signals to an FST file, two time steps per clock.
#pragma once

#include <verilated_fst_c.h>

#include <stdexcept>

#include "card_variant.hpp"

namespace trammel::sim {

template <class Dut, unsigned kAxes>
class TracedVariant : public BothEdgesVariant<Dut, kAxes> {
 public:
  TracedVariant(const CardStraps& straps, const TraceFile& trace)
      : BothEdgesVariant<Dut, kAxes>(straps), trace_(trace) {
    Verilated::threadContextp(&this->dut_.context());
    this->dut_.context().traceEverOn(true);
    this->dut_->trace(&file_, 99);
    file_.open(trace.path.c_str());
    if (!file_.isOpen()) throw std::runtime_error("cannot write the trace file " + trace.path);
  }
  ~TracedVariant() override {
    Verilated::threadContextp(&this->dut_.context());
    file_.close();
  }

 private:
  void at_edge() override {
    const std::uint64_t clock = time_ / 2;
    if (clock >= trace_.from && clock < trace_.to) file_.dump(time_);
    ++time_;
  }

  TraceFile trace_;
  VerilatedFstC file_;
  std::uint64_t time_ = 0;
};

}  // namespace trammel::sim
