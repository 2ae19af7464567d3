// The deviation accumulator beside its golden model: circles, ellipses, lines and values that fill every width,
// loaded in any order, with ticks as fast as they go or with gaps, reloaded at once, cleared at any moment.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "lockstep.hpp"
#include "trammel/model/deviation_accumulator.hpp"

namespace trammel::lockstep {
namespace {

using Model = model::DeviationAccumulator;
using Random = std::mt19937_64;
__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker("deviation_accumulator", seed) {
    Model::Inputs reset;
    reset.rst = true;
    // The direction outputs are unknown before the first edge under reset; from it on everything is compared.
    clock(reset);
  }

  void clock(const Model::Inputs& in) {
    dut_->rst_i = in.rst;
    dut_->load_i = in.load;
    dut_->word_i = in.word;
    dut_->start_i = in.start;
    dut_->tick_i = in.tick;
    dut_->clear_i = in.clear;
    dut_.clock();
    model_.clock(in);
    const Model::Outputs& out = model_.outputs();
    checker.next_cycle();
    checker.compare("step_x_o", dut_->step_x_o, out.step_x);
    checker.compare("dir_x_o", dut_->dir_x_o, out.dir_x);
    checker.compare("step_y_o", dut_->step_y_o, out.step_y);
    checker.compare("dir_y_o", dut_->dir_y_o, out.dir_y);
    checker.compare("ready_o", dut_->ready_o, out.ready);
    checker.compare("at_end_o", dut_->at_end_o, out.at_end);
    steps += (out.step_x || out.step_y) ? 1 : 0;
  }

  const Model::Outputs& outputs() const { return model_.outputs(); }

  Checker checker;
  std::uint64_t steps = 0;
  std::uint64_t ends = 0;

