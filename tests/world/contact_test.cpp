// Contacts: their level at rest, and their bounces, which follow the seed, stay within their time and end at the right
// level.
#include "trammel/world/contact.hpp"

#include <gmock/gmock.h>

#include <stdexcept>
#include <vector>

namespace trammel::world {
namespace {

constexpr std::uint32_t kClock = 1'000'000;

std::vector<std::uint64_t> changes_of(Contact& contact) {
  std::vector<std::uint64_t> changes;
  while (contact.next_change() != Contact::kNever) {
    const std::uint64_t clock = contact.next_change();
    const bool before = contact.closed();
    contact.run_to(clock - 1);
    EXPECT_EQ(contact.closed(), before);
    changes.push_back(clock);
    contact.run_to(clock);
  }
  return changes;
}

TEST(WorldContact, NormallyOpenAndNormallyClosedAtRest) {
  Contact open({false, 0, 0}, kClock, 1);
  EXPECT_FALSE(open.closed());
  open.set(true, 5);
  EXPECT_TRUE(open.closed());
  EXPECT_EQ(open.next_change(), Contact::kNever);
  Contact closed({true, 0, 3}, kClock, 1);
  EXPECT_TRUE(closed.closed());
  closed.set(true, 5);
  EXPECT_FALSE(closed.closed());
  EXPECT_EQ(closed.next_change(), Contact::kNever);
  closed.set(false, 6);
  EXPECT_TRUE(closed.closed());
}

TEST(WorldContact, BouncesWithinItsTimeToTheRightEnd) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Contact contact({false, 1e-3, 3}, kClock, seed);
    contact.set(true, 5000);
    EXPECT_TRUE(contact.closed());
    const auto changes = changes_of(contact);
    // Two changes in one clock cancel each other.
    EXPECT_LE(changes.size(), 6U);
    EXPECT_GE(changes.size(), 4U);
    EXPECT_GT(changes.front(), 5000U);
    EXPECT_LE(changes.back(), 6000U);
    EXPECT_TRUE(contact.closed());
  }
}

TEST(WorldContact, TheSeedDecides) {
  const auto changes = [](std::uint64_t seed) {
    Contact contact({false, 1e-3, 4}, kClock, seed);
    contact.set(true, 0);
    return changes_of(contact);
  };
  EXPECT_EQ(changes(7), changes(7));
  EXPECT_NE(changes(7), changes(8));
}

TEST(WorldContact, ReleasedWhileItBouncesItStillEndsReleased) {
  Contact contact({false, 1e-3, 4}, kClock, 3);
  contact.set(true, 0);
  contact.set(true, 10);  // already pressed
  contact.run_to(contact.next_change());
  contact.set(false, contact.next_change());
  EXPECT_FALSE(contact.closed());
  EXPECT_EQ(changes_of(contact).size(), 8U);
  EXPECT_FALSE(contact.closed());
  EXPECT_FALSE(contact.pressed());
}

TEST(WorldContact, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(Contact({false, -1, 0}, kClock, 1), std::invalid_argument);
  EXPECT_THROW(Contact({false, 1.5, 0}, kClock, 1), std::invalid_argument);
  EXPECT_THROW(Contact({false, 0, 9}, kClock, 1), std::invalid_argument);
}

}  // namespace
}  // namespace trammel::world
