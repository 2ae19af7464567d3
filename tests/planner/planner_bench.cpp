// Blocks per second on one core: chords of 0.02 mm through reader, look-ahead, speed plan, quantiser and encoding.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "trammel/planner/planner.hpp"

namespace {

using namespace trammel;

constexpr int kChords = 200'000;

// A line, or a spiral whose radius grows from 2 mm by 1 mm per turn.
std::string program(bool spiral) {
  std::string text = "G1 F18000\n";
  std::array<char, 64> line{};
  double angle = 0;
  for (int i = 1; i <= kChords; ++i) {
    const double radius = 2 + angle / 6.2831853;
    if (spiral) angle += 0.02 / radius;
    const double x = spiral ? radius * std::cos(angle) : 0.02 * (i % 10'000);
    const double y = spiral ? radius * std::sin(angle) : 0;
    std::snprintf(line.data(), line.size(), "X%.4f Y%.4f\n", x, y);
    text += line.data();
  }
  return text;
}

class Encoder final : public driver::CommandSink {
 public:
  void put(const driver::Command& command) override {
    words += driver::encode(command, static_cast<std::uint8_t>(commands++), words_.data());
    pieces += std::holds_alternative<driver::FeedCommand>(command) ? 1U : 0U;
  }
  std::uint64_t commands = 0;
  std::uint64_t words = 0;
  std::uint64_t pieces = 0;

 private:
  std::array<std::uint32_t, driver::kMaxCommandWords> words_{};
};

void blocks(benchmark::State& state) {
  const std::string text = program(state.range(0) != 0);
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.max_velocity = 300;
    axis.max_acceleration = 3000;
    axis.max_jerk = state.range(2) != 0 ? 100'000 : 0;
  }
  machine.motion.window = static_cast<double>(state.range(1));
  std::uint64_t blocks = 0;
  std::uint64_t pieces = 0;
  for (auto _ : state) {
    gcode::TextLines lines(text, "bench");
    gcode::Reader reader(lines, machine);
    planner::BlockBuilder builder(reader, machine, {100'000'000, 4, true});
    planner::Planner planner(builder, machine, {100'000'000, 4, true});
    Encoder sink;
    for (planner::PlannedBlock planned; planner.next(sink, planned);) ++blocks;
    pieces += sink.pieces;
  }
  state.counters["blocks/s"] = benchmark::Counter(static_cast<double>(blocks), benchmark::Counter::kIsRate);
  state.counters["pieces a block"] = static_cast<double>(pieces) / static_cast<double>(blocks);
}

BENCHMARK(blocks)
    ->ArgNames({"spiral", "window", "s_curve"})
    ->ArgsProduct({{0, 1}, {256, 16'384}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
