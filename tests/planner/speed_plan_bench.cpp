// Spans per second of the speed plan alone, with a full window.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "trammel/planner/s_curve_plan.hpp"

namespace {

using trammel::planner::Phase;
using trammel::planner::SCurvePlan;
using trammel::planner::Span;

enum Path { kLine, kCircle, kCurve };

// Chords of 0.02 mm. On a curve the limits change with its direction, and the corners are those of rounded ends.
std::vector<Span> chords(int path) {
  std::vector<Span> spans;
  unsigned noise = 1;
  for (int i = 0; i < 200'000; ++i) {
    const double turned = path == kCurve ? 0.0004 * i : 0;
    const double factor = 1 / std::max(std::abs(std::cos(turned)), std::abs(std::sin(turned)));
    noise = noise * 1'664'525 + 1'013'904'223;
    const double exit = path == kLine ? 1e9 : path == kCircle ? 54.77 : 30 + 200 * (noise >> 8) * 0x1p-24;
    spans.push_back({0.02, 300 * factor, 3'000 * factor, 100'000 * factor, exit});
  }
  return spans;
}

void plan(benchmark::State& state) {
  const std::vector<Span> spans = chords(static_cast<int>(state.range(0)));
  std::size_t phases = 0;
  for (auto _ : state) {
    SCurvePlan plan(static_cast<std::size_t>(state.range(1)));
    Phase phase;
    for (const Span& span : spans) {
      while (plan.full() && plan.next(phase)) ++phases;
      plan.push(span);
    }
    plan.finish();
    while (plan.next(phase)) ++phases;
  }
  const double planned = static_cast<double>(state.iterations()) * static_cast<double>(spans.size());
  state.counters["spans/s"] = benchmark::Counter(planned, benchmark::Counter::kIsRate);
  state.counters["phases/span"] = static_cast<double>(phases) / planned;
}
BENCHMARK(plan)->ArgNames({"path", "window"})->ArgsProduct({{kLine, kCircle, kCurve}, {16, 256, 16'384}});

}  // namespace
