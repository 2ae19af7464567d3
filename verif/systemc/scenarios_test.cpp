// Programs on the virtual prototype, with the unmodified driver. Each test runs in its own process, because SystemC
// elaborates only once per process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "platform.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::platform {
namespace {

using namespace std::chrono_literals;
using testing::Values;

constexpr std::int64_t kPulsesOfFourSteps = 64;

std::string names(const testing::TestParamInfo<Port>& info) { return name_of(info.param); }

void expect_arrived(Motors& machine, unsigned axis, std::int64_t at) {
  EXPECT_EQ(machine.commanded(axis), at);
  EXPECT_NEAR(machine.position(axis), static_cast<double>(at), 0.5) << "axis " << axis;
}

// Runs a program of G-code over any link.
run::Outcome run_program(Host& host, const std::string& text) {
  driver::Card card = driver::Card::open(host);
  const machine::Machine machine = machine::default_machine();
  const auto lines = [&text]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<gcode::TextLines>(text, "program");
  };
  run::Runner runner(lines, machine, planner::limits_of(card.identification()));
  runner.plan();
  const run::Outcome outcome = runner.run(card);
  host.sleep(50ms);  // time for the machine to come to rest
  return outcome;
}

std::vector<driver::Command> line_on_x(std::int64_t pulses, std::uint64_t ticks, double clocks_a_tick) {
  driver::LineCommand line;
  line.ticks = ticks;
  line.mask = 1;
  line.increment[0] = driver::rounded_increment(pulses, ticks);
  driver::FeedCommand feed;
  feed.ticks = ticks;
  feed.rate = static_cast<std::uint64_t>(std::ldexp(1 / clocks_a_tick, 64));
  return {line, feed};
}

class OverEachLink : public testing::TestWithParam<Port> {
 protected:
  Platform platform;
  const bool loose = GetParam() == Port::kLoose;
};
INSTANTIATE_TEST_SUITE_P(Systemc, OverEachLink,
                         Values(Port::kLoose, Port::kAxi, Port::kWishbone, Port::kWishboneClassic, Port::kSpi,
                                Port::kUart),
                         names);

TEST_P(OverEachLink, TheDriverMovesTheMachine) {
  bool interrupted = false;
  platform.add(GetParam(), [&](Host& host) {
    driver::Card card = driver::Card::open(host);
    EXPECT_EQ(card.identification().axes, kAxes);
    driver::run_line(card, driver::plan_line(card.timing(), {500, -300, 100, 0}, 50ms));
    interrupted = host.irq.read();
    EXPECT_EQ(card.read_snapshot().position[1], -300);
    host.sleep(50ms);
  });
  platform.run();
  expect_arrived(platform.machine(loose), 0, 500);
  expect_arrived(platform.machine(loose), 1, -300);
  expect_arrived(platform.machine(loose), 2, 100);
  expect_arrived(platform.machine(loose), 3, 0);
  EXPECT_TRUE(interrupted) << "the driver waits for the interrupt, which stays raised while the card is idle";
  EXPECT_EQ(platform.broken(), std::vector<std::string>{});
}

// Refusals arrive in order, after the accesses made before them; errors of the bus itself are link failures.
TEST_P(OverEachLink, RefusalsAndBadAddresses) {
  platform.add(GetParam(), [&](Host& host) {
    driver::Card card = driver::Card::open(host);
    driver::Access accesses[] = {driver::write_of(card_map::reg::kHoldLimit, 77),
                                 driver::write_of(card_map::reg::kMagic, 1),
                                 driver::write_of(card_map::reg::kHoldLimit, 88)};
    EXPECT_EQ(host.transfer(accesses, 3), 1U);
    EXPECT_EQ(card.parts().registers.read(card_map::reg::kHoldLimit), 77U);
    const std::optional<driver::Refusal> refusal = card.refusal();
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->reason, static_cast<std::uint8_t>(card_map::Reason::ReadOnly));
    driver::Access beyond = driver::read_of(0x1000);
    try {
      host.transfer(&beyond, 1);
      FAIL();
    } catch (const driver::LinkError& error) {
      EXPECT_STREQ(error.what(), "TLM target: TLM_ADDRESS_ERROR_RESPONSE");
    }
  });
  platform.run();
  EXPECT_EQ(platform.broken(), std::vector<std::string>{});
}

class AtBothLevels : public testing::TestWithParam<Port> {
 protected:
  const bool loose = GetParam() == Port::kLoose;
};
INSTANTIATE_TEST_SUITE_P(Systemc, AtBothLevels, Values(Port::kLoose, Port::kAxi), names);

// The switch closes at the carriage's position, not at the commanded one; the card's probe latches the commanded
// position.
TEST_P(AtBothLevels, HomingFindsTheSwitch) {
  PlatformOptions options;
  options.motors.low = -500;
  Platform platform(options);
  driver::ProbeResult found;
  platform.add(GetParam(), [&](Host& host) {
    driver::Card card = driver::Card::open(host);
    card.set_slew_time(2ms);
    driver::Stream stream(card);
    found = stream.probe(driver::ProbeCommand{0, true}, line_on_x(-1500, 6000, 50));
    host.sleep(50ms);
  });
  platform.run();
  EXPECT_EQ(found.outcome, driver::ProbeOutcome::kTripped);
  // 5,000 pulses per second: the rotor lags by some pulses, and the switch is seen at most one quantum late.
  EXPECT_LT(found.edge.position[0], -500);
  EXPECT_GT(found.edge.position[0], -500 - kPulsesOfFourSteps / 4);
  EXPECT_LT(found.rest.position[0], found.edge.position[0]);
  expect_arrived(platform.machine(loose), 0, found.rest.position[0]);
  EXPECT_EQ(platform.machine(loose).switches() & 1, 1);
}

