// Probing by a sender on a simulated machine: Z touches the default world's plate at -20 mm.
#include <array>

#include "card_session.hpp"

namespace trammel::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr unsigned kZ = 2;
constexpr double kPerMm = 80;   // pulses per mm
constexpr double kPlate = -20;  // mm
constexpr double kLag = 0.05;   // mm by which a carriage lags behind its pulses at 20 mm/s

// X, Y and Z of "[PRB:0.000,0.000,-20.025:1]", and its last digit.
struct Prb {
  std::array<double, 3> at{};
  int tripped = -1;
};

Prb prb_of(const std::string& said) {
  Prb prb;
  const std::size_t begin = said.find("[PRB:");
  if (begin == std::string::npos) return prb;
  double a = 0;
  const std::string text = said.substr(begin, said.find(']', begin) - begin);
  const int count = std::sscanf(text.c_str(), "[PRB:%lf,%lf,%lf,%lf", &prb.at[0], &prb.at[1], &prb.at[2], &a);
  EXPECT_GE(count, 3) << text;
  prb.tripped = text.back() - '0';
  return prb;
}

class ProbeAtAPlate : public ::testing::TestWithParam<sim::EngineKind> {
 protected:
  double z() { return static_cast<double>(session_.engine().positions()[kZ]) / kPerMm; }

  CardSession session_{GetParam(), first_machine_with_outputs(), true};
};

TEST_P(ProbeAtAPlate, TellsWhereTheCardWasAtTheEdge) {
  session_.ask("G90 G0 X3 Y2 Z-19");
  const std::string said = session_.ask("G91 G38.2 Z-5 F1200");
  EXPECT_TRUE(session_.world.pressed("probe"));
  const Prb prb = prb_of(said);
  EXPECT_EQ(prb.tripped, 1) << said;
  EXPECT_EQ(prb.at[0], 3);
  EXPECT_EQ(prb.at[1], 2);
  EXPECT_LE(prb.at[kZ], kPlate);
  EXPECT_GT(prb.at[kZ], kPlate - kLag);
  EXPECT_NEAR(prb.at[kZ], session_.card.read_probe_snapshot().position[kZ] / kPerMm, 0.0005) << "of its digits";
  EXPECT_LT(z(), prb.at[kZ] - 1 / kPerMm) << "it stands where its ramp ended";
  EXPECT_THAT(said, Not(HasSubstr("ALARM")));
  EXPECT_THAT(session_.ask("$#"), HasSubstr(said.substr(said.find("[PRB:"), said.find(']') - said.find("[PRB:"))));
  // The probe leaves the plate again: its contact opens 0.0125 mm higher.
  const Prb off = prb_of(session_.ask("G38.4 Z5 F120"));
  EXPECT_EQ(off.tripped, 1);
  EXPECT_GT(off.at[kZ], kPlate);
  EXPECT_LT(off.at[kZ], kPlate + kLag);
}

TEST_P(ProbeAtAPlate, AMissIsAlarm5) {
  const std::string said = session_.ask("G91 G38.2 Z-2 F3000");
  EXPECT_THAT(said, HasSubstr("ALARM:5"));
  EXPECT_EQ(prb_of(said).tripped, 0) << said;
  EXPECT_EQ(z(), -2) << "its end, which is known";
  EXPECT_THAT(session_.ask("G1 Z1"), HasSubstr("error:9"));
  EXPECT_THAT(session_.ask("$X"), HasSubstr("ok"));
  const std::string asked = session_.ask("G91 G38.3 Z-2 F3000");
  EXPECT_THAT(asked, Not(HasSubstr("ALARM"))) << "G38.3 allows a miss";
  EXPECT_EQ(prb_of(asked).tripped, 0);
  EXPECT_EQ(z(), -4);
}

TEST_P(ProbeAtAPlate, ATripBeforeItBeginsIsAlarm4) {
  session_.ask("G90 G0 Z-20.5");
  ASSERT_TRUE(session_.world.pressed("probe"));
  const std::string said = session_.ask("G91 G38.2 Z-2 F1200");
  EXPECT_THAT(said, HasSubstr("ALARM:4"));
  EXPECT_EQ(z(), -20.5) << "nothing has moved";
  EXPECT_THAT(session_.ask("$X"), HasSubstr("ok"));
  EXPECT_THAT(session_.ask("G90 G0 Z-19"), HasSubstr("ok"));
  EXPECT_EQ(z(), -19);
}

INSTANTIATE_TEST_SUITE_P(Engines, ProbeAtAPlate, ::testing::Values(sim::EngineKind::kModel, sim::EngineKind::kRtl),
                         [](const auto& tried) { return tried.param == sim::EngineKind::kModel ? "Model" : "Rtl"; });

}  // namespace
}  // namespace trammel::test
