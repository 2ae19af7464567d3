// Tests of the statements about accesses, refusals, START and recovery in docs/reference/behaviour.md, on the golden
// model of the whole card, through its bus only.
#include "reference_page.hpp"

namespace trammel::reference_page {
namespace {

constexpr std::uint32_t refusal_of(Reason reason, std::uint32_t number, std::uint32_t address) {
  return static_cast<std::uint32_t>(reason) | number << 8 | address << 16;
}

// Ticks that do not match at a barrier: 10 ticks of line and 11 of feed.
void make_fault(Host& host) {
  host.write(reg::kControl, field::kControlAbort);
  host.number = 0;
  host.send(line(10, 0));
  host.send(feed(11));
  host.send(driver::EndCommand{});
  host.clocks(200);
  ASSERT_EQ(host.read(reg::kFault), field::kFaultTickMismatch);
}

TEST(ReferencePage, AddressesBetweenWordsAreUnknown) {
  Host host;
  for (std::uint32_t offset = 1; offset < 4; ++offset) {
    EXPECT_EQ(host.read(reg::kMagic + offset), 0U);
    EXPECT_EQ(host.refusal(), refusal_of(Reason::UnknownAddress, 0, reg::kMagic + offset));
    EXPECT_FALSE(host.write(reg::kHold + offset, 1));
    EXPECT_EQ(host.refusal(), refusal_of(Reason::UnknownAddress, 0, reg::kHold + offset));
  }
}

// An access waits longest just after reset; a card with captures fills the most words.
TEST(ReferencePage, TheFirstAccessIsAnsweredWithinAnswerClocks) {
  for (const unsigned axes : {1U, 4U, 5U, 8U}) {
    Host host(axes, model::RegisterFile::kMaxEngines);
    EXPECT_TRUE(host.write(reg::step_length(axes - 1), 5));
    const std::uint64_t bound = axes > 4 ? card_map::constant::kAnswerClocks8Axes : card_map::constant::kAnswerClocks;
    EXPECT_LE(host.card.cycles(), bound) << axes << " axes";
    EXPECT_GT(host.card.cycles(), bound - 100) << axes << " axes: the bound says little";
  }
}

TEST(ReferencePage, RefusalsOfTheStream) {
  Host host;
  EXPECT_TRUE(host.send(driver::DwellCommand{1}));
  // The third word of command 1 is wrong: bits 47:40 of the count.
  EXPECT_TRUE(host.write(reg::kStream, 0x01030020));
  EXPECT_TRUE(host.write(reg::kStream, 0x00000000));
  EXPECT_FALSE(host.write(reg::kStream, 0x00000100));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::BadField, 1, reg::kStream));
  EXPECT_FALSE(host.write(reg::kStream, 0x05030020));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::StreamClosed, 1, reg::kStream)) << "the number stays";
  host.write(reg::kControl, field::kControlAbort);
  EXPECT_TRUE(host.write(reg::kStream, 0x00030020));
  EXPECT_TRUE(host.write(reg::kControl, field::kControlFlush)) << "the write itself is not refused";
  EXPECT_EQ(host.refusal(), refusal_of(Reason::Truncated, 0, reg::kControl));
  EXPECT_FALSE(host.write(reg::kStream, 0x00030020));
  EXPECT_EQ(host.reason(), Reason::StreamClosed) << "a flush inside a command closes the stream";
  host.write(reg::kControl, field::kControlAbort);
  EXPECT_TRUE(host.write(reg::kControl, field::kControlFlush));
  EXPECT_EQ(host.refusal(), 0U) << "nothing to flush";
  EXPECT_TRUE(host.write(reg::kStream, 0x00030020));
  EXPECT_TRUE(host.write(reg::kControl, field::kControlFlush | field::kControlAbort));
  EXPECT_EQ(host.refusal(), 0U) << "the abort wins";
  // Padding must be 0: a line of one axis has 8 halfwords, a DWELL 5 and one of padding.
  EXPECT_TRUE(host.write(reg::kStream, 0x00030020));
  EXPECT_TRUE(host.write(reg::kStream, 0));
  EXPECT_FALSE(host.write(reg::kStream, 0x00010000));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::BadField, 0, reg::kStream));
}

