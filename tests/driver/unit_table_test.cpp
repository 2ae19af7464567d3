// Readable names of a card's units: their own names, and the engines that their features show.
#include "trammel/driver/unit_table.hpp"

#include <gtest/gtest.h>

#include "trammel/card_map.hpp"

namespace trammel::driver {
namespace {

card_map::Descriptor unit_with(std::uint8_t tag, std::uint8_t features) {
  card_map::Descriptor unit;
  unit.tag = tag;
  unit.features = features;
  return unit;
}

TEST(UnitNames, AreThoseOfTheMap) {
  EXPECT_EQ(unit_name(unit_with(card_map::unit::kTimeBase, 0)), "time_base");
  EXPECT_EQ(unit_name(unit_with(card_map::unit::kCaptures, 0xFF)), "captures");
  EXPECT_EQ(unit_name(unit_with(200, 0)), "tag 200");
}

TEST(UnitFeatures, AreNamedByTheirEngines) {
  EXPECT_EQ(feature_names(unit_with(card_map::unit::kTimeBase, 0)), "");
  EXPECT_EQ(feature_names(unit_with(card_map::unit::kTimeBase, 1)), "classes");
  EXPECT_EQ(feature_names(unit_with(card_map::unit::kFeedGenerator, 0b1001)), "jerk, feature 3");
  EXPECT_EQ(feature_names(unit_with(card_map::unit::kQueues, 0b10000001)), "watermarks, feature 7");
  EXPECT_EQ(feature_names(unit_with(200, 0b101)), "feature 0, feature 2") << "of a unit that this driver does not know";
}

TEST(UnitFeatures, AddToTheEngines) {
  namespace engines = card_map::engines;
  EXPECT_EQ(engines_of(unit_with(card_map::unit::kTimeBase, 0)), engines::kLines);
  EXPECT_EQ(engines_of(unit_with(card_map::unit::kTimeBase, 0b11)), engines::kLines | engines::kClasses);
  EXPECT_EQ(engines_of(unit_with(200, 0xFF)), 0U);
}

}  // namespace
}  // namespace trammel::driver
