// Lockstep of the health outputs: random faults, watchdog and settings; both outputs in every cycle.
#include "trammel/model/card_health.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kComparedSignals = 2;

void random_courses() {
  const std::uint64_t seed = seed_from_environment(43);
  Simulated<Vdut> dut;
  model::CardHealth model;
  Checker check("card_health", seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(400'000);
  std::uint64_t edges = 0;
  model::CardHealth::Inputs in;
  const auto clock = [&](bool reset) {
    dut->rst_i = reset;
    dut->setting_i = wire(in.setting);
    dut->fault_i = in.fault;
    dut->fed_i = in.fed;
    dut.clock();
    const bool pump = model.pump();
    if (reset)
      model = model::CardHealth();
    else
      model.clock(in);
    edges += pump != model.pump() ? 1U : 0U;
    check.next_cycle();
    check.compare("healthy_o", dut->healthy_o, model.healthy());
    check.compare("pump_o", dut->pump_o, model.pump());
  };
  clock(true);
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(in.fault != 0 ? 20 : 100)) in.fault = in.fault != 0 ? 0 : dice.draw() & 0x7FFFF;
    if (dice.chance(60)) in.fed = !in.fed;
    in.setting = {};
    if (dice.chance(50)) {
      const bool causes = dice.chance(2);
      const std::uint32_t mask = (dice.draw() & dice.draw() & 0x7FFFF) | (dice.chance(2) ? 1U << 31 : 0);
      in.setting = {dice.chance(4) ? false : true, causes ? reg::kHealthCauses : reg::kChargePump,
                    causes ? mask : static_cast<std::uint32_t>(dice.log_uniform(16))};
    }
    if (in.setting.set) check.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    if (in.fault != 0) check.event("fault", in.fault);
    clock(dice.chance(5000));
  }
  EXPECT_EQ(check.comparisons(), kComparedSignals * (length + 1));
  EXPECT_GT(edges, length / 50);
}

TEST(CardHealth, RandomCourses) { EXPECT_EQ(judge(random_courses), ""); }

}  // namespace
}  // namespace trammel::lockstep
