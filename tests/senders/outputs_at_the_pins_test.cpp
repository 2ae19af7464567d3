// Spindle and coolant at the card's pins, when the user of a sender, or the card, ends the motion.
#include "card_session.hpp"

namespace trammel::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr unsigned kBoth = 1U << kSpindle | 1U << kCoolant;
constexpr unsigned kX = 0;
constexpr std::int64_t kMm = 80;  // pulses per mm

class PinsOfOutputs : public ::testing::TestWithParam<sim::EngineKind> {
 protected:
  // A session with spindle and coolant on.
  std::unique_ptr<CardSession> running(const machine::Machine& machine = first_machine_with_outputs()) {
    auto session = std::make_unique<CardSession>(GetParam(), machine);
    EXPECT_EQ(session->levels(), 0U);
    EXPECT_THAT(session->ask("M3 S1000 M8"), HasSubstr("ok"));
    EXPECT_EQ(session->levels(), kBoth);
    return session;
  }
  // The outputs are off at the pins, were switched off once each, and are reported as off.
  void expect_off(CardSession& session) {
    EXPECT_EQ(session.levels(), 0U);
    for (const unsigned output : {kSpindle, kCoolant}) EXPECT_EQ(session.outputs.outputs()[output].off, 1U) << output;
    EXPECT_THAT(session.ask("$G"), HasSubstr("M5 M9"));
  }
};

TEST_P(PinsOfOutputs, AResetAtRestSwitchesThemOff) {
  const auto session = running();
  session->put("\x18");
  session->settle();
  expect_off(*session);
}

TEST_P(PinsOfOutputs, AResetInMotionSwitchesThemOff) {
  const auto session = running();
  const std::string said = session->ask_and_then("G91 G1 X10 F3000", kX, 2 * kMm, "\x18");
  EXPECT_THAT(said, HasSubstr("Grbl 1.1h"));
  const std::int64_t at = session->engine().positions()[kX];
  EXPECT_LT(at, 10 * kMm) << "stopped on the way";
  expect_off(*session);
  EXPECT_THAT(session->ask("G91 G1 X1 F3000"), HasSubstr("ok"));
  EXPECT_EQ(session->engine().positions()[kX], at + kMm) << "the place is known";
  EXPECT_EQ(session->levels(), 0U) << "nothing but a line switches them on";
  session->ask("M3");
  EXPECT_EQ(session->levels(), 1U << kSpindle);
}

TEST_P(PinsOfOutputs, ASoftLimitsAlarmSwitchesThemOff) {
  const auto session = running();
  EXPECT_THAT(session->ask("G90 G1 X-100 F3000"), HasSubstr("ALARM:2"));
  EXPECT_EQ(session->levels(), 0U);
  EXPECT_THAT(session->ask("$X"), HasSubstr("ok"));
  EXPECT_THAT(session->ask("G1 X1 F3000"), HasSubstr("ok"));
  expect_off(*session);
}

// The card then has a fault and takes no commands: outputs that the fault switches off are at their safe levels, and
// the others are switched off by $X.
TEST_P(PinsOfOutputs, ALimitSwitchesAlarmLeavesThemToTheSafeLevelsUntilTheUnlock) {
  machine::Machine machine = first_machine_with_outputs();
  machine.outputs.off_at_cause = 1U << kSpindle;
  const auto session = running(machine);
  const auto press = [&] { session->engine().set_input(1, true); };  // x_limit_plus
  const std::string said = session->ask_and_then("G91 G1 X10 F3000", kX, 2 * kMm, "", press);
  EXPECT_THAT(said, AllOf(HasSubstr("ALARM:1"), HasSubstr("[MSG:LIMIT (X plus)]")));
  EXPECT_LT(session->engine().positions()[kX], 10 * kMm) << "stopped on the way";
  EXPECT_EQ(session->levels(), 1U << kCoolant) << "off_at_cause names the spindle alone";
  EXPECT_THAT(session->ask("$G"), HasSubstr("M5 M9"));
  session->engine().set_input(1, false);
  EXPECT_THAT(session->ask("$X"), HasSubstr("ok"));
  expect_off(*session);
  EXPECT_THAT(session->ask("G91 G1 X-1 F3000"), HasSubstr("ok"));
  EXPECT_EQ(session->levels(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Engines, PinsOfOutputs, ::testing::Values(sim::EngineKind::kModel, sim::EngineKind::kRtl),
                         [](const auto& tried) { return tried.param == sim::EngineKind::kModel ? "Model" : "Rtl"; });

}  // namespace
}  // namespace trammel::test
