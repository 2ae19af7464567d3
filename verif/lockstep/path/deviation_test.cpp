// The deviation accumulator beside its golden model: circles, ellipses, lines and values that use every width, loaded
// in any order, with ticks at full speed or with gaps, reloaded at once, cleared at any time. In 4 directions, and in
// 8 if TRAMMEL_EIGHT says that they are built in.
#include <Vdut.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

#include "deviation_paths.hpp"
#include "trammel/model/deviation_accumulator.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using Model = model::DeviationAccumulator;
constexpr bool kEight = TRAMMEL_EIGHT != 0;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker("deviation_accumulator", seed) {
    Model::Inputs reset;
    reset.rst = true;
    // The direction outputs are unknown before the first edge under reset; from then on everything is compared.
    clock(reset);
  }

  void clock(const Model::Inputs& in) {
    dut_->rst_i = in.rst;
    dut_->load_i = load_wire(in.load);
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
    checker.compare("stepping_o", dut_->stepping_o, model_.stepping());
    steps += (out.step_x || out.step_y) ? 1 : 0;
    diagonal_steps += (out.step_x && out.step_y) ? 1 : 0;
  }

  const Model::Outputs& outputs() const { return model_.outputs(); }

  Checker checker;
  std::uint64_t steps = 0;
  std::uint64_t diagonal_steps = 0;
  std::uint64_t ends = 0;

 private:
  Simulated<Vdut> dut_;
  Model model_;
};

// A halfword for another unit on the bus, or no halfword.
Model::Inputs not_its_own(Random& random) {
  Model::Inputs in;
  using namespace model::load_target;
  in.load = {random() % 2 == 0, static_cast<std::uint16_t>(random() % 512), static_cast<std::uint16_t>(random())};
  if (in.load.target / kChainsOfAUnit == kDeviation / kChainsOfAUnit) in.load.valid = false;
  return in;
}

void load(Bench& bench, Random& random, const Path& path, bool gaps) {
  std::array<int, 9> order{0, 1, 2, 3, 4, 5, 6, 7, 8};
  std::shuffle(order.begin(), order.end(), random);
  const std::array<int128, 9> values = chains(path);
  for (const int chain : order) {
    const auto index = static_cast<std::size_t>(chain);
    for (int i = 0; i < static_cast<int>(kChainHalfwords[index]); ++i) {
      Model::Inputs in;
      in.load = {true, static_cast<std::uint16_t>(model::load_target::kDeviation + index),
                 static_cast<std::uint16_t>(values[index] >> (16 * i))};
      bench.clock(in);
      while (gaps && random() % 4 == 0) bench.clock(not_its_own(random));
    }
  }
  // The displacements and the quadrants are loaded at least one clock before the start.
  const auto last = model::load_target::kDeviation + static_cast<unsigned>(order.back());
  if (last == model::load_target::kEndX || last == model::load_target::kEndY || last == model::load_target::kQuadrants)
    bench.clock(not_its_own(random));
  Model::Inputs start;
  start.start = true;
  bench.checker.event("start", path.quadrants);
  bench.clock(start);
}

// Ticks until the end, for at most `limit` clocks, or until a clear or reset in any state.
void run(Bench& bench, Random& random, std::uint64_t limit) {
  const std::uint64_t gap = random() % 3 == 0 ? random() % 20 : 0;
  const bool cut = random() % 8 == 0;
  const bool stubborn = random() % 4 == 0;  // ticks while not ready, and at the end, must change nothing
  const bool beside = random() % 2 == 0;    // other units are loaded at the same time
  for (std::uint64_t i = 0; i < limit; ++i) {
    const bool ready = bench.outputs().ready;
    if (ready && bench.outputs().at_end) {
      ++bench.ends;
      break;
    }
    Model::Inputs in = beside ? not_its_own(random) : Model::Inputs{};
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
  // A path ended by the limit may be in a step; a reload comes only at rest.
  for (unsigned i = 0; i < Model::kTickPeriod + Model::kCompareClocks && !bench.outputs().ready; ++i) bench.clock({});
}

TEST(DeviationLockstep, EveryOutputInEveryCycle) {
  const std::uint64_t seed = seed_from_environment(20261121);
  EXPECT_EQ(judge([&] {
              Random random(seed);
              Bench bench(seed);
              const std::uint64_t paths = scaled(4000);
              for (std::uint64_t i = 0; i < paths; ++i) {
                load(bench, random, any_path(random, kEight), random() % 2 == 0);
                run(bench, random, random() % 4 == 0 ? 100 : 6000);
              }
              EXPECT_EQ(bench.checker.comparisons(), 7 * bench.checker.cycles());
              EXPECT_GT(bench.steps, 400000u);
              EXPECT_GE(bench.diagonal_steps, kEight ? 50000u : 0u);
              EXPECT_TRUE(kEight || bench.diagonal_steps == 0);
              RecordProperty("diagonal_steps", std::to_string(bench.diagonal_steps));
              EXPECT_GT(bench.ends, paths / 4u);
              RecordProperty("cycles", std::to_string(bench.checker.cycles()));
            }),
            "");
}

}  // namespace
}  // namespace trammel::lockstep
