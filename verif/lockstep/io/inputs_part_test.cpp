// The inputs part of a card without captures and without an emergency stop: the levels of the inputs are as the model
// says, and the missing parts ask for nothing, whatever stands at their inputs.
#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/model/card_inputs.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

void missing_parts_are_silent() {
  const std::uint64_t seed = seed_from_environment(20261129);
  Simulated<Vdut> dut;
  Checker check("inputs_part", seed);
  Dice dice(seed);
  model::CardInputs model(4, 4, TRAMMEL_ENGINES);
  const std::uint64_t length = scaled(1000);
  for (std::uint64_t i = 0; i < length; ++i) {
    const std::uint32_t pins = dice.below(16);
    const model::Setting setting{dice.chance(4), card_map::reg::kInputPolarity, dice.draw()};
    dut->rst_i = i == 0;
    dut->pin_i = static_cast<CData>(pins);
    dut->setting_i = wire(setting);
    dut->capture_answer_i = static_cast<SData>(dice.below(1U << 9));
    dut->emergency_stop_i = dice.chance(2);
    dut->emergency_stop_level_i = dice.chance(2);
    dut->clear_fault_i = dice.draw();
    dut->filling_i = dice.chance(2);
    dut.clock();
    if (i != 0) model.clock({pins, setting});
    check.next_cycle();
    check.compare("levels", get(dut->inputs_o, bus::input_levels::kLevels), model.levels());
    check.compare("roles_o", dut->roles_o, roles_wire(model.roles()));
    check.compare("capture_o", dut->capture_o, 0U);
    check.compare("emergency_o", dut->emergency_o, 0U);
    check.compare("latched_o", dut->latched_o, 0U);
  }
  EXPECT_EQ(check.comparisons(), 5 * length);
}

TEST(InputsPart, MissingPartsAreSilent) { EXPECT_EQ(judge(missing_parts_are_silent), ""); }

}  // namespace
}  // namespace trammel::lockstep
