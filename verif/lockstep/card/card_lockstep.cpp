// The whole card, RTL beside golden model, over the bus: random programs with faults, aborts and traffic.
#include <gtest/gtest.h>

#include "host.hpp"
#include "lockstep.hpp"

namespace {

using namespace trammel;

// Until `clocks` are run.
void random_programs(unsigned axes, std::uint64_t seed, std::uint64_t clocks) {
  sim::EngineOptions options;
  options.axes = axes;
  options.seed = seed;
  const auto card = sim::make_engine(options);
  const std::uint64_t begin = card->cycles();
  test::Host host(*card);
  test::RandomProgram program(host, axes, seed);
  while (card->cycles() - begin < clocks) {
    const auto times = [&program] { return static_cast<std::uint32_t>(program.one_of(4)); };
    const std::uint32_t length = times();
    host.set_times(axes, length, times(), times(), times());
    for (unsigned n = 0; n < axes; ++n) card->write(test::reg::mode(n), static_cast<std::uint32_t>(program.one_of(3)));
    for (std::uint64_t sections = 1 + program.one_of(3); sections != 0; --sections) {
      try {
        program.section();
      } catch (const driver::BusError&) {
        // No room while held, or the door closed behind such a refusal.
        host.abort();
      }
    }
    program.finish();
  }
  // Every clock that the host ran was compared.
  ASSERT_EQ(*card->lockstep_cycles(), card->cycles() - begin);
}

// Several runs instead of a longer one: ctest spreads them over the cores. Together 5 * 10^7 clocks.
class CardLockstep : public testing::TestWithParam<unsigned> {};

TEST_P(CardLockstep, RandomPrograms) {
  const std::uint64_t seed = lockstep::seed_from_environment(100 + GetParam());
  EXPECT_EQ(lockstep::judge([seed] { random_programs(4, seed, lockstep::scaled(10'000'000)); }), "");
}
INSTANTIATE_TEST_SUITE_P(FourAxes, CardLockstep, testing::Range(0U, 4U));

class CardLockstepOfEightAxes : public testing::TestWithParam<unsigned> {};

TEST_P(CardLockstepOfEightAxes, RandomPrograms) {
  const std::uint64_t seed = lockstep::seed_from_environment(200 + GetParam());
  EXPECT_EQ(lockstep::judge([seed] { random_programs(8, seed, lockstep::scaled(5'000'000)); }), "");
}
INSTANTIATE_TEST_SUITE_P(EightAxes, CardLockstepOfEightAxes, testing::Range(0U, 2U));

}  // namespace
