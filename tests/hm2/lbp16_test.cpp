// Datagrams of LBP16: decoding, refusals and their reasons.
#include "trammel/hm2/lbp16.hpp"

#include <gtest/gtest.h>

#include "bench.hpp"

namespace trammel::hm2 {
namespace {

Defect defect_of(const Bytes& datagram) {
  std::vector<Command> commands;
  return decode(datagram.data(), datagram.size(), commands);
}

TEST(Lbp16, CommandsAreTakenApart) {
  Bytes datagram;
  append_read(datagram, Space::kControl, 2, 8, 1);
  append_write(datagram, 0x2000, {0x01020304, 5});
  append_read(datagram, Space::kHostmot2, 4, 0x2100, 4);
  // As hm2_eth sends them: header words, low byte first.
  EXPECT_EQ(Bytes(datagram.begin(), datagram.begin() + 4), (Bytes{0x81, 0x59, 0x08, 0x00}));
  EXPECT_EQ(Bytes(datagram.begin() + 4, datagram.begin() + 12), (Bytes{0x82, 0xC2, 0x00, 0x20, 4, 3, 2, 1}));
  std::vector<Command> commands;
  ASSERT_EQ(decode(datagram.data(), datagram.size(), commands), Defect::kNone);
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].space, 6);
  EXPECT_EQ(commands[0].size(), 2U);
  EXPECT_FALSE(commands[0].write);
  EXPECT_TRUE(commands[1].write);
  EXPECT_EQ(commands[1].address, 0x2000);
  EXPECT_EQ(word_of(commands[1].data + 4), 5U);
  EXPECT_EQ(commands[2].units, 4);
}

TEST(Lbp16, EveryBeginningOfADatagramIsTooShortOrWhole) {
  Bytes datagram;
  append_write(datagram, 0x2000, {1, 2, 3});
  append_read(datagram, Space::kHostmot2, 4, 0x2100, 4);
  const std::size_t write_end = 4 + 12;
  for (std::size_t size = 0; size < datagram.size(); ++size) {
    const Defect expected = size == write_end ? Defect::kNone : Defect::kShort;
    EXPECT_EQ(defect_of(Bytes(datagram.begin(), datagram.begin() + static_cast<std::ptrdiff_t>(size))), expected)
        << size;
  }
}

TEST(Lbp16, FormsThatNobodyHereSpeaksAreRefused) {
  EXPECT_EQ(defect_of({0x81, 0x02, 0, 0}), Defect::kForm);         // no address
  EXPECT_EQ(defect_of({0x81, 0x62, 0, 0}), Defect::kForm);         // a space's description
  EXPECT_EQ(defect_of({0x80, 0x42, 0, 0}), Defect::kForm);         // no unit
  EXPECT_EQ(defect_of({0x82, 0xC2, 0, 0x20, 1}), Defect::kShort);  // data beyond the datagram
  Bytes long_answer;
  for (int n = 0; n < 3; ++n) append_read(long_answer, Space::kHostmot2, 4, 0, 127);
  EXPECT_EQ(defect_of(long_answer), Defect::kAnswerTooLong);
}

// A datagram is refused as a whole: a valid write before the bad command has no effect either.
TEST(Lbp16, ARefusedDatagramChangesNothingAndGetsNoAnswer) {
  const auto bad_ends = [] {
    std::vector<std::pair<Defect, Bytes>> ends(7);
    ends[0] = {Defect::kShort, {0x81}};
    ends[1] = {Defect::kForm, {0x81, 0x02, 0, 0}};
    ends[2].first = Defect::kSpace;
    append_read(ends[2].second, static_cast<Space>(3), 4, 0, 1);
    ends[3].first = Defect::kUnit;
    append_read(ends[3].second, Space::kHostmot2, 2, 0x100, 1);
    ends[4].first = Defect::kAlignment;
    append_read(ends[4].second, Space::kHostmot2, 4, 0x2102, 1);
    ends[5].first = Defect::kReadOnly;
    append_write(ends[5].second, Space::kEeprom, 2, 2, {1, 2});
    ends[6].first = Defect::kSpace;  // exceeds the space
    append_read(ends[6].second, Space::kHostmot2, 4, 0xFFFC, 2);
    return ends;
  }();
  Bench bench;
  std::uint64_t refused = 0;
  for (const auto& [defect, end] : bad_ends) {
    Bytes datagram;
    append_write(datagram, map_at::kStepRate, {static_cast<std::uint32_t>(rate_of(50'000))});
    datagram.insert(datagram.end(), end.begin(), end.end());
    const std::uint64_t before = bench.board.counts().refused[static_cast<std::size_t>(defect)];
    EXPECT_TRUE(bench.send(datagram).empty()) << name_of(defect);
    EXPECT_EQ(bench.board.counts().refused[static_cast<std::size_t>(defect)], before + 1) << name_of(defect);
    EXPECT_EQ(bench.board.counts().all_refused(), ++refused);
    bench.run(0.002);
    EXPECT_EQ(bench.pins(0), 0) << name_of(defect);
  }
}

}  // namespace
}  // namespace trammel::hm2
