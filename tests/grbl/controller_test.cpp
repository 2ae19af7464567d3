// The protocol from a sender's side: answers, states, holds and resets.
#include <gmock/gmock.h>

#include "session.hpp"

namespace trammel::grbl {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

using Texts = std::vector<std::string>;

const char* const kBanner = "Grbl 1.1h ['$' for help]";
const char* const kUnlock = "[MSG:'$H'|'$X' to unlock]";

Texts oks(std::size_t count) { return Texts(count, "ok"); }

TEST(Controller, GreetsAsGrbl) {
  Session session;
  session.controller.begin();
  EXPECT_THAT(session.answers(), ElementsAre(kBanner));
  EXPECT_EQ(session.state(), "Idle");
}

TEST(Controller, AnswersEachLineOnceAndInOrder) {
  Session session;
  session.begun();
  session.put("G21\nG1X1\n\n(nothing)\nG90 F100\nG1X1\nT999\nG4P0\nM5\n$\n");
  session.settle();
  EXPECT_THAT(session.answers(), ElementsAre("ok", "error:22", "ok", "ok", "ok", "ok", "error:38", "ok", "ok",
                                             testing::StartsWith("[HLP:$$ $# $G"), "ok"));
  EXPECT_EQ(session.fake.at()[0], 1);
}

TEST(Controller, TakesAsManyLinesAheadAsGrblsPlannerHolds) {
  Session session;
  session.begun();
  session.fake.ticks_a_motion = 10;
  Texts while_first;
  session.script([] {}, [] {}, [&] { while_first = session.answers(); });
  for (int n = 0; n < 20; ++n) session.put("G1X" + std::to_string(n + 1) + "F1000\n");
  session.settle();
  // The first is under way; 15 are planned.
  EXPECT_EQ(while_first, oks(16));
  EXPECT_EQ(session.answers(), oks(4));
  EXPECT_EQ(session.fake.at()[0], 20);
  EXPECT_EQ(session.fake.motions.size(), 20U);
}

}  // namespace
}  // namespace trammel::grbl
