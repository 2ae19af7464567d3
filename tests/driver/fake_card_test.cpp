#include "trammel/driver/fake_card.hpp"

#include <gtest/gtest.h>

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;

// The reason that the fake has latched for the last access, and none if it was taken.
template <typename Access>
map::Reason reason_of(FakeCard& fake, Access access) {
  fake.write(reg::kRefusal, 1);
  EXPECT_EQ(fake.read(reg::kRefusal), 0U);
  try {
    access();
  } catch (const BusError&) {
    return static_cast<map::Reason>(fake.read(reg::kRefusal) & map::field::kRefusalReason);
  }
  return map::Reason::None;
}

TEST(FakeCard, EveryRegisterKeepsItsKindOfAccess) {
  FakeCard fake;
  for (const map::Register& entry : map::kRegisters) {
    SCOPED_TRACE(entry.name);
    const std::uint32_t address = entry.address;
    if (!map::has_engine(FakeCardOptions{}.engines, entry.engine)) {
      EXPECT_EQ(reason_of(fake, [&] { fake.read(address); }), map::Reason::UnknownAddress);
      continue;
    }
    const map::Reason read = reason_of(fake, [&] { fake.read(address); });
    EXPECT_EQ(read, entry.access == map::Access::Command ? map::Reason::WriteOnly : map::Reason::None);
    const bool read_only = entry.access == map::Access::Constant || entry.access == map::Access::Live ||
                           entry.access == map::Access::Snapshot;
    if (read_only) {
      EXPECT_EQ(reason_of(fake, [&] { fake.write(address, 0); }), map::Reason::ReadOnly);
    } else if (~entry.mask != 0) {
      EXPECT_EQ(reason_of(fake, [&] { fake.write(address, ~entry.mask); }), map::Reason::BadValue);
    }
    if (entry.access == map::Access::Setting) {
      const std::uint32_t value = entry.limited != 0 ? entry.maximum : entry.mask;
      EXPECT_EQ(fake.read(address), entry.reset);
      fake.write(address, value);
      EXPECT_EQ(fake.read(address), value);
    }
  }
}

// START's checks in their order, each with everything that comes after it wrong too.
TEST(FakeCard, StartChecksMaskThenFaultThenBusyThenValues) {
  FakeCard fake;  // 4 axes; LENGTH is 0
  const auto start = [&](std::uint32_t mask) { return reason_of(fake, [&] { fake.write(reg::kStart, mask); }); };
  EXPECT_EQ(start(1), map::Reason::BadValue) << "LENGTH 0";
  fake.write(reg::kLengthLo, 1000);
  EXPECT_EQ(start(1), map::Reason::None);
  EXPECT_EQ(start(1), map::Reason::Busy);
  fake.raise_fault(1);
  EXPECT_EQ(start(1), map::Reason::Faulted);
  EXPECT_EQ(start(0x10), map::Reason::BadValue);
  EXPECT_EQ(start(0), map::Reason::BadValue);
}

TEST(FakeCard, AFaultDropsEverythingAndTakesNothingUntilItIsCleared) {
  FakeCard fake;
  std::vector<std::uint32_t> words;
  LineCommand line;
  line.ticks = 100;
  line.mask = 1;
  encode(line, 0, words);
  fake.write_block(reg::kStream, words.data(), words.size(), Addressing::kFixed);
  fake.raise_fault(2);
  EXPECT_EQ(fake.read(reg::kStatus) & map::field::kStatusBusy, 0U);
  EXPECT_EQ(fake.read(reg::kGeometryBegun), 0U);
  EXPECT_EQ(fake.read(reg::kGeometryRoom), 4096U);
  EXPECT_EQ(reason_of(fake, [&] { fake.write(reg::kStream, words[0]); }), map::Reason::Faulted);
  fake.write(reg::kFault, 2);
  // No abort: the stream is open and begins with number 0.
  fake.write_block(reg::kStream, words.data(), words.size(), Addressing::kFixed);
  EXPECT_EQ(fake.accepted().size(), 2U);
}

TEST(FakeCard, AbsentAxesAndHolesAreUnknownAddresses) {
  FakeCard fake;  // 4 axes
  EXPECT_EQ(reason_of(fake, [&] { fake.read(reg::step_length(4)); }), map::Reason::UnknownAddress);
  EXPECT_EQ(reason_of(fake, [&] { fake.read(map::kWindowBytes - 4); }), map::Reason::UnknownAddress);
}

}  // namespace
}  // namespace trammel::driver
