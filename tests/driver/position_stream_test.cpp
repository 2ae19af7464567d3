// Position streaming on the golden model, against closed forms: every step of 30,000 periods (100,000 under
// TRAMMEL_LONG) against the targets and the clock, late periods, missing periods, and refusals.
#include "trammel/driver/position_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>
#include <vector>

#include "posted_bus.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/driver/trigonometry.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::driver {

// Adds `lines` to the stream's numbers of sent and begun lines.
struct PositionStreamCount {
  static void add(PositionStream& stream, std::uint32_t lines) {
    stream.lines_ += lines;
    stream.begun_ += lines;
  }
};

namespace {

using namespace std::chrono_literals;
namespace reg = card_map::reg;
namespace field = card_map::field;
using Positions = PositionStream::Positions;

constexpr std::int64_t kPulse = PositionStream::kPulse;

std::int64_t fraction(double pulses) { return std::llround(pulses * static_cast<double>(kPulse)); }
double pulses(std::int64_t position) { return static_cast<double>(position) / static_cast<double>(kPulse); }

// Two axes on sines that begin and end at rest, and one axis at constant speed. `share`: part of the run, 0 .. 1.
Positions sines(double share, double turns) {
  Positions p{};
  p[0] = fraction(1000.25 * (1 - std::cos(2 * kPi * turns * share)));
  p[1] = fraction(-777.7 * std::sin(2 * kPi * turns * share) * std::sin(kPi * share));
  p[2] = fraction(5432.1 * share);
  return p;
}

// Sends each period when it is due, as a servo thread does. Records the targets and every step.
class Host : public StepSink {
 public:
  explicit Host(const PositionStreamOptions& options = {}, std::uint32_t clock_hz = 1'000'000)
      : engine(sim::make_model_engine(options_of(clock_hz))), card(Card::open(*engine)) {
    engine->set_sink(this);
    card.set_slew_time(50ms);
    stream.emplace(card, options);
    next_ = engine->cycles() + 5000;
    ahead_ = options.ahead;
  }

  // Sends a period `late` clocks after it is due.
  PositionStream::Sent send(const Positions& targets, std::uint64_t clocks, std::uint64_t late = 0) {
    const std::uint64_t due = next_ + late;
    if (engine->cycles() < due) engine->wait(due - engine->cycles());
    next_ += clocks;
    told.push_back(targets);
    clocks_.push_back(clocks);
    return stream->send(targets, clocks);
  }

  void pin_step(const PinStep&) override {}
  void path_step(const PathStep& step) override { steps.push_back(step); }

  // The steps compared with the host's clock, which is 0 at the beginning of the first period.
  struct Judged {
    double farthest = 0;                // largest distance from the straight line between two targets, pulses
    std::uint64_t steps = 0;            // number of steps
    std::int64_t earliest = INT64_MAX;  // clocks from a step's tick on the host's clock to the step
    std::int64_t latest = INT64_MIN;
  };
  // Only periods `first` .. `end` - 1 count for `earliest` and `latest`.
  Judged judge(std::size_t first = 0, std::size_t end = SIZE_MAX) const;

  std::unique_ptr<sim::Engine> engine;
  Card card;
  std::optional<PositionStream> stream;
  std::vector<Positions> told;
  std::vector<PathStep> steps;

 private:
  static sim::ModelOptions options_of(std::uint32_t clock_hz) {
    sim::ModelOptions options;
    options.clock_hz = clock_hz;
    return options;
  }

