// Tests of the judges: the text of a mismatch report, the events kept for it, the length of a random scenario.
#include "trammel/sim/lockstep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

namespace trammel::lockstep {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The mismatch report of `scenario`; empty if there is none.
template <class Scenario>
std::string report_of(Scenario scenario) {
  try {
    scenario();
  } catch (const Mismatch& mismatch) {
    return mismatch.what();
  }
  return {};
}

TEST(Checker, EqualSignalsAreCountedAndPass) {
  Checker checker("block", 7);
  for (int i = 0; i < 5; ++i) {
    checker.next_cycle();
    checker.compare("a_o", 1, true);
    checker.compare("b_o", 0x8000'0000'0000'0000U, std::uint64_t{1} << 63);
  }
  EXPECT_EQ(checker.cycles(), 5U);
  EXPECT_EQ(checker.comparisons(), 10U);
}

// Sets an environment variable and restores it.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    if (value != nullptr)
      setenv(name, value, 1);
    else
      unsetenv(name);
  }
  ~Environment() {
    if (old_)
      setenv(name_, old_->c_str(), 1);
    else
      unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

TEST(Checker, ClocksOfAllCheckersAreAdded) {
  const std::uint64_t before = trammel::lockstep::compared();
  for (const std::uint64_t clocks : {3U, 4U}) {
    Checker checker("dut", 1);
    for (std::uint64_t i = 0; i < clocks; ++i) checker.next_cycle();
  }
  EXPECT_EQ(trammel::lockstep::compared() - before, 7U);
}

TEST(Checker, ReportNamesBlockCycleSignalValuesSeedAndEvents) {
  const Environment state("TRAMMEL_STATE_SEED", "5");
  Checker checker("block", 77);
  checker.event("swap", 0xAB);
  for (int i = 0; i < 12; ++i) checker.next_cycle();
  checker.compare("right_o", 3, 3);
  const std::string report = report_of([&] { checker.compare("wrong_o", 0x10, 0x2F); });
  EXPECT_EQ(report,
            "block: cycle 12: wrong_o is 0x10 (16) in RTL, 0x2f (47) in the model\n"
            "repeat with TRAMMEL_SEED=77 TRAMMEL_STATE_SEED=5\n"
            "last 1 events:\n"
            "  cycle 0: swap 0xab\n");
}

// One wrong bit is enough, at any position.
TEST(Checker, EveryBitCounts) {
  Checker checker("block", 1);
  for (int bit = 0; bit < 64; ++bit) {
    EXPECT_THAT(report_of([&] { checker.compare("x_o", std::uint64_t{1} << bit, 0); }), HasSubstr("x_o")) << bit;
  }
}

TEST(Checker, LastEventsAreKept) {
  Checker checker("block", 1);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    checker.event("event", i);
    checker.next_cycle();
  }
  const std::string report = report_of([&] { checker.compare("x_o", 0, 1); });
  EXPECT_THAT(report, AllOf(HasSubstr("last 32 events"), HasSubstr("cycle 968: event 0x3c8"),
                            HasSubstr("cycle 999: event 0x3e7"), Not(HasSubstr("cycle 967:"))));
}

// A mismatch that is found late is reported with the events before it, however many came after it.
TEST(EventLog, EventsBehindTheCycleAreLeftOut) {
  EventLog log;
  for (std::uint64_t i = 0; i < 100; ++i) log.add(i, "event", i);
  const std::string text = log.text(50);
  EXPECT_THAT(text, AllOf(HasSubstr("last 32 events"), HasSubstr("cycle 19:"), HasSubstr("cycle 50:"),
                          Not(HasSubstr("cycle 18:")), Not(HasSubstr("cycle 51:"))));
  // All cycles up to 60 are judged. Cycles 29 to 60 are kept for a mismatch at 61, together with the later ones.
  log.settle(60);
  EXPECT_EQ(log.size(), EventLog::kKept + 39);
  EXPECT_THAT(log.text(60), AllOf(HasSubstr("last 32 events"), HasSubstr("cycle 29:"), HasSubstr("cycle 60:")));
  log.settle(99);
  EXPECT_EQ(log.size(), EventLog::kKept);
  EXPECT_THAT(log.text(99), AllOf(HasSubstr("cycle 68:"), HasSubstr("cycle 99:")));
}

TEST(Fail, AllDifferencesAreNamed) {
  const Environment state("TRAMMEL_STATE_SEED", "4");
  EXPECT_EQ(report_of([] {
              fail("card", 9, 3, {{"a_o", 1, 0}, {"b_o", 2, 4}}, "");
            }),
            "card: cycle 9: a_o is 0x1 (1) in RTL, 0x0 (0) in the model\n"
            "card: cycle 9: b_o is 0x2 (2) in RTL, 0x4 (4) in the model\n"
            "repeat with TRAMMEL_SEED=3 TRAMMEL_STATE_SEED=4\n");
}

TEST(Fail, DifferenceWithoutANameIsAnError) { EXPECT_THROW(fail("card", 9, 3, {}, ""), std::logic_error); }

TEST(Judge, MismatchIsReturnedOtherErrorsPassThrough) {
  EXPECT_EQ(judge([] {}), "");
  EXPECT_EQ(judge([] { throw Mismatch("report"); }), "report");
  EXPECT_THROW(judge([] { throw std::logic_error("no mismatch"); }), std::logic_error);
}

TEST(StateSeed, IsItsOwnElseThatOfTheScenariosAndNeverZero) {
  const Environment scenario("TRAMMEL_SEED", nullptr);
  const Environment none("TRAMMEL_STATE_SEED", nullptr);
  EXPECT_EQ(state_seed(), 1);
  const Environment given("TRAMMEL_SEED", "6");
  EXPECT_EQ(state_seed(), 6);
  const Environment own("TRAMMEL_STATE_SEED", "8");
  EXPECT_EQ(state_seed(), 8);
  for (const char* beyond : {"0", "4294967294", "18446744073709551615"}) {
    const Environment environment("TRAMMEL_STATE_SEED", beyond);
    EXPECT_GT(state_seed(), 0) << beyond;
  }
}

TEST(Scaled, TakesTheFactorFromTheEnvironment) {
  {
    const Environment none("TRAMMEL_LONG", nullptr);
    EXPECT_EQ(scaled(400), 400U);
  }
  {
    const Environment long_run("TRAMMEL_LONG", "25");
    EXPECT_EQ(scaled(400), 10'000U);
  }
  {
    const Environment short_run("TRAMMEL_LONG", "0.01");
    EXPECT_EQ(scaled(400), 4U);
    EXPECT_EQ(scaled(1), 1U);
  }
  for (const char* wrong : {"", "0", "-1", "1e7", "nan", "long", "2x"}) {
    const Environment environment("TRAMMEL_LONG", wrong);
    EXPECT_THROW(scaled(1), std::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace trammel::lockstep