 private:
  Simulated<Vdut> dut_;
  Model model_;
};

// The fields of a path as the load bus carries them.
struct Path {
  int128 deviation = 0;
  int128 gradient_x = 0;
  int128 gradient_y = 0;
  std::uint64_t half_x = 0;
  std::uint64_t half_y = 0;
  std::int64_t end_x = 0;
  std::int64_t end_y = 0;
  std::uint16_t quadrants = 0;
  bool clockwise = false;
};

std::int64_t between(Random& random, std::int64_t low, std::int64_t high) {
  return std::uniform_int_distribution<std::int64_t>(low, high)(random);
}

int128 any128(Random& random) {
  const auto upper = static_cast<uint128>(random()) << 64;
  return static_cast<int128>(upper | random());
}

// b^2 x^2 + a^2 y^2 - a^2 b^2 in units of 1/scale pulse, about a centre with fraction.
Path conic(Random& random, std::int64_t a, std::int64_t b, std::int64_t scale) {
  const double from = static_cast<double>(between(random, 0, 6283)) / 1000;
  const double to = static_cast<double>(between(random, 0, 6283)) / 1000;
  const auto on_curve = [&](double angle, double axis) { return static_cast<std::int64_t>(std::lround(axis * angle)); };
  const std::int64_t fraction_x = scale == 1 ? 0 : between(random, 0, scale - 1);
  const std::int64_t fraction_y = scale == 1 ? 0 : between(random, 0, scale - 1);
  const std::int64_t px = on_curve(std::cos(from), static_cast<double>(a));
  const std::int64_t py = on_curve(std::sin(from), static_cast<double>(b));
  const std::int64_t x = px * scale + fraction_x;
  const std::int64_t y = py * scale + fraction_y;
  const int128 weight_x = a == b ? 1 : static_cast<int128>(b) * b;
  const int128 weight_y = a == b ? 1 : static_cast<int128>(a) * a;
  Path path;
  path.deviation = weight_x * x * x + weight_y * y * y - weight_x * a * a * scale * scale;
  path.gradient_x = 2 * weight_x * x * scale;
  path.gradient_y = 2 * weight_y * y * scale;
  path.half_x = static_cast<std::uint64_t>(weight_x * scale * scale);
  path.half_y = static_cast<std::uint64_t>(weight_y * scale * scale);
  path.end_x = on_curve(std::cos(to), static_cast<double>(a)) - px;
  path.end_y = on_curve(std::sin(to), static_cast<double>(b)) - py;
  path.quadrants = static_cast<std::uint16_t>(between(random, 0, 6));
  path.clockwise = random() % 2 != 0;
  return path;
}

Path line(Random& random) {
  const auto component = [&] { return between(random, 1, 60) * (random() % 2 != 0 ? 1 : -1); };
  const std::int64_t dx = component();
  const std::int64_t dy = component();
  Path path;
  path.deviation = std::abs(dx) - std::abs(dy) - 1;
  path.gradient_x = dx > 0 ? -std::abs(dy) : std::abs(dy);
  path.gradient_y = dy > 0 ? std::abs(dx) : -std::abs(dx);
  path.end_x = dx;
  path.end_y = dy;
  path.clockwise = (dx > 0) == (dy > 0);
  return path;
}

// No curve at all: every bit of every word in use, carries through all of them, ends of any size.
Path noise(Random& random) {
  Path path;
  const auto shrink = [&] { return static_cast<int>(between(random, 48, 127)); };
  path.deviation = any128(random) >> shrink();
  path.gradient_x = any128(random) >> shrink();
  path.gradient_y = any128(random) >> shrink();
  path.half_x = random() >> between(random, 16, 63);
  path.half_y = random() >> between(random, 16, 63);
  path.end_x = static_cast<std::int32_t>(random()) >> between(random, 0, 31);
  path.end_y = static_cast<std::int32_t>(random()) >> between(random, 0, 31);
  path.quadrants = static_cast<std::uint16_t>((random() & 0xFFFF) >> between(random, 0, 16));
  path.clockwise = random() % 2 != 0;
  return path;
}

Path any_path(Random& random) {
  switch (random() % 6) {
    case 0:
      return line(random);
    case 1:
      return noise(random);
    case 2: {
      const std::int64_t r = between(random, 1, 60);
      return conic(random, r, r, 1);
    }
    case 3: {
      const std::int64_t r = between(random, 1, 60);
      return conic(random, r, r, 256);
    }
    case 4:
      return conic(random, between(random, 1, 80), between(random, 1, 80), 1);
    default:
      return conic(random, between(random, 1000, 1 << 20), between(random, 1000, 1 << 20), 1);
  }
}

void load(Bench& bench, Random& random, const Path& path, bool gaps) {
  std::array<int, 9> order{0, 1, 2, 3, 4, 5, 6, 7, 8};
  std::shuffle(order.begin(), order.end(), random);
  constexpr std::array<int, 9> kHalfwords{5, 5, 5, 3, 3, 2, 2, 1, 1};
  const std::array<int128, 9> values{path.deviation, path.gradient_x, path.gradient_y,
                                     path.half_x,    path.half_y,     path.end_x,
                                     path.end_y,     path.quadrants,  path.clockwise ? 1 : 0};
  for (const int chain : order) {
    const auto index = static_cast<std::size_t>(chain);
    for (int i = 0; i < kHalfwords[index]; ++i) {
      Model::Inputs in;
      in.load = static_cast<std::uint16_t>(1u << chain);
      in.word = static_cast<std::uint16_t>(values[index] >> (16 * i));
      bench.clock(in);
      while (gaps && random() % 4 == 0) bench.clock({});
    }
  }
  Model::Inputs start;
  start.start = true;
  bench.checker.event("start", path.quadrants);
  bench.clock(start);
}

// Ticks until the end, `limit` clocks or a clear or reset in any state.
void run(Bench& bench, Random& random, std::uint64_t limit) {
  const std::uint64_t gap = random() % 3 == 0 ? random() % 20 : 0;
  const bool cut = random() % 8 == 0;
  const bool stubborn = random() % 4 == 0;  // ticks while not ready, and at the end, change nothing
  for (std::uint64_t i = 0; i < limit; ++i) {
    const bool ready = bench.outputs().ready;
    if (ready && bench.outputs().at_end) {
      ++bench.ends;
      break;
    }
    Model::Inputs in;
    in.tick = stubborn || (ready && (gap == 0 || random() % gap == 0));
    if (cut && random() % 64 == 0) {
      in.clear = random() % 2 == 0;
      in.rst = !in.clear;
      in.tick = random() % 2 == 0;
      bench.checker.event(in.rst ? "reset" : "clear");
      bench.clock(in);
      break;
    }
    bench.clock(in);
  }
  Model::Inputs tick_at_end;
  tick_at_end.tick = bench.outputs().ready && bench.outputs().at_end;
  if (random() % 2 == 0) bench.clock(tick_at_end);
  // A path cut off by the limit may be in a step: a reload comes only at rest.
  for (unsigned i = 0; i < Model::kTickPeriod && !bench.outputs().ready; ++i) bench.clock({});
}

TEST(DeviationLockstep, EveryOutputInEveryCycle) {
  const std::uint64_t seed = seed_from_environment(20261121);
  EXPECT_EQ(judge([&] {
              Random random(seed);
              Bench bench(seed);
              const std::uint64_t paths = scaled(4000);
              for (std::uint64_t i = 0; i < paths; ++i) {
                load(bench, random, any_path(random), random() % 2 == 0);
                run(bench, random, random() % 4 == 0 ? 100 : 6000);
              }
              EXPECT_EQ(bench.checker.comparisons(), 6 * bench.checker.cycles());
              EXPECT_GT(bench.steps, 400000u);
              EXPECT_GT(bench.ends, paths / 4u);
              RecordProperty("cycles", std::to_string(bench.checker.cycles()));
            }),
            "");
}

}  // namespace
}  // namespace trammel::lockstep
