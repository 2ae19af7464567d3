// Position streaming through the driver on the card in lockstep: periods in time, late and missing, and the recovery.
#include "trammel/driver/position_stream.hpp"

#include <gtest/gtest.h>

#include "trammel/card_map.hpp"
#include "trammel/sim/engines.hpp"

namespace {

using namespace trammel;
using namespace std::chrono_literals;
using driver::PositionStream;

TEST(PositionStreamOnRtl, LateMissingAndRecovered) {
  sim::SimulationOptions options;
  options.kind = sim::EngineKind::kRtl;
  const auto engine = sim::make_engine(options);
  driver::Card card = driver::Card::open(*engine);
  card.set_slew_time(20ms);
  PositionStream stream(card);
  PositionStream::Positions target{};
  std::uint64_t due = engine->cycles() + 2000;
  const auto send = [&](std::uint64_t late) {
    target[0] += 5 * PositionStream::kPulse / 2;
    target[3] -= PositionStream::kPulse;
    if (engine->cycles() < due + late) engine->wait(due + late - engine->cycles());
    due += 1000;
    return stream.send(target, 1000).stale_ticks;
  };
  std::uint64_t stale = 0;
  for (int i = 0; i < 60; ++i) stale += send(i % 20 == 10 ? 1700 : 0);
  EXPECT_GT(stale, 100U);
  EXPECT_EQ(stream.ticks_behind(), 0U);
  EXPECT_THROW(send(50'000), driver::FaultError);
  const PositionStream::Stopped stopped = stream.recover();
  EXPECT_EQ(stopped.faults, card_map::field::kFaultMissingPeriod);
  for (unsigned n = 0; n < 4; ++n) EXPECT_EQ(engine->positions()[n] * PositionStream::kPulse, stopped.positions[n]);
  target = stopped.positions;
  due = engine->cycles();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(send(0), 0U);
  const PositionStream::Positions end = stream.finish();
  EXPECT_EQ(end[0], stopped.positions[0] + 50 * PositionStream::kPulse);
  EXPECT_EQ(end[3], stopped.positions[3] - 20 * PositionStream::kPulse);
  EXPECT_EQ(engine->lockstep_cycles(), engine->cycles());
}

// Accelerates towards a soft limit until a period is refused, and then sends nothing. The axis comes to rest before the
// limit, by less than two periods at the last speed.
TEST(PositionStreamOnRtl, ComesToRestBeforeASoftLimit) {
  for (const std::int32_t direction : {1, -1}) {
    sim::SimulationOptions options;
    options.kind = sim::EngineKind::kRtl;
    const auto engine = sim::make_engine(options);
    driver::Card card = driver::Card::open(*engine);
    card.set_slew_time(8ms);
    card.set_soft_limits({driver::SoftRange{-700, 700}});
    PositionStream stream(card);
    PositionStream::Positions target{};
    std::int64_t speed = 0;  // pulses per period
    std::string refusal;
    while (refusal.empty()) {
      if (speed < 40) ++speed;
      target[0] += direction * speed * PositionStream::kPulse;
      try {
        stream.send(target, 1000);
        if (engine->cycles() > 3000) engine->wait(700);
      } catch (const driver::ArgumentError& error) {
        refusal = error.what();
      }
    }
    EXPECT_NE(refusal.find("before the soft limit at " + std::to_string(direction * 700)), std::string::npos)
        << refusal;
    engine->wait(60'000);
    EXPECT_EQ(card.read_faults(), card_map::field::kFaultMissingPeriod);
    const std::int64_t end = direction * engine->positions()[0];
    EXPECT_LE(end, 700);
    EXPECT_GT(end, 700 - 2 * speed);
    // Moving back is allowed.
    target = stream.recover().positions;
    target[0] -= direction * 20 * PositionStream::kPulse;
    EXPECT_NO_THROW(stream.send(target, 1000));
  }
}

}  // namespace
