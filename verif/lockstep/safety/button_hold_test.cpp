// Lockstep of the buttons: every sequence of their levels over eight clocks.
#include "trammel/model/button_hold.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

void every_course_of_levels() {
  Simulated<Vdut> dut;
  Checker check("button_hold", 0);
  constexpr unsigned kClocks = 8;
  std::uint64_t held = 0;
  for (unsigned course = 0; course < 1U << 2 * kClocks; ++course) {
    model::ButtonHold model;
    dut->rst_i = 1;
    for (unsigned clock = 0; clock <= kClocks; ++clock) {
      model::InputRoles roles;
      roles.feed_hold = clock != 0 && (course >> 2 * (clock - 1) & 1) != 0;
      roles.cycle_start = clock != 0 && (course >> 2 * (clock - 1) & 2) != 0;
      dut->roles_i = roles_wire(roles);
      dut.clock();
      if (clock != 0) model.clock(roles);
      dut->rst_i = 0;
      check.next_cycle();
      check.compare("hold_o", dut->hold_o, model.hold());
      held += model.hold() ? 1U : 0U;
    }
  }
  EXPECT_EQ(check.comparisons(), (kClocks + 1) << 2 * kClocks);
  EXPECT_GT(held, check.comparisons() / 4);
}

TEST(ButtonHold, EveryCourse) { EXPECT_EQ(judge(every_course_of_levels), ""); }

}  // namespace
}  // namespace trammel::lockstep
