// Calls that wait: they report an earlier hold at once, and a check of the caller can end them.
#include "trammel/driver/interrupt.hpp"

#include <gmock/gmock.h>

#include <thread>

#include "stream_commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/frames/endpoint.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
using ::testing::HasSubstr;
namespace hold_reg = card_map::reg;

constexpr auto kLong = 20s;  // enough on a busy host; an endless wait takes longer

template <class Call>
std::string held(Call call) {
  try {
    call();
  } catch (const HeldError& error) {
    return error.what();
  }
  return "no HeldError";
}

class HeldCard : public ::testing::Test {
 protected:
  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine({});
  Card card_ = Card::open(*engine_);
  OneShotPlan line_ = plan_line(card_.timing(), {100}, 10ms);
};

TEST_F(HeldCard, IsFoundAtOnceByWhatWouldWaitForMotion) {
  engine_->write(hold_reg::kHold, 1);
  engine_->wait(100);
  EXPECT_EQ(held([&] { run_line(card_, line_); }), "line: the card holds: take it over, or end the hold");
  EXPECT_FALSE(card_.busy()) << "nothing was started";
  EXPECT_THAT(held([&] { Stream{card_}; }), HasSubstr("stream: the card holds"));
  EXPECT_THAT(held([&] { PositionStream{card_}; }), HasSubstr("position stream: the card holds"));
  start_line(card_, line_.part(0));
  EXPECT_THAT(held([&] { card_.wait_until_idle(1s); }), HasSubstr("waiting for the end of motion: the card holds"));
  EXPECT_EQ(engine_->positions()[0], 0);
}

TEST_F(HeldCard, OfItsOwnProgram) {
  card_.set_hold(true);
  EXPECT_THAT(held([&] { run_line(card_, line_); }), HasSubstr("the card holds: set by this program"));
  // A stream may be opened in the hold, and another thread ends the hold.
  Stream stream(card_);
  stream.send({feed_of(1000), line_of(1000, 10), EndCommand{}});
  std::thread other([&] {
    std::this_thread::sleep_for(20ms);
    card_.request_hold(false);
  });
  EXPECT_TRUE(stream.finish().ended);
  other.join();
  card_.set_ratio(0);
  EXPECT_THAT(held([&] { run_line(card_, line_); }), HasSubstr("ratio is 0"));
  card_.set_ratio(Card::kFullRatio);
  run_line(card_, line_);
  EXPECT_EQ(engine_->positions()[0], 110);
}

TEST_F(HeldCard, IsTakenOver) {
  engine_->write(hold_reg::kHold, 1);
  EXPECT_FALSE(card_.take_over()) << "nothing was left";
  EXPECT_EQ(engine_->read(hold_reg::kHold), 0U);
  start_line(card_, {1000}, 1s);
  EXPECT_THROW(card_.take_over(), StateError) << "somebody else moves it";
  EXPECT_TRUE(card_.busy());
  engine_->write(hold_reg::kHold, 1);
  ASSERT_TRUE(card_.take_over());
  run_line(card_, line_);
}

TEST_F(HeldCard, AFaultedOneSaysSo) {
  Stream stream(card_);
  stream.send({feed_of(100), line_of(99, 1), EndCommand{}});
  EXPECT_THROW(stream.finish(), FaultError);
  EXPECT_THROW(run_line(card_, line_), FaultError);
  EXPECT_THROW(Stream{card_}, FaultError);
}

// The check runs while the call waits. The card then stops on the path and is empty.
template <class Call>
void expect_stop(sim::Engine& engine, Card& card, Call call) {
  const auto begun = steady_clock::now();
  {
    int asked = 0;
    const InterruptScope scope([&] { return ++asked == 3; });
    EXPECT_THROW(call(), StoppedError);
    EXPECT_EQ(asked, 3) << "it has said so, and is not asked again";
    EXPECT_THROW(call(), StateError) << "nor does a later call wait";
  }
  const auto took = steady_clock::now() - begun;
  EXPECT_GE(took, 3 * kInterruptSlice);
  EXPECT_LT(took, kLong);
  EXPECT_FALSE(card.busy());
  EXPECT_EQ(card.parts().registers.read(hold_reg::kHold), 0U);
  const auto positions = engine.positions();
  engine.wait(1'000'000);
  EXPECT_EQ(engine.positions(), positions);
}

