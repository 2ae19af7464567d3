// Captures through the driver: what it writes, what it reads of an edge behind a filter, and what it refuses before.
#include <gmock/gmock.h>

#include "argument_error.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace reg = card_map::reg;

class CardCaptures : public ::testing::Test {
 protected:
  // 640 clocks and what a scan and the snapshot take.
  void SetUp() override {
    card_.set_input_filter(3, 640us);
    engine_->wait(3000);
  }
  void stand(std::uint32_t levels, std::uint64_t clocks) {
    engine_->set_inputs(levels);
    engine_->wait(clocks);
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine({});
  Card card_ = Card::open(*engine_);
};

TEST_F(CardCaptures, ACaptureHasTheTimeOfTheEdge) {
  EXPECT_EQ(card_.captures_present(), 4U);
  card_.select_capture(2, {3, true, false, false});
  EXPECT_EQ(engine_->read(reg::capture_select(2)), 0x103U);
  EXPECT_FALSE(card_.take_capture(2).has_value());
  const std::uint64_t before = card_.read_snapshot().time;
  const std::uint64_t asked = engine_->cycles();
  stand(8, 20);
  stand(0, 30);
  stand(8, 100);
  EXPECT_TRUE(card_.read_captures().units[2].pending);
  EXPECT_FALSE(card_.take_capture(2).has_value());
  engine_->wait(700);
  const std::optional<Capture> capture = card_.take_capture(2);
  ASSERT_TRUE(capture.has_value());
  EXPECT_TRUE(capture->active);
  EXPECT_FALSE(capture->overrun);
  EXPECT_GT(capture->at.time, before);
  EXPECT_LE(capture->at.time, asked + 3);
  EXPECT_FALSE(card_.take_capture(2).has_value());
  EXPECT_EQ(card_.read_captures().snapshots, 1U);
}

TEST_F(CardCaptures, AGlitchGivesNoneAndWaitingEnds) {
  card_.select_capture(0, {3, true, true, true});
  stand(8, 500);
  stand(0, 1000);
  EXPECT_EQ(card_.read_captures().snapshots, 1U);
  EXPECT_FALSE(card_.read_captures().units[0].pending);
  EXPECT_THROW(card_.wait_for_capture(0, 10ms), TimeoutError);
  // Both ways; the second edge comes while the first capture stands.
  stand(8, 2000);
  EXPECT_TRUE(card_.read_captures().units[0].valid);
  stand(0, 2000);
  EXPECT_TRUE(card_.read_captures().units[0].overrun);
  const Capture first = card_.wait_for_capture(0, 10ms);
  EXPECT_TRUE(first.active);
  EXPECT_TRUE(first.overrun);
  stand(8, 2000);
  stand(8, 0);
  const Capture second = card_.wait_for_capture(0, 10ms);
  EXPECT_TRUE(second.active);
  EXPECT_FALSE(second.overrun);
  EXPECT_GT(second.at.time, first.at.time + 3900);
  card_.stop_capture(0);
  stand(0, 2000);
  EXPECT_FALSE(card_.read_captures().units[0].valid);
}

TEST_F(CardCaptures, BadArgumentsAreNamed) {
  EXPECT_THAT(argument_error([&] { card_.select_capture(4, {}); }), HasSubstr("capture unit 4: the card has 4"));
  EXPECT_THAT(argument_error([&] { card_.select_capture(1, {16}); }), HasSubstr("input 16: the card has 16 inputs"));
  EXPECT_THAT(argument_error([&] { card_.take_capture(9); }), HasSubstr("capture unit 9"));
}

}  // namespace
}  // namespace trammel::driver
