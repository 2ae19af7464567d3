// Bytes from a sender: real-time commands, lines, and the text of a line after cleaning.
#include "trammel/grbl/input_buffer.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace trammel::grbl {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

struct Received {
  std::vector<int> realtime;
  InputBuffer buffer{[this](std::uint8_t byte) { realtime.push_back(byte); }};

  std::vector<std::string> lines() {
    std::vector<std::string> all;
    while (const auto line = buffer.take()) all.push_back(*line);
    return all;
  }
};

std::vector<std::string> lines_of(const std::string& bytes) {
  Received received;
  received.buffer.put(bytes);
  return received.lines();
}

TEST(InputBuffer, TakesRealTimeCommandsOutOfALine) {
  Received received;
  received.buffer.put("?G1!X\x18 1~\x85(?)\x90\x9D\n");
  EXPECT_THAT(received.realtime, ElementsAre('?', '!', 0x18, '~', 0x85, '?', 0x90, 0x9D));
  EXPECT_THAT(received.lines(), ElementsAre("G1X 1()"));
}

TEST(InputBuffer, TakesEachByteFrom128AsACommandOnceAndNoOther) {
  Received received;
  for (int byte = 0; byte < 256; ++byte) received.buffer.put(std::string(1, static_cast<char>(byte)));
  std::vector<int> commands{0x18, '!', '?', '~'};
  for (int byte = 0x80; byte < 256; ++byte) {
    if (byte != 0xC2) commands.push_back(byte);
  }
  EXPECT_EQ(received.realtime, commands);
}

TEST(InputBuffer, TakesCommandsInUtf8) {
  Received received;
  received.buffer.put("\xC2\x96");
  received.buffer.put("\xC2");
  received.buffer.put("\x85G0\n");
  EXPECT_THAT(received.realtime, ElementsAre(0x96, 0x85));
  EXPECT_THAT(received.lines(), ElementsAre("G0"));
}

TEST(InputBuffer, EndsLinesAtLineFeedCarriageReturnAndBoth) {
  EXPECT_THAT(lines_of("a\nb\rc\r\nd\n\n\r\re"), ElementsAre("a", "b", "c", "d", "", "", ""));
  EXPECT_THAT(lines_of("\r\n\r\n"), ElementsAre("", ""));
}

TEST(InputBuffer, EndsLinesWhereverTheBytesAreParted) {
  const std::string bytes = "a\r\nb\n\rc\r\n";
  for (std::size_t part = 1; part < bytes.size(); ++part) {
    Received received;
    received.buffer.put(bytes.substr(0, part));
    received.buffer.put(bytes.substr(part));
    EXPECT_THAT(received.lines(), ElementsAre("a", "b", "", "c")) << part;
  }
}

TEST(InputBuffer, GivesALineWhenItHasEnded) {
  Received received;
  received.buffer.put("G1");
  EXPECT_THAT(received.lines(), IsEmpty());
  received.buffer.put("X1\nG2");
  EXPECT_THAT(received.lines(), ElementsAre("G1X1"));
  received.buffer.clear();
  received.buffer.put("G3\n");
  EXPECT_THAT(received.lines(), ElementsAre("G3"));
}

TEST(InputBuffer, CountsTheRoomOf128Bytes) {
  Received received;
  EXPECT_EQ(received.buffer.room(), 128U);
  received.buffer.put("G0X1\n?!");
  EXPECT_EQ(received.buffer.room(), 123U);
  received.buffer.put(std::string(123, 'G'));
  EXPECT_EQ(received.buffer.room(), 0U);
  received.buffer.put("X");
  EXPECT_EQ(received.buffer.room(), 0U);
  EXPECT_THAT(received.lines(), ElementsAre("G0X1"));
  EXPECT_EQ(received.buffer.room(), 4U);
  received.buffer.clear();
  EXPECT_EQ(received.buffer.room(), 128U);
}

TEST(InputBuffer, DropsWhatHasNoPlace) {
  Received received;
  received.buffer.put(std::string(InputBuffer::kMost + 100, 'G') + "?");
  received.buffer.put("\n");
  EXPECT_THAT(received.lines(), IsEmpty());
  EXPECT_THAT(received.realtime, ElementsAre('?'));
  received.buffer.clear();
  received.buffer.put("G0\n");
  EXPECT_THAT(received.lines(), ElementsAre("G0"));
}

TEST(Cleaned, LeavesLettersInUpperCaseWithoutBlanks) {
  EXPECT_EQ(cleaned(" g1\tx 1.5\x01 y-2 "), "G1X1.5Y-2");
  EXPECT_EQ(cleaned(""), "");
  EXPECT_EQ(cleaned("   "), "");
  EXPECT_EQ(cleaned("/G0 X1"), "G0X1");
  EXPECT_EQ(cleaned("$j=x1f100"), "$J=X1F100");
}

TEST(Cleaned, LeavesCommentsOut) {
  EXPECT_EQ(cleaned("G0(one)X1(two)"), "G0X1");
  EXPECT_EQ(cleaned("G0;X1(two)"), "G0");
  EXPECT_EQ(cleaned("(a;b)G0"), "G0");
  EXPECT_EQ(cleaned("(a(b)G0"), "G0");
  EXPECT_EQ(cleaned("G0(open"), "G0");
  EXPECT_EQ(cleaned(";"), "");
  EXPECT_EQ(cleaned("G0)X1"), "G0)X1");  // error 1, as in Grbl
}

// Grbl refuses '%', but programs begin and end with it.
TEST(Cleaned, LeavesLinesWithAPercentSignOut) {
  EXPECT_EQ(cleaned("%"), "");
  EXPECT_EQ(cleaned(" % a program"), "");
  EXPECT_EQ(cleaned("G0%"), "G0%");
}

TEST(Cleaned, CountsWhatIsLeftOfALongLine) {
  EXPECT_EQ(cleaned(std::string(79, 'G')).size(), kLongestLine);
  EXPECT_GT(cleaned(std::string(80, 'G')).size(), kLongestLine);
  EXPECT_EQ(cleaned("(" + std::string(500, 'c') + ")G0" + std::string(200, ' ')), "G0");
  EXPECT_LT(cleaned(std::string(60'000, 'G')).size(), 100U);
}

}  // namespace
}  // namespace trammel::grbl
