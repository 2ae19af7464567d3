// Position streams near soft limits, and on faulty cards and buses: refusals, errors that close the stream, and
// recover().
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "error_message.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using Targets = PositionStream::Positions;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kMillisecond = 1000;  // clocks
constexpr std::int64_t kWhole = PositionStream::kPulse;

// A bus that can change the data of reads, and whose sleeps also take time on the host.
class ForgingBus final : public Bus {
 public:
  explicit ForgingBus(Bus& bus) : bus_(bus) {}
  std::size_t transfer(Access* accesses, std::size_t count) override {
    const std::size_t made = bus_.transfer(accesses, count);
    for (std::size_t i = 0; i < made && on_read; ++i) {
      if (!accesses[i].write) on_read(accesses[i]);
    }
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override {
    bus_.sleep(time);
    std::this_thread::sleep_for(takes);
  }
  bool reports_refusals() const override { return bus_.reports_refusals(); }

  std::function<void(Access&)> on_read;
  std::chrono::nanoseconds takes{0};

 private:
  Bus& bus_;
};

class StreamedPositions : public ::testing::Test {
 protected:
  StreamedPositions() : bus_(*engine_), card_(Card::open(bus_)) { card_.set_slew_time(10ms); }

  void open(const PositionStreamOptions& options = {}) { stream_.emplace(card_, options); }
  // Sends a period of 1 ms and waits for most of it. Returns the text of a refusal.
  std::string send(const Targets& pulses) {
    Targets targets{};
    for (std::size_t n = 0; n < targets.size(); ++n) targets[n] = pulses[n] * kWhole;
    const std::string refusal = argument_error([&] { stream_->send(targets, kMillisecond); });
    if (refusal.empty()) engine_->wait(600);
    return refusal;
  }
  // Sends periods at 10 pulses/ms in the positive direction. The card then moves.
  void go(int periods = 10) {
    for (int i = 1; i <= periods; ++i) ASSERT_EQ(send({10 * i}), "");
    ASSERT_TRUE(card_.busy());
  }

