// Keys of a terminal, and how long a key counts as held.
#include "jog/jog_keys.hpp"

#include <gtest/gtest.h>

namespace trammel::app {
namespace {

using Kind = JogKey::Kind;
using Keys = std::vector<JogKey>;

JogKey move(std::size_t axis, int sign) { return {Kind::kMove, axis, sign, 0}; }

TEST(JogKeysOfBytes, AreThoseOfTerminals) {
  EXPECT_EQ(jog_keys("\x1b[A\x1b[B\x1b[C\x1b[D"), (Keys{move(1, 1), move(1, -1), move(0, 1), move(0, -1)}));
  EXPECT_EQ(jog_keys("\x1bOA\x1bOD"), (Keys{move(1, 1), move(0, -1)})) << "the cursor mode of applications";
  EXPECT_EQ(jog_keys("\x1b[5~\x1b[6~[]"), (Keys{move(2, 1), move(2, -1), move(3, -1), move(3, 1)}));
  EXPECT_EQ(jog_keys("0+- q"), (Keys{{Kind::kStep}, {Kind::kFaster}, {Kind::kSlower}, {Kind::kStop}, {Kind::kEnd}}));
  EXPECT_EQ(jog_keys("4"), (Keys{{Kind::kStep, 0, 0, 4}}));
}

TEST(JogKeysOfBytes, WhatIsUnknownOrCutMovesNothing) {
  for (const char* bytes : {"\x1b", "\x1b[", "\x1bO", "\x1b[1;5C", "\x1b[15~", "x", "\x7f", "\xc3"}) {
    EXPECT_EQ(jog_keys(bytes), Keys{{}}) << bytes;
  }
  EXPECT_EQ(jog_keys("\x1b[1;5C\x1b[C"), (Keys{{}, move(0, 1)})) << "the sequence is one key";
  EXPECT_EQ(jog_keys(""), Keys{});
}

TEST(DeadManTest, AKeyIsHeldUntilItsRepeatIsOverdue) {
  using std::chrono::milliseconds;
  const DeadMan::Time begin = std::chrono::steady_clock::now();
  DeadMan key;
  EXPECT_TRUE(key.released(begin)) << "none was pressed";
  key.press(begin);
  EXPECT_FALSE(key.released(begin + milliseconds(699)));
  EXPECT_TRUE(key.released(begin + milliseconds(700)));
  key.repeat(begin + milliseconds(500));
  EXPECT_FALSE(key.released(begin + milliseconds(699)));
  EXPECT_TRUE(key.released(begin + milliseconds(700)));
  key.repeat(begin + milliseconds(530));
  EXPECT_FALSE(key.released(begin + milliseconds(729)));
  EXPECT_TRUE(key.released(begin + milliseconds(730)));
}

}  // namespace
}  // namespace trammel::app
