// Steps per second of every method on one core. Targets: 100 M for lines on two axes, 50 M for circles.
#include <benchmark/benchmark.h>

#include <string>

#include "trammel/interpolation/any_interpolator.hpp"

namespace {

using namespace trammel::interpolation;

void walk(benchmark::State& state, Method method, const Curve& curve) {
  const AnyInterpolator start = make_interpolator(method, curve, {100'000'000, 1, 1});
  std::int64_t steps = 0;
  for (auto unused : state) {
    static_cast<void>(unused);
    AnyInterpolator interpolator = start;
    std::int64_t sum = 0;
    interpolator.run([&](const Step& step, const auto&) {
      sum += step.direction[0] + 3 * step.direction[1];
      ++steps;
    });
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(steps);
}

}  // namespace

int main(int argc, char** argv) {
  const Curve line = make_line({0, 0}, {1'000'000, 733'337});
  const Curve circle = make_circle(200'000);
  const Curve ellipse = make_ellipse(200'000, 120'000);
  for (const MethodInfo& method : methods()) {
    const auto add = [&](const char* shape, const Curve& curve) {
      const std::string name = std::string(method.name) + "/" + shape;
      benchmark::RegisterBenchmark(name.c_str(), walk, method.method, curve)->Unit(benchmark::kMillisecond);
    };
    if (method.line_axes != 0) add("line", line);
    if (method.circles) add("circle", circle);
    if (method.ellipses) add("ellipse", ellipse);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