  std::unique_ptr<sim::Engine> engine_ = sim::make_model_engine({});
  ForgingBus bus_;
  Card card_;
  std::optional<PositionStream> stream_;
};

// At 10 pulses/ms the card needs 10 pulses for the stale period and 50 for the ramp of 10 ms, which covers half of its
// time at full speed.
TEST_F(StreamedPositions, APeriodThatCannotStopBeforeASoftLimitIsRefused) {
  card_.set_soft_limits({SoftRange{-100, 100}});
  open();
  for (const int way : {1, -1}) {
    for (int at = 10; at <= 40; at += 10) EXPECT_EQ(send({way * at, at}), "");
    EXPECT_EQ(send({way * 50, 40}),
              fmt::format("position stream: axis 0: {} pulses in 1000 clocks would end 50 pulses before the soft limit "
                          "at {}, and the card needs 60 to stop from this speed: brake earlier",
                          10 * way, 100 * way));
    EXPECT_EQ(send({way * 45, 40}), "") << "5 pulses/ms need 30";
    EXPECT_EQ(send({way * 45, 90}), "") << "an axis without a limit";
    for (int at = 46; at <= 94; ++at) ASSERT_EQ(send({way * at, 90}), "") << at;
    EXPECT_THAT(send({way * 95, 90}), HasSubstr("would end 5 pulses before")) << "1 pulse/ms needs 6";
    for (int at = 84; at >= 4; at -= 10) EXPECT_EQ(send({way * at, 90}), "") << "inwards all is free";
    EXPECT_EQ(send({0, 45}), "");
    EXPECT_EQ(send({0, 0}), "");
  }
  EXPECT_EQ(stream_->finish()[0], 0);
  EXPECT_EQ(card_.read_faults(), 0U);
}

// Limits are positions of the card; targets are relative to the beginning of the stream.
TEST_F(StreamedPositions, AHostThatFallsSilentEndsBeforeTheSoftLimit) {
  run_line(card_, plan_line(card_.timing(), {20}, 20ms));
  card_.set_soft_limits({SoftRange{-100, 100}});
  open();
  for (int at = 6; at <= 18; at += 6) EXPECT_EQ(send({at}), "");
  EXPECT_EQ(send({43}),
            "position stream: axis 0: 25 pulses in 1000 clocks would end 37 pulses before the soft limit at "
            "80, and the card needs 150 to stop from this speed: brake earlier");
  for (int at = 24; at <= 42; at += 6) EXPECT_EQ(send({at}), "");
  EXPECT_THAT(send({48}), HasSubstr("would end 32 pulses before"));
  engine_->wait(100'000);
  EXPECT_EQ(card_.read_faults(), field::kFaultMissingPeriod);
  EXPECT_GT(engine_->positions()[0], 20 + 42 + 6 + 28) << "a period and the ramp more";
  EXPECT_LE(engine_->positions()[0], 100);
}

TEST_F(StreamedPositions, ACardWithoutSoftLimitsKeepsNone) {
  sim::ModelOptions options;
  options.engines = card_map::engines::kLines | card_map::engines::kJerk | card_map::engines::kStreaming;
  const auto engine = sim::make_model_engine(options);
  Card card = Card::open(*engine);
  PositionStream stream(card);
  stream.send({10 * kWhole}, kMillisecond);
  EXPECT_EQ(stream.finish()[0], 10 * kWhole);
}

TEST_F(StreamedPositions, TargetsAndSpeedsOutOfRange) {
  for (const double speed : {-1.0, 2e12, std::nan("")}) {
    PositionStreamOptions options;
    options.max_speed[2] = speed;
    EXPECT_THAT(argument_error([&] { open(options); }), HasSubstr("position stream: axis 2: a largest speed of"));
  }
  open();
  const auto refusal = [&](std::int64_t target) {
    return argument_error([&] { stream_->send({0, target}, kMillisecond); });
  };
  constexpr std::int64_t kFar = (std::int64_t{1} << 30) * kWhole;
  EXPECT_THAT(refusal(-kFar - 1), HasSubstr("axis 1: a target of -18014398509481985 / 2^24 pulses"));
  EXPECT_THAT(refusal(kFar + 1), HasSubstr("axis 1: a target of 18014398509481985"));
  EXPECT_THAT(refusal(-kFar), HasSubstr("too fast")) << "within the range, but not in a millisecond";
  EXPECT_THAT(refusal(501 * kWhole), HasSubstr("axis 1: 501 pulses in 1000 clocks are too fast")) << "a pulse a tick";
  stream_->finish();
}

TEST_F(StreamedPositions, FewerPeriodsThanAreSentAhead) {
  PositionStreamOptions options;
  options.ahead = 5;
  open(options);
  EXPECT_EQ(send({3}), "");
  EXPECT_EQ(send({5}), "");
  EXPECT_EQ(engine_->positions()[0], 0) << "not begun yet";
  EXPECT_EQ(stream_->finish()[0], 5 * kWhole);
  EXPECT_EQ(engine_->positions()[0], 5);
  EXPECT_EQ(message_of<StateError>([&] { stream_->finish(); }),
            "position stream: closed by an error or at its end; recover it, or open another");
}

TEST_F(StreamedPositions, OpensInAHoldOfItsOwnProgram) {
  card_.set_hold(true);
  engine_->wait(20'000);
  open();
  EXPECT_EQ(send({3}), "");
  EXPECT_EQ(send({5}), "");
  engine_->wait(20'000);
  EXPECT_EQ(engine_->positions()[0], 0);
  card_.set_hold(false);
  EXPECT_EQ(stream_->finish()[0], 5 * kWhole);
}

// A period is late at low speed; then the stream runs at full speed. The delay is made up only when the speed is low
// again.
TEST_F(StreamedPositions, NothingIsCaughtUpAtFullSpeed) {
  PositionStreamOptions options;
  options.max_speed[0] = 10'000;
  open(options);
  std::int64_t at = 0;
  std::uint64_t next = engine_->cycles();
  const auto period = [&](std::int64_t pulses, std::uint64_t late) {
    at += pulses;
    next += kMillisecond;
    if (engine_->cycles() < next + late) engine_->wait(next + late - engine_->cycles());
    return stream_->send({at * kWhole}, kMillisecond);
  };
  for (int i = 0; i < 10; ++i) period(1, 0);
  ASSERT_GT(period(1, 1900).stale_ticks, 200U);
  const std::uint64_t behind = stream_->ticks_behind();
  ASSERT_GT(behind, 200U);
  for (int i = 0; i < 5; ++i) period(10, 0);
  EXPECT_EQ(stream_->ticks_behind(), behind);
  for (int i = 0; i < 5; ++i) period(1, 0);
  EXPECT_EQ(stream_->ticks_behind(), 0U);
  EXPECT_EQ(stream_->finish()[0], at * kWhole);
  EXPECT_EQ(engine_->positions()[0], at);
}

TEST_F(StreamedPositions, ABusThatIsTooSlowIsSaid) {
  const std::function<void(Access&)> forgeries[] = {[](Access& access) {
                                                      if (access.address == reg::kStatus)
                                                        access.data |= field::kStatusStale;
                                                    },
                                                    [](Access& access) {
                                                      if (access.address == reg::kStatus)
                                                        access.data &= ~field::kStatusBusy;
                                                    },
                                                    [busy = false](Access& access) mutable {
                                                      if (access.address == reg::kGeometryBegun) busy = !busy;
                                                      if (access.address == reg::kStatus && busy)
                                                        access.data &= ~field::kStatusBusy;
                                                    }};
  for (const auto& forgery : forgeries) {
    engine_->reset();
    card_ = Card::open(bus_);
    open();
    go();
    bus_.on_read = forgery;
    EXPECT_THAT(message_of<StateError>([&] { stream_->send({110 * kWhole}, kMillisecond); }),
                HasSubstr("position stream: period 11 was over when it was looked at: the bus is too slow for it"));
    bus_.on_read = nullptr;
    EXPECT_THROW(stream_->send({110 * kWhole}, kMillisecond), StateError) << "closed";
  }
}

// Another period begins between the reads of one look, so the look is repeated.
TEST_F(StreamedPositions, ALookAtTwoPeriodsIsMadeAgain) {
  open();
  go();
  int reads = 0;
  bus_.on_read = [&](Access& access) {
    if (access.address == reg::kGeometryBegun && ++reads == 1) --access.data;
  };
  EXPECT_EQ(send({110}), "");
  EXPECT_EQ(reads, 4);
  EXPECT_EQ(stream_->finish()[0], 110 * kWhole);
}

TEST_F(StreamedPositions, AnEndElsewhereIsFound) {
  open();
  go();
  bus_.on_read = [](Access& access) {
    if (access.address == reg::snap_position(1)) access.data += 3;
  };
  EXPECT_EQ(message_of<StateError>([&] { stream_->finish(); }),
            "position stream: axis 1 ended 3 pulses from where it was sent: the card was used by somebody else");
  bus_.on_read = nullptr;
  EXPECT_EQ(message_of<StateError>([&] { stream_->finish(); }),
            "position stream: closed by an error or at its end; recover it, or open another");
  EXPECT_EQ(stream_->recover().positions[0], 100 * kWhole);
}

TEST_F(StreamedPositions, RecoveryWaitsForTheEndOfTheRamp) {
  open();
  go();
  engine_->wait(8000);
  EXPECT_THROW(stream_->send({110 * kWhole}, kMillisecond), FaultError);
  ASSERT_TRUE(card_.busy()) << "on its ramp";
  const PositionStream::Stopped stopped = stream_->recover();
  EXPECT_EQ(stopped.faults, field::kFaultMissingPeriod);
  EXPECT_GT(stopped.positions[0], 150 * kWhole) << "a period and half of the ramp's time";
  EXPECT_EQ(stopped.positions[0], engine_->positions()[0] * kWhole);
  EXPECT_FALSE(card_.busy());
  EXPECT_EQ(card_.read_faults(), 0U);
}

TEST_F(StreamedPositions, RecoveryIsInterruptedAndMadeAgain) {
  open();
  go();
  engine_->wait(8000);
  bus_.takes = kInterruptSlice;
  {
    const InterruptScope interrupt([] { return true; });
    EXPECT_EQ(message_of<InterruptedError>([&] { stream_->recover(); }),
              "position stream: interrupted before the card stood; recover it again");
  }
  bus_.takes = 0ns;
  const PositionStream::Stopped stopped = stream_->recover();
  EXPECT_EQ(stopped.positions[0], engine_->positions()[0] * kWhole);
  EXPECT_EQ(stopped.faults, field::kFaultMissingPeriod);
}

TEST_F(StreamedPositions, RecoveryOfACardThatNeverStandsTimesOut) {
  PositionStreamOptions options;
  options.margin = 5ms;
  open(options);
  go();
  engine_->wait(50'000);
  bus_.on_read = [](Access& access) {
    if (access.address == reg::kStatus) access.data |= field::kStatusBusy;
  };
  const std::uint64_t begun = engine_->cycles();
  EXPECT_THAT(message_of<TimeoutError>([&] { stream_->recover(); }),
              HasSubstr("position stream: waiting for the card to stand: not within"));
  EXPECT_GE(engine_->cycles() - begun, 15'000U) << "the longest ramp and the margin";
  EXPECT_LE(engine_->cycles() - begun, 25'000U);
  bus_.on_read = nullptr;
  EXPECT_EQ(stream_->recover().faults, field::kFaultMissingPeriod);
}

}  // namespace
}  // namespace trammel::driver