TEST(ReferencePage, StartsChecksInOrder) {
  Host host;
  host.direct(1, 1, 0);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.refusal(), refusal_of(Reason::BadValue, 0, reg::kStart)) << "LENGTH 0";
  host.direct(kOnePulse + 1, 1, 100);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::BadValue) << "more than a pulse a clock";
  host.direct(0, 1, 100);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::BadValue) << "no frequency for a pulse";
  host.direct(0, 0, 5000);
  EXPECT_TRUE(host.write(reg::kStart, 1)) << "an axis may stand";
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::Busy);
  EXPECT_FALSE(host.write(reg::kStart, 0x10));
  EXPECT_EQ(host.reason(), Reason::BadValue) << "an absent axis, busy or not";
  EXPECT_FALSE(host.write(reg::kStream, 0));
  EXPECT_EQ(host.reason(), Reason::Busy);
  host.write(reg::kControl, field::kControlAbort);
  make_fault(host);
  EXPECT_FALSE(host.write(reg::kStart, 1));
  EXPECT_EQ(host.reason(), Reason::Faulted);
  EXPECT_FALSE(host.write(reg::kStart, 0));
  EXPECT_EQ(host.reason(), Reason::BadValue);
}

TEST(ReferencePage, SettingsStayWritableInDirectMode) {
  Host host;
  host.direct(0, 0, 50000);
  EXPECT_TRUE(host.write(reg::kStart, 1));
  for (const card_map::Register& entry : card_map::kRegisters) {
    const bool there = card_map::has_engine(model::RegisterFile::kDefaultEngines, entry.engine);
    if (entry.access != card_map::Access::Setting || !there) continue;
    EXPECT_TRUE(host.write(entry.address, host.read(entry.address))) << entry.name;
  }
  EXPECT_NE(host.read(reg::kStatus) & field::kStatusDirect, 0U);
  // The values of the next move may be written, because the running move has its own copy.
  host.direct(kOnePulse / 100, 3, 1000);
  host.idle();
  EXPECT_EQ(host.position(0), 0);
  EXPECT_TRUE(host.write(reg::kStart, 1));
  host.idle();
  EXPECT_EQ(host.position(0), 3);
}

TEST(ReferencePage, RecoveryInWhicheverOrder) {
  for (int order = 0; order < 3; ++order) {
    Host host;
    make_fault(host);
    EXPECT_EQ(host.read(reg::kStatus) & (field::kStatusBusy | field::kStatusFaulted), field::kStatusFaulted);
    EXPECT_EQ(host.read(reg::kGeometryRoom), 4096U);
    EXPECT_EQ(host.read(reg::kGeometryBegun), 0U);
    EXPECT_EQ(host.read(reg::fault(Area::Stop)), field::kFaultTickMismatch);
    EXPECT_EQ(host.read(reg::geometry_begun(Area::Stop)), 1U) << "what had begun when it stopped";
    EXPECT_FALSE(host.write(reg::kStream, 0x00030020));
    EXPECT_EQ(host.refusal(), refusal_of(Reason::Faulted, 0, reg::kStream));
    if (order == 0) host.write(reg::kControl, field::kControlAbort);
    host.write(reg::kFault, 0xFFFF);
    if (order == 1) host.write(reg::kControl, field::kControlAbort);
    const std::size_t steps = host.pins.size();
    host.clocks(5000);
    EXPECT_EQ(host.pins.size(), steps) << "clearing starts nothing";
    EXPECT_EQ(host.read(reg::kStatus), 0U);
    host.number = 0;
    EXPECT_TRUE(host.send(line(10, kOnePulse / 10)));
    EXPECT_TRUE(host.send(feed(10)));
    EXPECT_TRUE(host.send(driver::EndCommand{}));
    host.idle();
    EXPECT_EQ(host.read(reg::kStatus), field::kStatusEnded);
    EXPECT_EQ(host.position(0), 1);
  }
}

TEST(ReferencePage, AnswerTimeOfStart) {
  for (unsigned mask = 1; mask < 16; ++mask) {
    Host host;
    host.direct(0, 0, 1);
    host.clocks(300);
    // Compared with a write that takes 4 clocks at the inner port.
    const std::uint64_t begin = host.card.cycles();
    EXPECT_TRUE(host.write(reg::kStart, mask));
    const std::uint64_t start = host.card.cycles() - begin;
    host.idle();
    const std::uint64_t again = host.card.cycles();
    EXPECT_TRUE(host.write(reg::kHold, 0));
    const std::uint64_t plain = host.card.cycles() - again;
    EXPECT_EQ(start - plain, 38U + 16 * card_map::axes_in(static_cast<std::uint8_t>(mask)) - 4) << mask;
  }
}

}  // namespace
}  // namespace trammel::reference_page
