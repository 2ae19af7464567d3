#include "trammel/report/page_stream.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include "stream_reader.hpp"
#include "text.hpp"

namespace trammel::report {
namespace {

// Test vectors of RFC 4648.
TEST(Base64, IsThatOfTheStandard) {
  const auto text = [](const std::string& bytes) {
    return base64(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  };
  EXPECT_EQ(text(""), "");
  EXPECT_EQ(text("f"), "Zg==");
  EXPECT_EQ(text("fo"), "Zm8=");
  EXPECT_EQ(text("foo"), "Zm9v");
  EXPECT_EQ(text("foobar"), "Zm9vYmFy");
}

TEST(PageStream, ComesBackWholeFromSeveralElements) {
  Text page;
  std::string expected;
  {
    std::mt19937 random(1);
    PageStream noise(page, "noise");
    PageStream other(page, "other");
    for (int i = 0; i < 600'000; ++i) {
      const char byte = static_cast<char>(random());
      expected += byte;
      noise.bytes({&byte, 1});
      if (i % 1000 == 0) other.bytes("other");
    }
    noise.finish();
    other.finish();
  }
  const Elements found = elements(page.all, "noise");
  EXPECT_GE(found.count, 3U);
  EXPECT_EQ(inflated(found.bytes, expected.size()), expected);
  EXPECT_EQ(inflated(elements(page.all, "other").bytes, 3000).size(), 3000U);
}

TEST(PageStream, NumbersHaveTheirBytes) {
  Text page;
  PageStream stream(page, "numbers");
  stream.varint(0);
  stream.varint(127);
  stream.varint(128);
  stream.varint(~std::uint64_t{0});
  stream.zigzag(-1);
  stream.zigzag(1);
  stream.zigzag(-64);
  stream.number(1.0F);
  stream.number(-2.0);
  stream.finish();
  const std::string expected(
      "\x00\x7F\x80\x01\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01\x01\x02\x7F\x00\x00\x80\x3F\x00\x00\x00\x00\x00\x00\x00"
      "\xC0",
      29);
  EXPECT_EQ(inflated(elements(page.all, "numbers").bytes, 100), expected);
}

}  // namespace
}  // namespace trammel::report
