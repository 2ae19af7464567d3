// The judge of the self-test: a counter of steps, modulo 16.
#include <gtest/gtest.h>

#include "Vdut.h"
#include "trammel/sim/lockstep.hpp"

namespace {

using namespace trammel;

TEST(SelftestCounter, CountsEveryStep) {
  const std::string complaint = lockstep::judge([] {
    lockstep::Simulated<Vdut> rtl;
    lockstep::Checker checker("selftest_counter", 1);
    unsigned count = 0;
    for (unsigned i = 0; i < 200; ++i) {
      const bool reset = i % 50 == 0;
      const bool step = i % 3 != 0;
      rtl->rst_i = reset;
      rtl->step_i = step;
      rtl.clock();
      if (reset)
        count = 0;
      else if (step)
        count = (count + 1) % 16;
      checker.next_cycle();
      checker.compare("count_o", rtl->count_o, count);
    }
  });
  EXPECT_EQ(complaint, "");
}

}  // namespace
