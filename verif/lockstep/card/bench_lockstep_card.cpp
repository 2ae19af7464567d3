// Cycles a second of the engines over one long line of four axes: items are clock cycles.
#include <benchmark/benchmark.h>

#include "host.hpp"

namespace {

using namespace trammel;

// One step of the fastest axis in 25 ticks of 20 clocks.
void run_line(benchmark::State& state, sim::EngineKind kind) {
  sim::EngineOptions options;
  options.kind = kind;
  const auto card = sim::make_engine(options);
  test::Host host(*card);
  constexpr std::uint64_t kTicks = 1'000'000'000;
  host.send(test::line(kTicks, {10'000'000, 7'000'001, -3'333'333, 40'000}));
  host.send(test::feed(kTicks, 20));
  const std::uint64_t begin = card->cycles();
  for (auto _ : state) card->wait(100'000);
  state.SetItemsProcessed(static_cast<std::int64_t>(card->cycles() - begin));
}

BENCHMARK_CAPTURE(run_line, lockstep, sim::EngineKind::kRtl)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run_line, model, sim::EngineKind::kModel)->Unit(benchmark::kMillisecond);

}  // namespace