// At full speed at once the rotor lags and loses steps; the card cannot detect that.
TEST_P(AtBothLevels, AMotorStalls) {
  Platform platform;
  platform.add(GetParam(), [&](Host& host) {
    driver::Card card = driver::Card::open(host);
    driver::run_line(card, driver::plan_line(card.timing(), {4000, 400, 0, 0}, 100ms));
    EXPECT_EQ(card.read_snapshot().position[0], 4000);
    host.sleep(100ms);
  });
  platform.run();
  EXPECT_EQ(platform.machine(loose).commanded(0), 4000);
  const double lost = 4000 - platform.machine(loose).position(0);
  EXPECT_GT(lost, 0.5 * kPulsesOfFourSteps);
  EXPECT_NEAR(std::remainder(lost, kPulsesOfFourSteps), 0, 0.5);
  expect_arrived(platform.machine(loose), 1, 400);
}

TEST(Systemc, TheSameDistancePlannedArrives) {
  Platform platform;
  run::Outcome outcome;
  platform.add(Port::kLoose, [&](Host& host) { outcome = run_program(host, "G0 X50 Y5\nM2\n"); });
  platform.run();
  EXPECT_EQ(outcome.final_position, (std::vector<std::int64_t>{4000, 400, 0, 0}));
  expect_arrived(platform.machine(true), 0, 4000);
  EXPECT_LT(platform.machine(true).largest_lag(0), kPulsesOfFourSteps / 4.0);
}

// Golden model and Verilated card side by side in one simulation: the same steps in the same order, and the machines
// end at the same position.
TEST(Systemc, BothLevelsMakeTheSameSteps) {
  const std::string program = "G1 X3 Y2 F1200\nG2 X5 Y4 I2\nG3 X3 Y2 I-2\nM2\n";
  Platform platform;
  std::vector<std::pair<unsigned, int>> steps[2];
  for (const Port port : {Port::kLoose, Port::kAxi}) {
    platform.add(port, [&](Host& host) { run_program(host, program); });
    const bool loose = port == Port::kLoose;
    platform.set_sink(loose, [&list = steps[loose ? 0 : 1]](double, const driver::PinStep& step) {
      list.emplace_back(step.axis, step.direction);
    });
  }
  platform.run();
  EXPECT_GT(steps[0].size(), 1000U);
  EXPECT_EQ(steps[0], steps[1]);
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    EXPECT_NEAR(platform.machine(true).position(axis), platform.machine(false).position(axis), 0.2);
  }
  EXPECT_EQ(platform.broken(), std::vector<std::string>{});
}

// One card and two computers: one streams over Wishbone while the other reads over the serial line.
TEST(Systemc, TwoLinksAtOnce) {
  Platform platform;
  bool done = false;
  std::vector<std::int32_t> seen;
  platform.add(Port::kWishbone, [&](Host& host) {
    EXPECT_EQ(run_program(host, "G1 X10 F1200\nM2\n").final_position[0], 800);
    done = true;
  });
  platform.add(Port::kUart, [&](Host& host) {
    driver::Card card = driver::Card::open(host);
    while (!done) seen.push_back(card.read_snapshot().position[0]);
    EXPECT_FALSE(card.refusal());
  });
  platform.run();
  ASSERT_GT(seen.size(), 2U);
  EXPECT_GT(seen[1], 0);
  EXPECT_LT(seen[1], 800);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  expect_arrived(platform.machine(false), 0, 800);
  EXPECT_EQ(platform.broken(), std::vector<std::string>{});
}

// The checkers observe the platform's own wires: they detect a master that withdraws its request.
TEST(Systemc, ARogueMasterIsFound) {
  Platform platform;
  platform.add(Port::kWishbone, [&](Host& host) {
    AxiMaster master;
    master.awvalid = true;
    platform.axi_master().write(master);
    host.sleep(3us);
    host.synchronise();
    platform.axi_master().write({});
    host.sleep(3us);
  });
  platform.run();
  EXPECT_EQ(platform.broken(), std::vector<std::string>{"AXI4-Lite: AWVALID falls before AWREADY"});
}

// A classic master changes its request while it waits, which only a pipelined master may do.
TEST(Systemc, ARogueClassicMasterIsFound) {
  Platform platform;
  platform.add(Port::kWishboneClassic, [&](Host& host) {
    WishboneMaster master;
    master.cyc = master.stb = true;
    platform.wishbone_master().write(master);
    host.sleep(2us);
    host.synchronise();
    master.adr = 4;
    platform.wishbone_master().write(master);
    host.sleep(100us);
    host.synchronise();
    platform.wishbone_master().write({});
    host.sleep(3us);
  });
  platform.run();
  EXPECT_EQ(platform.broken(), std::vector<std::string>{"Wishbone: a request changes before its answer"});
}

TEST(Systemc, PinsCanBeTraced) {
  const std::string path = testing::TempDir() + "trammel_systemc_pins";
  {
    PlatformOptions options;
    options.vcd = path;
    Platform platform(options);
    platform.add(Port::kAxi, [](Host& host) { driver::Card::open(host); });
    platform.run();
  }
  std::ifstream file(path + ".vcd");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const char* pin : {"axi_master", "awaddr", "rdata", "sck", "step", "clk"}) {
    EXPECT_NE(text.find(pin), std::string::npos) << pin;
  }
}

}  // namespace
}  // namespace trammel::platform

int sc_main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
