// Captures through the driver: its writes, its results for an edge at an input with a filter, and its refusals before
// any write.
#include <gmock/gmock.h>

#include "error_message.hpp"
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
  // Sets a filter of 640 clocks; later waits also cover a scan and the snapshot.
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
  // Both directions; the second edge comes before the first capture is taken.
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

// Edges of two units, in the order in which the filters pass them, each with the time of the edge itself.
TEST_F(CardCaptures, AQueueKeepsEachEdge) {
  ASSERT_TRUE(card_.has_capture_queue());
  card_.select_capture(1, {3, true, true, true, true});
  card_.select_capture(2, {5, true, true, true, true});  // input 5 has no filter
  EXPECT_EQ(engine_->read(reg::capture_select(1)), 0xF03U);
  EXPECT_TRUE(card_.take_queued_captures().empty());
  const std::uint64_t from = engine_->cycles();
  stand(0x08, 100);  // the filter passes this edge after the next one
  stand(0x28, 2000);
  stand(0x20, 2000);
  stand(0x00, 2000);
  EXPECT_EQ(card_.read_capture_queue().captures, 4U);
  EXPECT_FALSE(card_.read_captures().units[1].valid);
  const std::vector<QueuedCapture> captures = card_.take_queued_captures();
  ASSERT_EQ(captures.size(), 4U);
  constexpr struct {
    unsigned unit;
    bool active;
    std::uint64_t time;
  } kExpected[] = {{2, true, 100}, {1, true, 0}, {1, false, 2100}, {2, false, 4100}};
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_EQ(captures[n].unit, kExpected[n].unit) << n;
    EXPECT_EQ(captures[n].active, kExpected[n].active) << n;
    EXPECT_GE(captures[n].at.time + 3, from + kExpected[n].time) << n;
    EXPECT_LE(captures[n].at.time, from + kExpected[n].time + 3) << n;
  }
  EXPECT_EQ(card_.read_capture_queue().captures, 0U);
  EXPECT_EQ(card_.read_capture_queue().lost, 0U);
  EXPECT_FALSE(card_.read_captures().units[1].overrun);
}

TEST_F(CardCaptures, AFullQueueKeepsTheOldestAndCounts) {
  card_.select_capture(0, {5, true, true, true, true});
  for (unsigned n = 1; n <= 20; ++n) stand(n % 2 * 0x20, 100);
  EXPECT_EQ(card_.read_capture_queue().captures, 16U);
  EXPECT_EQ(card_.read_capture_queue().lost, 4U);
  EXPECT_TRUE(card_.read_captures().units[0].overrun);
  card_.clear_captures(1);
  EXPECT_FALSE(card_.read_captures().units[0].overrun);
  const std::vector<QueuedCapture> captures = card_.take_queued_captures();
  ASSERT_EQ(captures.size(), 16U);
  EXPECT_TRUE(captures[0].active);
  for (std::size_t n = 1; n < 16; ++n) EXPECT_EQ(captures[n].at.time - captures[n - 1].at.time, 100U) << n;
  // The queue wraps around.
  for (unsigned n = 1; n <= 15; ++n) stand(n % 2 * 0x20, 100);
  EXPECT_EQ(card_.take_queued_captures().size(), 15U);
  EXPECT_EQ(card_.read_capture_queue().lost, 4U);
}

// The input has no filter, so an edge can come while the snapshot of the edge before is still written.
TEST_F(CardCaptures, AnEdgeThatComesTooFastIsTold) {
  card_.select_capture(0, {5, true, true, true, true});
  stand(0x20, 5);
  stand(0, 100);
  EXPECT_EQ(card_.take_queued_captures().size(), 1U);
  EXPECT_TRUE(card_.read_captures().units[0].overrun);
  EXPECT_EQ(card_.read_capture_queue().lost, 0U);
}

TEST(CardCapturesAlone, ACardWithoutAQueueSaysSo) {
  sim::ModelOptions options;
  options.engines = card_map::engines::kLines | card_map::engines::kJerk | card_map::engines::kPathCommands |
                    card_map::engines::kMachineInputs | card_map::engines::kCaptures;
  const std::unique_ptr<sim::Engine> engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  EXPECT_FALSE(card.has_capture_queue());
  EXPECT_THAT(argument_error([&] { card.select_capture(0, {1, true, true, true, true}); }), HasSubstr("no queue"));
  EXPECT_THAT(argument_error([&] { card.take_queued_captures(); }), HasSubstr("no queue of captures"));
}

TEST_F(CardCaptures, OfTheOtherEdgeAlone) {
  card_.select_capture(0, {3, false, true, false});
  EXPECT_EQ(engine_->read(reg::capture_select(0)), 0x203U);
  stand(8, 2000);
  EXPECT_FALSE(card_.take_capture(0).has_value());
  stand(0, 2000);
  const std::optional<Capture> capture = card_.take_capture(0);
  ASSERT_TRUE(capture.has_value());
  EXPECT_FALSE(capture->active);
}

TEST_F(CardCaptures, BadArgumentsAreNamed) {
  EXPECT_THAT(argument_error([&] { card_.select_capture(4, {}); }), HasSubstr("capture unit 4: the card has 4"));
  EXPECT_THAT(argument_error([&] { card_.select_capture(1, {16}); }), HasSubstr("input 16: the card has 16 inputs"));
  EXPECT_THAT(argument_error([&] { card_.take_capture(9); }), HasSubstr("capture unit 9"));
  EXPECT_THAT(argument_error([&] { card_.clear_captures(16); }), HasSubstr("units of captures is outside 0 .. 15"));
}

}  // namespace
}  // namespace trammel::driver
