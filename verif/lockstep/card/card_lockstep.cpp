// The whole card, RTL beside golden model, over the bus: random programs with faults, aborts and traffic.
#include <gtest/gtest.h>

#include <cstdlib>

#include "host.hpp"
#include "lockstep.hpp"
#include "rtl_engine.hpp"
#ifdef TRAMMEL_SEEDED_BUG
#include "Vdut.h"
#include "card_variant.hpp"
#endif

namespace {

using namespace trammel;

std::unique_ptr<sim::Engine> engine(unsigned axes, std::uint64_t seed) {
  sim::EngineOptions options;
  options.axes = axes;
  options.seed = seed;
#ifdef TRAMMEL_SEEDED_BUG
  return sim::make_rtl_engine(std::make_unique<sim::CardVariant<Vdut, 4>>(options.clock_hz), options);
#else
  return sim::make_engine(options);
#endif
}

void random_programs(unsigned axes, std::uint64_t seed, int programs) {
  const auto card = engine(axes, seed);
  test::Host host(*card);
  test::RandomProgram program(host, axes, seed);
  for (int i = 0; i < programs; ++i) {
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
  ASSERT_GT(*card->lockstep_cycles(), 1000U);
  ASSERT_EQ(card->comparisons(), *card->lockstep_cycles() * (24 + axes));
}

TEST(CardLockstep, RandomPrograms) {
  const std::uint64_t seed = lockstep::seed_from_environment(1);
  EXPECT_EQ(lockstep::judge([seed] { random_programs(4, seed, 40); }), "");
}

#ifndef TRAMMEL_SEEDED_BUG
TEST(CardLockstep, RandomProgramsOnEightAxes) {
  const std::uint64_t seed = lockstep::seed_from_environment(2);
  EXPECT_EQ(lockstep::judge([seed] { random_programs(8, seed, 10); }), "");
}
#endif

}  // namespace
