// Speed of the pulse generator's lockstep with the checker on, in cycles: two edges of RTL, the model and 3
// comparisons.
#include <benchmark/benchmark.h>

#include "pulse_generator_bench.hpp"

namespace {

using trammel::lockstep::PulseGeneratorBench;

// A line of `increment` / 2^40 pulses per tick, with a tick in every clock.
void lockstep_pulse_generator(benchmark::State& state) {
  PulseGeneratorBench bench(0);
  bench.load_increment(state.range(0));
  PulseGeneratorBench::Inputs in;
  in.swap = true;
  in.active = true;
  bench.clock(in);
  for (auto unused : state) {
    (void)unused;
    bench.ticks(1000);
  }
  state.SetItemsProcessed(state.iterations() * 1000);
}
BENCHMARK(lockstep_pulse_generator)->Arg(std::int64_t{1} << 34)->Arg(std::int64_t{0x5555555555});

}  // namespace
