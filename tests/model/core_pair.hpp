// Two cores get the same orders. Their outputs, positions, reported steps and visible states must be equal.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing {

class Pair {
 public:
  // ClockAndRun: one core is clocked, the other one jumps. AllAndResting: one core clocks every block, the other one
  // leaves out blocks at rest.
  enum class Of { ClockAndRun, AllAndResting };

  Pair(Of of, const model::CardConfig& config, std::uint64_t seed)
      : of_(of), clocked(config), jumping(config), random(seed) {
    clocked.logs = jumping.logs = of == Of::AllAndResting;
    clocked.skips = of != Of::AllAndResting;
  }

  std::uint64_t any(std::uint64_t low, std::uint64_t high) { return low + random() % (high - low + 1); }
  // A number of random magnitude, below 2^bits.
  std::uint64_t sized(unsigned bits) {
    const std::uint64_t size = any(0, bits);
    return size == 0 ? 0 : random() >> (64 - size);
  }
  bool one_in(std::uint64_t n) { return random() % n == 0; }

  bool write(std::uint32_t address, std::uint32_t data) {
    const bool good = clocked.write(address, data);
    EXPECT_EQ(jumping.write(address, data), good);
    return good;
  }
  bool send(const std::vector<std::uint32_t>& words) {
    const bool good = clocked.send(words);
    EXPECT_EQ(jumping.send(words), good);
    return good;
  }
  void wait(std::uint64_t clocks) {
    clocked.idle(clocks);
    if (of_ == Of::ClockAndRun)
      skip::run(jumping.core, clocks, jumping.pins);
    else
      jumping.idle(clocks);
    waits += 1;
  }
  // The same as wait() with a jump; counts the clocks of those jumps in which the ratio changed.
  void wait_on_ramps(std::uint64_t clocks) {
    clocked.idle(clocks);
    while (clocks != 0) {
      const std::uint32_t ratio = jumping.core.outputs().ratio;
      const std::uint64_t gone = skip::jump(jumping.core, clocks, jumping.pins);
      if (gone == 0) jumping.idle(1);
      if (jumping.core.outputs().ratio != ratio) on_ramps += gone;
      clocks -= std::max<std::uint64_t>(gone, 1);
    }
  }
  void compare() {
    ASSERT_EQ(clocked.core.cycles(), jumping.core.cycles());
    const auto& a = clocked.core.outputs();
    const auto& b = jumping.core.outputs();
    ASSERT_TRUE(a == b) << "cycle " << clocked.core.cycles() << " rate " << a.rate << " " << b.rate << " status "
                        << a.status << " " << b.status << " tick " << a.tick << b.tick << " path " << a.path_step
                        << b.path_step << " dir " << a.path_dir << b.path_dir << " pins " << a.step << b.step;
    for (std::size_t i = 0; i < clocked.log.size(); ++i)
      ASSERT_TRUE(clocked.log[i] == jumping.log[i]) << clocked.log.size() - i - 1 << " clocks before";
    for (unsigned n = 0; n < clocked.core.config().axes; ++n)
      ASSERT_EQ(clocked.core.position(n), jumping.core.position(n)) << "axis " << n;
    ASSERT_TRUE(clocked.steps.pins == jumping.steps.pins) << "cycle " << clocked.core.cycles();
    ASSERT_TRUE(clocked.steps.path == jumping.steps.path) << "cycle " << clocked.core.cycles();
    // Equal records need no second comparison.
    for (CoreBench* bench : {&clocked, &jumping}) {
      steps += bench->steps.pins.size();
      bench->steps.pins.clear();
      bench->steps.path.clear();
      one_by_one += bench->log.size();
      bench->log.clear();
    }
  }
  // Waits of many lengths, so that the jumps end at all kinds of clocks.
  void wait_in_pieces(std::uint64_t clocks, std::uint64_t longest) {
    while (clocks != 0 && !::testing::Test::HasFatalFailure()) {
      const std::uint64_t piece = std::min(clocks, one_in(4) ? any(1, longest) : any(1, 90));
      wait(piece);
      compare();
      clocks -= piece;
    }
  }

  const Of of_;
  CoreBench clocked;
  CoreBench jumping;
  std::mt19937_64 random;
  std::uint64_t waits = 0;
  std::uint64_t steps = 0;
  std::uint64_t chord_arcs = 0;
  std::uint64_t on_ramps = 0;
  std::uint64_t one_by_one = 0;  // clocks compared one by one, on both cores
};

}  // namespace trammel::testing
