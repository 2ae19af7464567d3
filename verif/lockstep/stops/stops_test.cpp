// Every cause of a stop, with each reaction, in each state of the card, at clocks of a window of 128: RTL and golden
// model in lockstep, and a judge that sees only the pins and the register port.
#include <gtest/gtest.h>

#include <iostream>

#include "stop_window.hpp"

namespace {

using namespace trammel;
using test::Cause;
using test::kWindow;
using test::Reaction;
using test::State;
using test::Tally;

std::unique_ptr<test::WatchedCard> make(bool in_lockstep) {
  if (!in_lockstep) return std::make_unique<test::RtlAlone>(test::watched_straps(), test::kWatchedAxes);
  model::CardModel::Config config;
  config.engines = model::RegisterFile::kMaxEngines;
  config.axes = test::kWatchedAxes;
  config.inputs = sim::kInputs;
  const sim::CardStraps straps = test::watched_straps();
  config.clock_hz = straps.clock_hz;
  config.output_idle = static_cast<std::uint16_t>(straps.output_idle);
  return std::make_unique<test::CardInLockstep>(straps, config, 1);
}

struct Row {
  const Cause* cause;
  Reaction reaction;
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.cause->name << ", " << name_of(row.reaction); }

std::vector<Row> rows() {
  std::vector<Row> all;
  for (const Cause& cause : test::causes()) {
    for (const Reaction reaction : cause.reactions) all.push_back({&cause, reaction});
  }
  return all;
}

// Excludes causes that the program does not produce in the state, and silence in states that need the host.
bool is_a_case(const Cause& cause, const State& state) {
  if (cause.of_silence) return state.alone;
  return !cause.of_program() || cause.effect(state) != test::Effect::kNothing;
}

// `clocks`: number of clocks to try, spread over the window.
Tally judge_row(const Row& row, unsigned clocks, bool in_lockstep, std::uint64_t seed) {
  Tally tally;
  for (const State& state : test::states()) {
    if (!is_a_case(*row.cause, state)) continue;
    try {
      test::Window window(make(in_lockstep), *row.cause, row.reaction, state);
      const auto stride = kWindow / clocks;
      for (unsigned i = 0; i < clocks; ++i) {
        seed = seed * 6364136223846793005U + 1442695040888963407U;
        window.judge(i * stride + static_cast<unsigned>((seed >> 33) % stride), tally);
      }
    } catch (const std::exception& error) {
      throw lockstep::Mismatch(std::string(row.cause->name) + ", " + name_of(row.reaction) + ", " + state.name + ": " +
                               error.what());
    }
  }
  return tally;
}

class Stops : public testing::TestWithParam<Row> {};

std::string name_of_row(const testing::TestParamInfo<Row>& row) {
  std::string name = std::string(row.param.cause->name) + "_" + name_of(row.param.reaction);
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

TEST_P(Stops, AreRight) {
  const auto clocks = static_cast<unsigned>(std::min<std::uint64_t>(lockstep::scaled(4), kWindow));
  const std::uint64_t seed = lockstep::seed_from_environment(1);
  EXPECT_EQ(lockstep::judge([&] {
              const Tally tally = judge_row(GetParam(), clocks, true, seed);
              EXPECT_GE(tally.cases, clocks);
              EXPECT_GT(tally.compared, 500 * tally.cases);
              std::cout << tally.cases << " stops judged, " << tally.stops << " of them faults, " << tally.compared
                        << " clocks\n";
            }),
            "");
}

// The judge alone, over RTL without a model: it must accept correct RTL, and must reject each seeded bug.
TEST_P(Stops, AreJudgedWithoutAModel) {
  EXPECT_EQ(lockstep::judge([&] { judge_row(GetParam(), 1, false, 3); }), "");
}

INSTANTIATE_TEST_SUITE_P(Cause, Stops, testing::ValuesIn(rows()), name_of_row);

}  // namespace
