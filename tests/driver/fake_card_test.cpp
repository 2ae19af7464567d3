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

TEST(FakeCard, AbsentAxesAndHolesAreUnknownAddresses) {
  FakeCard fake;  // 4 axes
  EXPECT_EQ(reason_of(fake, [&] { fake.read(reg::step_length(4)); }), map::Reason::UnknownAddress);
  EXPECT_EQ(reason_of(fake, [&] { fake.read(map::kWindowBytes - 4); }), map::Reason::UnknownAddress);
}

}  // namespace
}  // namespace trammel::driver
