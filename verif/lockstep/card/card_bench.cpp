// Speed of the engines over one long line of four axes. Items are clock cycles; in lockstep all of them are compared.
#include <benchmark/benchmark.h>

#include "host.hpp"

namespace {

using namespace trammel;

// The fastest axis steps once per 100 ticks.
void run_line(benchmark::State& state, const sim::SimulationOptions& options, double clocks_a_tick) {
  const auto card = sim::make_engine(options);
  test::Host host(*card);
  constexpr std::uint64_t kTicks = 1'000'000'000;
  host.send(test::line(kTicks, {10'000'000, 7'000'001, -3'333'333, 40'000}));
  host.send(test::feed(kTicks, clocks_a_tick));
  const std::uint64_t begin = card->cycles();
  for (auto _ : state) {
    card->wait(100'000);
    benchmark::DoNotOptimize(card->lockstep_cycles());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(card->cycles() - begin));
}

// The RTL engine in the caller's thread, as in tests, or with the RTL in its own thread, as in the trammel command.
sim::SimulationOptions lockstep(bool rtl_thread) {
  sim::SimulationOptions options;
  options.rtl_thread = rtl_thread;
  return options;
}

sim::SimulationOptions model() {
  sim::SimulationOptions options;
  options.kind = sim::EngineKind::kModel;
  return options;
}

constexpr double kSlow = 20;
constexpr double kBusy = 1.05;
// clang-format off
BENCHMARK_CAPTURE(run_line, lockstep, lockstep(true), kSlow)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(run_line, lockstep_busy, lockstep(true), kBusy)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(run_line, lockstep_one_thread, lockstep(false), kSlow)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(run_line, lockstep_one_thread_busy, lockstep(false), kBusy)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(run_line, model, model(), kSlow)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_line, model_busy, model(), kBusy)->Unit(benchmark::kMillisecond);
// clang-format on

}  // namespace
