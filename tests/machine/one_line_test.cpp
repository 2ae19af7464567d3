#include "trammel/machine/one_line.hpp"

#include <gtest/gtest.h>

#include <string>

namespace trammel::machine {
namespace {

TEST(OneLine, ControlCharactersAndWhatIsNoUtf8AreEscaped) {
  EXPECT_EQ(one_line("a\nb\tc\r\x1b[1m\x7f", 80), "a\\nb\\tc\\r\\x1b[1m\\x7f");
  EXPECT_EQ(one_line(std::string("a\0b", 3), 80), "a\\x00b");
  EXPECT_EQ(one_line("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80", 80), "\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(one_line("caf\xe9.ngc", 80), "caf\\xe9.ngc");
  EXPECT_EQ(one_line("\xc3", 80), "\\xc3");
  EXPECT_EQ(one_line("\xc0\x80", 80), "\\xc0\\x80") << "not the shortest form";
  EXPECT_EQ(one_line("\xe0\x82\xac", 80), "\\xe0\\x82\\xac") << "not the shortest form";
  EXPECT_EQ(one_line("\xed\xa0\x80", 80), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(one_line("\xf4\x90\x80\x80", 80), "\\xf4\\x90\\x80\\x80") << "beyond U+10FFFF";
}

TEST(OneLine, IsCutBetweenCharacters) {
  EXPECT_EQ(one_line("12345", 5), "12345");
  EXPECT_EQ(one_line("123456", 5), "12...");
  EXPECT_EQ(one_line("1\xc3\xa4\xc3\xa4", 5), "1\xc3\xa4\xc3\xa4");
  EXPECT_EQ(one_line("1\xc3\xa4\xc3\xa4x", 5), "1...") << "not within the character";
  EXPECT_EQ(one_line("1\xff\xff", 5), "1...") << "nor within an escape";
}

}  // namespace
}  // namespace trammel::machine
