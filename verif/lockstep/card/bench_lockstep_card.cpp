// Cycles a second of the engines over one long line of four axes: items are clock cycles, in lockstep all compared.
#include <benchmark/benchmark.h>

#include "host.hpp"

namespace {

using namespace trammel;

// One step of the fastest axis in 100 ticks.
void run_line(benchmark::State& state, sim::EngineKind kind, double clocks_a_tick) {
  sim::SimulationOptions options;
  options.kind = kind;
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

constexpr double kSlow = 20;
constexpr double kBusy = 1.05;
BENCHMARK_CAPTURE(run_line, lockstep, sim::EngineKind::kRtl, kSlow)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_line, lockstep_busy, sim::EngineKind::kRtl, kBusy)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_line, model, sim::EngineKind::kModel, kSlow)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_line, model_busy, sim::EngineKind::kModel, kBusy)->Unit(benchmark::kMillisecond);

}  // namespace