  std::uint64_t next_ = 0;  // clock at which the next period is due
  unsigned ahead_ = 0;
  std::vector<std::uint64_t> clocks_;
};

// The periods that count must not be late. Clocks of periods must be even, so that each period begins with a whole
// tick.
Host::Judged Host::judge(std::size_t first, std::size_t end) const {
  Judged judged;
  std::vector<std::uint64_t> ends;
  for (const std::uint64_t clocks : clocks_) ends.push_back((ends.empty() ? 0 : ends.back()) + clocks);
  std::array<std::int64_t, card_map::kMaxAxes> position{};
  for (const PathStep& step : steps) {
    // The FEED also takes a command number, after the first `ahead_` lines.
    const auto period = static_cast<std::size_t>(step.command < ahead_ ? step.command : step.command - 1);
    position[step.axis] += step.direction;
    const std::uint64_t begin = period == 0 ? 0 : ends[period - 1];
    const std::uint64_t at = begin + PositionStream::kClocksPerTick * step.tick;
    const double from = period == 0 ? 0 : pulses(told[period - 1][step.axis]);
    const double to = pulses(told[period][step.axis]);
    const double share = static_cast<double>(at - begin) / static_cast<double>(clocks_[period]);
    const double away = static_cast<double>(position[step.axis]) - (from + (to - from) * share);
    judged.farthest = std::max(judged.farthest, std::abs(away));
    ++judged.steps;
    if (period < first || period >= end) continue;
    const auto delay = static_cast<std::int64_t>(step.cycle - at);
    judged.earliest = std::min(judged.earliest, delay);
    judged.latest = std::max(judged.latest, delay);
  }
  return judged;
}

// 32-bit CPUs are emulated, some twenty times slower.
constexpr bool kEmulated = sizeof(void*) < 8;

// 1 kHz for 30 s (100 s under TRAMMEL_LONG). No step is early or late by a clock, and none is farther than about 1
// pulse from the line between the targets.
TEST(PositionStream, FollowsSines) {
  const std::size_t periods = kEmulated ? 2'000 : std::getenv("TRAMMEL_LONG") != nullptr ? 100'000 : 30'000;
  Host host;
  for (std::size_t i = 1; i <= periods; ++i) {
    const auto sent = host.send(
        sines(static_cast<double>(i) / static_cast<double>(periods), static_cast<double>(periods) / 2'500), 1000);
    ASSERT_EQ(sent.stale_ticks, 0U) << i;
  }
  const Positions end = host.stream->finish();
  const Positions last = host.told.back();
  for (unsigned n = 0; n < 4; ++n) {
    EXPECT_LE(std::abs(end[n] - last[n]), kPulse / 2) << n;
    EXPECT_EQ(host.engine->positions()[n] * kPulse, end[n]) << n;
  }
  const Host::Judged judged = host.judge();
  EXPECT_EQ(judged.earliest, judged.latest);
  // Half a pulse by the rounding of the target, half a pulse by the line, and the distance of one tick.
  EXPECT_LE(judged.farthest, 1.0 + 0.02);
  EXPECT_GT(judged.farthest, 0.5);
  EXPECT_GT(judged.steps, periods);
  std::cout << periods << " periods, " << judged.steps << " steps: at most " << judged.farthest
            << " pulses from the targets' line, all " << judged.latest << " clocks after their tick\n";
}

// Durations that are not whole clocks, and clocks that are not whole ticks: the sum is exact to a tick.
TEST(PositionStream, TimesAreCarriedOver) {
  constexpr std::uint64_t kPeriods = kEmulated ? 1'001 : 30'001;
  Host host({1, 4, {}, 1s});
  const auto period = std::chrono::nanoseconds(333'333);  // 333.333 clocks
  const std::uint64_t begin = host.engine->cycles();
  for (std::uint64_t i = 1; i <= kPeriods; ++i) {
    const std::uint64_t due = begin + i * 333'333 / 1000;
    if (host.engine->cycles() < due) host.engine->wait(due - host.engine->cycles());
    Positions p{};
    p[0] = fraction(static_cast<double>(i) * 2.5);
    ASSERT_EQ(host.stream->send(p, period).stale_ticks, 0U) << i;
  }
  host.stream->finish();
  // The first step of the first period and the last step of the last period.
  const PathStep& first = host.steps.front();
  const PathStep& last = host.steps.back();
  const double clocks = static_cast<double>(last.cycle - first.cycle);
  const double all = static_cast<double>(kPeriods) * 333.333;
  EXPECT_NEAR(clocks, all - 333.333 / 3, 333.333 / 4);
  EXPECT_EQ(host.engine->positions()[0], std::llround(static_cast<double>(kPeriods) * 2.5 + 0.1));
  // No line has more than 167 ticks: 333.333 clocks at 2 clocks per tick, plus the remainder carried over.
  std::uint64_t ticks = 0;
  for (const PathStep& step : host.steps) ticks = std::max(ticks, step.tick);
  EXPECT_LE(ticks, 167U);
}

// Many periods are late, by up to a whole period. The card continues along its line, then returns to the targets in
// place and in time.
TEST(PositionStream, LatePeriodsLeaveNoError) {
  constexpr std::size_t kPeriods = kEmulated ? 1500 : 4000;
  std::mt19937_64 random(5);
  Host host;
  std::uint64_t late = 0;
  std::uint64_t most = 0;
  for (std::size_t i = 1; i <= kPeriods; ++i) {
    const bool is_late = i > 10 && i + 100 < kPeriods && i % 20 == 0;
    // Two periods are queued ahead, so a period that is late by more than 1000 clocks comes after the end of the queue.
    const auto sent = host.send(sines(static_cast<double>(i) / kPeriods, 3), 1000, is_late ? 1050 + random() % 900 : 0);
    late += sent.stale_ticks != 0 ? 1U : 0U;
    most = std::max(most, sent.stale_ticks);
  }
  EXPECT_GT(late, 50U);
  EXPECT_GT(most, 250U);
  EXPECT_GT(host.stream->stale_ticks(), 50U * 100);
  EXPECT_EQ(host.stream->ticks_behind(), 0U);
  const Positions end = host.stream->finish();
  for (unsigned n = 0; n < 4; ++n) {
    EXPECT_LE(std::abs(end[n] - host.told.back()[n]), kPulse / 2) << n;
    EXPECT_EQ(host.engine->positions()[n] * kPulse, end[n]) << n;
  }
  // The last hundred periods run at the host's times again, like the first ten.
  const Host::Judged before = host.judge(0, 10);
  const Host::Judged behind = host.judge(kPeriods - 100);
  EXPECT_EQ(before.earliest, before.latest);
  EXPECT_EQ(behind.earliest, before.latest);
  EXPECT_EQ(behind.latest, before.latest);
  std::cout << late << " late periods, the latest by " << most << " ticks of 500\n";
}

// At constant speed a late period does not change the speed: the distances between steps stay about the same.
TEST(PositionStream, ALatePeriodKeepsTheSpeed) {
  Host host;
  for (std::size_t i = 1; i <= 100; ++i) {
    Positions p{};
    p[0] = static_cast<std::int64_t>(10 * i) * kPulse;  // a pulse every 100 clocks
    host.send(p, 1000, i == 50 ? 1900 : 0);
  }
  EXPECT_GT(host.stream->stale_ticks(), 100U);
  // The targets do not slow down to rest, so the END stops the card at full speed.
  host.stream->finish();
  ASSERT_EQ(host.engine->positions()[0], 1000);
  std::uint64_t shortest = UINT64_MAX;
  std::uint64_t longest = 0;
  for (std::size_t i = 1; i < host.steps.size(); ++i) {
    const std::uint64_t apart = host.steps[i].cycle - host.steps[i - 1].cycle;
    shortest = std::min(shortest, apart);
    longest = std::max(longest, apart);
  }
  // Reasons for the tolerance: rounding of one pulse in a shortened period of 5 pulses or more, and a line that
  // continued by a fraction of a pulse.
  EXPECT_GT(shortest, 50U);
  EXPECT_LT(longest, 200U);
}

TEST(PositionStream, AMissingPeriodStopsAndIsRecoveredFrom) {
  for (const unsigned stale_periods : {0U, 1U, 3U}) {
    PositionStreamOptions options;
    options.stale_periods = stale_periods;
    Host host(options);
    const auto target = [](std::size_t i) {
      Positions p{};
      p[0] = static_cast<std::int64_t>(7 * i) * kPulse;
      p[3] = -static_cast<std::int64_t>(3 * i) * kPulse;
      return p;
    };
    std::size_t i = 0;
    while (++i <= 50) host.send(target(i), 1000);
    host.engine->wait(200'000);
    try {
      host.send(target(i), 1000);
      FAIL() << "sent";
    } catch (const FaultError& e) {
      EXPECT_EQ(e.faults(), field::kFaultMissingPeriod);
    }
    EXPECT_THROW(host.stream->send(target(i), 1000), StateError);
    const PositionStream::Stopped stopped = host.stream->recover();
    EXPECT_EQ(stopped.faults, field::kFaultMissingPeriod);
    // The ramp of 50 ms covers the distance of 25 ms at full speed: 12,500 ticks.
    EXPECT_NEAR(static_cast<double>(stopped.stale_ticks), 500.0 * stale_periods + 12'500, 130);
    // The card continued along its last line: 7 and 3 pulses in 500 ticks.
    const auto gone = static_cast<std::int64_t>(stopped.stale_ticks);
    EXPECT_EQ(stopped.positions[0], (350 + (7 * gone + 250) / 500) * kPulse);
    EXPECT_EQ(stopped.positions[3], -(150 + (3 * gone + 249) / 500) * kPulse);
    for (unsigned n = 0; n < 4; ++n) EXPECT_EQ(host.engine->positions()[n] * kPulse, stopped.positions[n]);
    EXPECT_EQ(host.card.read_faults(), 0U);
    // The stream continues from there.
    Positions from = stopped.positions;
    for (int k = 0; k < 20; ++k) {
      from[0] += 5 * kPulse / 2;
      host.engine->wait(700);
      ASSERT_EQ(host.stream->send(from, 1000).stale_ticks, 0U);
    }
    EXPECT_EQ(host.stream->finish()[0], stopped.positions[0] + 50 * kPulse);
    EXPECT_EQ(host.engine->positions()[0] * kPulse, stopped.positions[0] + 50 * kPulse);
  }
}

TEST(PositionStream, RefusesBeforeAnythingIsSent) {
  PositionStreamOptions options;
  options.max_speed[0] = 5000;
  Host host(options);
  Positions p{};
  const auto error_of = [&](const Positions& targets, std::uint64_t clocks) -> std::string {
    try {
      host.stream->send(targets, clocks);
    } catch (const ArgumentError& e) {
      return e.what();
    }
    return "";
  };
  p[0] = 7 * kPulse;  // 7,000 pulses/s
  EXPECT_NE(error_of(p, 1000).find("axis 0: 7 pulses in 1000 clocks"), std::string::npos);
  p[0] = 6 * kPulse;  // 5,000 pulses/s, and one pulse that may be due to rounding
  EXPECT_EQ(error_of(p, 1000), "");
  p[1] = 200 * kPulse;
  EXPECT_NE(error_of(p, 1000).find("axis 1"), std::string::npos) << "the shaper takes 8 clocks a pulse";
  p[1] = 0;
  EXPECT_NE(error_of(p, host.stream->shortest_period() - 1), "");
  EXPECT_NE(error_of(p, (std::uint64_t{1} << 32) + 1), "");
  p[0] = (std::int64_t{1} << 30) * kPulse + 1;
  EXPECT_NE(error_of(p, 1000), "");
  p[0] = 0;
  p[4] = 1;
  EXPECT_NE(error_of(p, 1000), "") << "an axis that the card lacks";
  p[4] = 0;
  EXPECT_THROW(host.stream->send(p, -1ns), ArgumentError);
  EXPECT_THROW(host.stream->send(p, 5000s), ArgumentError);
  EXPECT_EQ(host.engine->read(reg::kGeometryBegun), 1U);
  // The refused periods have changed nothing.
  p[0] = 4 * kPulse;
  EXPECT_EQ(error_of(p, 1000), "");
  host.stream->finish();
  EXPECT_EQ(host.engine->positions()[0], 4);
  EXPECT_THROW(host.stream->send(p, 1000), StateError) << "it has ended";
  EXPECT_EQ(host.engine->read(reg::kStreaming), 0U);
}

TEST(PositionStream, OpensOnlyWhereItCanRun) {
  const auto engine = sim::make_model_engine({});
  Card card = Card::open(*engine);
  EXPECT_THROW(PositionStream(card, {256, 2, {}, 1s}), ArgumentError);
  EXPECT_THROW(PositionStream(card, {1, 0, {}, 1s}), ArgumentError);
  EXPECT_THROW(PositionStream(card, {1, 2, {-1.0}, 1s}), ArgumentError);
  card.set_ratio(0x8000);
  EXPECT_THROW(PositionStream{card}, StateError);
  card.set_ratio(Card::kFullRatio);
  Stream other(card);
  other.send(DwellCommand{1'000'000});
  EXPECT_THROW(PositionStream{card}, StateError);
  card.abort();
  engine->wait(100);
  PositionStream stream(card);
  stream.finish();

  sim::ModelOptions without;
  without.engines = card_map::engines::kLines | card_map::engines::kJerk;
  const auto plain = sim::make_model_engine(without);
  Card plain_card = Card::open(*plain);
  EXPECT_THROW(PositionStream{plain_card}, ArgumentError);
}

TEST(PositionStream, SaysThatTheQueueIsFull) {
  sim::ModelOptions small;
  small.geometry_depth = 64;  // 4 lines of 4 axes
  const auto engine = sim::make_model_engine(small);
  Card card = Card::open(*engine);
  PositionStream stream(card);
  Positions p{};
  unsigned sent = 0;
  for (;; ++sent) {
    p[0] += kPulse;
    try {
      stream.send(p, 50'000);
    } catch (const StateError&) {
      break;
    }
  }
  EXPECT_GE(sent, 3U);
  EXPECT_LE(sent, 6U);
  engine->wait(100'000);
  // The refused period can be sent as soon as there is room.
  stream.send(p, 50'000);
  ++sent;
  EXPECT_EQ(stream.finish()[0], static_cast<std::int64_t>(sent) * kPulse);
}

TEST(PositionStream, RunsOverPostedWrites) {
  const auto engine = sim::make_model_engine({});
  test::PostedBus bus(*engine);
  Card card = Card::open(bus);
  PositionStream stream(card);
  Positions p{};
  for (int i = 0; i < 100; ++i) {
    p[2] -= kPulse * 3 / 2;
    stream.send(p, 1000);
    engine->wait(600);
  }
  EXPECT_EQ(stream.finish()[2], -150 * kPulse);
  EXPECT_EQ(engine->positions()[2], -150);
}

// A card whose number of begun lines is higher by `earlier`.
class LongRun final : public Bus {
 public:
  explicit LongRun(Bus& bus) : bus_(bus) {}
  std::size_t transfer(Access* accesses, std::size_t count) override {
    const std::size_t made = bus_.transfer(accesses, count);
    for (std::size_t i = 0; i < made; ++i) {
      if (!accesses[i].write && accesses[i].address == reg::kGeometryBegun) accesses[i].data += earlier;
    }
    return made;
  }
  void sleep(std::chrono::nanoseconds time) override { bus_.sleep(time); }
  bool reports_refusals() const override { return true; }

  std::uint32_t earlier = 0;

 private:
  Bus& bus_;
};

// At 1 kHz the card's count of lines wraps after 49.7 days. The stream continues, the FEED is not sent again, and a
// count that goes back is still detected.
TEST(PositionStream, GoesOnWhereTheCountOfLinesWraps) {
  for (const bool reset : {false, true}) {
    const auto engine = sim::make_model_engine({});
    LongRun bus(*engine);
    Card card = Card::open(bus);
    PositionStream stream(card);
    Positions p{};
    const auto send = [&] {
      p[0] += 4 * kPulse;
      const PositionStream::Sent sent = stream.send(p, 1000);
      engine->wait(500);
      return sent;
    };
    for (int i = 0; i < 10; ++i) send();
    bus.earlier = std::uint32_t{0} - 20;
    PositionStreamCount::add(stream, bus.earlier);
    for (int i = 0; i < 30; ++i) {
      const std::uint64_t ahead = send().ahead;
      ASSERT_GE(ahead, 2U) << i;
      ASSERT_LE(ahead, 20U) << i;
    }
    EXPECT_EQ(card.parts().registers.read(reg::kFeedBegun), 1U);
    if (!reset) {
      EXPECT_EQ(stream.finish()[0], 160 * kPulse);
      EXPECT_EQ(engine->positions()[0], 160);
      continue;
    }
    bus.earlier -= 5;
    EXPECT_THROW(send(), StateError);
  }
}

// After an abort by another program or a reset, no wrong position is reported.
TEST(PositionStream, NoticesWhatOthersDo) {
  for (const bool reset : {false, true}) {
    Host host;
    Positions p{};
    for (int i = 0; i < 20; ++i) {
      p[0] += 4 * kPulse;
      host.send(p, 1000);
    }
    if (reset)
      host.engine->reset();
    else
      host.engine->write(reg::kControl, field::kControlAbort);
    p[0] += 4 * kPulse;
    EXPECT_THROW(host.send(p, 1000), Error);
    EXPECT_THROW(host.send(p, 1000), StateError);
    if (reset) continue;
    const auto stopped = host.stream->recover();
    EXPECT_EQ(stopped.positions[0], host.engine->positions()[0] * kPulse);
    EXPECT_EQ(stopped.faults, 0U);
  }
}

}  // namespace
}  // namespace trammel::driver
