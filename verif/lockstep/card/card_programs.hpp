// Helpers for several tests of the whole card.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "card_under_test.hpp"
#include "traffic.hpp"

namespace trammel::test {

// Checks the number of clocks, and that every signal was compared in every clock.
inline void expect_all_compared(sim::LockstepCard& card, unsigned axes, std::uint64_t at_least) {
  card.settle();
  EXPECT_GE(card.cycles(), at_least);
  EXPECT_EQ(card.comparisons(), card.cycles() * sim::signals_compared(axes));
}

// Lines without a gap, an arc, a dwell, a line; about 800 clocks.
inline void short_program(Traffic& traffic, unsigned axes, AxiHost& host) {
  const auto random = [&host](std::uint64_t count) { return host.below(count); };
  std::uint64_t ticks = 0;
  for (const std::uint64_t n : {25U, 40U}) {
    traffic.send(line(n, std::vector<std::int64_t>(axes, 3)));
    ticks += n;
  }
  if (axes > 1) {
    const driver::ArcCommand arc = random_arc(random, axes);
    traffic.send(driver::with_ticks(arc, 2 * arc.path_ticks));
    ticks += 2 * arc.path_ticks;
  }
  traffic.send(feed(ticks, 1.5));
  traffic.send(driver::DwellCommand{30});
  traffic.send(line(20, std::vector<std::int64_t>(axes, -2)));
  traffic.send(feed(20, 2));
  traffic.send(driver::EndCommand{});
}

}  // namespace trammel::test