TEST_F(HeldCard, InterruptsStopLinesStreamsAndWaits) {
  const OneShotPlan hours = plan_line(card_.timing(), {1'000'000}, std::chrono::hours(200));
  expect_stop(*engine_, card_, [&] { run_line(card_, hours); });
  Stream stream(card_);
  stream.send({feed_of(1'000'000'000'000), line_of(1'000'000'000'000, 10), EndCommand{}});
  expect_stop(*engine_, card_, [&] { stream.finish(); });
  start_line(card_, hours.part(0));
  expect_stop(*engine_, card_, [&] {
    card_.wait_until_idle(std::chrono::hours(300));
    throw StateError("idle");
  });
  run_line(card_, line_);
}

// A hold suspends time-outs, but not a deadline.
TEST_F(HeldCard, ADeadlineEndsAWaitInAHold) {
  card_.request_hold(true);
  const auto begun = steady_clock::now();
  const InterruptScope deadline(InterruptScope::after(100ms));
  EXPECT_THROW(run_line(card_, plan_line(card_.timing(), {100}, 100s)), StoppedError);
  EXPECT_LT(steady_clock::now() - begun, kLong);
}

TEST(InterruptScopes, Nest) {
  EXPECT_FALSE(interrupted());
  bool outer_asked = false;
  const InterruptScope outer([&] { return outer_asked = true; });
  {
    const InterruptScope inner([] { return false; });
    EXPECT_FALSE(interrupted()) << "not so soon";
    std::this_thread::sleep_for(kInterruptSlice);
    EXPECT_TRUE(interrupted());
    bool of_another_thread = true;
    std::thread([&] { of_another_thread = interrupted(); }).join();
    EXPECT_FALSE(of_another_thread);
    const StopForInterrupt stopping;
    EXPECT_FALSE(interrupted());
    EXPECT_FALSE(interrupted_after(999ms));
    EXPECT_TRUE(interrupted_after(1s));
  }
  EXPECT_TRUE(outer_asked);
  EXPECT_TRUE(interrupted()) << "it stays so";
}

// A link that carries frames to a card; the card falls silent when `silent` is set.
class SilentLink final : public ByteLink {
 public:
  explicit SilentLink(sim::Engine& engine)
      : engine_(engine), endpoint_([&engine](bool write, std::uint32_t address, std::uint32_t data) {
          Access access{address, data, write};
          const bool made = engine.transfer(&access, 1) == 1;
          return frames::Endpoint::Answer{!made, access.data};
        }) {}
  void send(const std::uint8_t* bytes, std::size_t count) override {
    for (std::size_t i = 0; i < count && !silent; ++i) endpoint_.take(bytes[i], reply_);
  }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    const std::size_t count = std::min(room, reply_.size());
    if (count == 0) std::this_thread::sleep_for(longest);
    std::copy_n(reply_.begin(), count, bytes);
    reply_.erase(reply_.begin(), reply_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  void restart() override { endpoint_.connect(); }
  std::chrono::nanoseconds time_of(std::size_t) const override { return {}; }
  std::chrono::nanoseconds now() const override { return steady_clock::now().time_since_epoch(); }
  void sleep(std::chrono::nanoseconds time) override { engine_.sleep(time); }

  bool silent = false;

 private:
  sim::Engine& engine_;
  frames::Endpoint endpoint_;
  frames::Bytes reply_;
};

// The time-out of the link is an hour; the time-out of a stop is a second.
TEST(InterruptScopes, EndTheWaitForASilentLink) {
  const auto engine = sim::make_model_engine({});
  SilentLink link(*engine);
  FrameBus::Options options;
  options.answer = std::chrono::hours(1);
  FrameBus bus(link, options);
  Card card = Card::open(bus);
  link.silent = true;
  const auto begun = steady_clock::now();
  {
    const InterruptScope scope([] { return true; });
    EXPECT_THROW(card.read_status(), InterruptedError);
  }
  EXPECT_LT(steady_clock::now() - begun, kLong);
  link.silent = false;
  run_line(card, plan_line(card.timing(), {100}, 10ms));
  EXPECT_EQ(engine->positions()[0], 100) << "and it goes on afterwards";
  const InterruptScope scope([&] { return link.silent = true; });
  EXPECT_THROW(run_line(card, plan_line(card.timing(), {100}, std::chrono::hours(1))), InterruptedError);
  EXPECT_LT(steady_clock::now() - begun, kLong);
}

}  // namespace
}  // namespace trammel::driver
