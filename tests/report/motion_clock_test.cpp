#include "trammel/report/motion_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "motion_walk.hpp"

namespace trammel::report {
namespace {

// Clock of each path's last tick, computed by the second reader of tests/motion, which adds up the feed generator's
// integers update by update.
struct Walked {
  std::vector<std::uint64_t> ends;  // by command
  void start() {}
  void stop() {}
  void interval(const test::Interval& now) {
    ends.resize(now.path->command + 1);
    ends[now.path->command] = now.clock + now.clocks;
  }
};

struct Program {
  std::vector<driver::Command> commands;
  void piece(std::uint64_t ticks, double rate, double acceleration, double jerk, double floor) {
    driver::FeedCommand feed;
    feed.ticks = ticks;
    feed.rate = static_cast<std::uint64_t>(rate * 0x1p64);
    feed.acceleration = static_cast<std::int64_t>(acceleration * 0x1p64);
    feed.jerk = static_cast<std::int64_t>(jerk * 0x1p64);
    feed.floor = static_cast<std::uint32_t>(floor * 0x1p32);
    commands.emplace_back(feed);
  }
  void line(std::uint64_t ticks) {
    driver::LineCommand line;
    line.ticks = ticks;
    line.mask = 1;
    commands.emplace_back(line);
  }
};

struct Read {
  std::vector<MotionSegment> segments;
  std::vector<std::uint64_t> ends;  // clock of each line's last tick, by command
};

Read read(const std::vector<driver::Command>& commands) {
  Read result;
  MotionClock clock([&](const MotionSegment& segment) { result.segments.push_back(segment); });
  std::vector<std::pair<std::size_t, std::uint64_t>> ticks;
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (const auto* feed = std::get_if<driver::FeedCommand>(&commands[i])) {
      clock.piece(*feed);
    } else if (const auto* line = std::get_if<driver::LineCommand>(&commands[i])) {
      clock.path(i, line->ticks);
      ticks.emplace_back(i, clock.ticks());
    } else {
      clock.barrier();
    }
  }
  result.ends.resize(commands.size());
  for (const auto& [command, tick] : ticks) result.ends[command] = clock.clock_of(tick);
  return result;
}

// Both must give the same clock for each path's end. Sums in doubles may be off by one clock in either direction.
void expect_same(const Program& program) {
  test::MotionWalk walk(program.commands);
  Walked walked;
  walk.visit(walked);
  const Read found = read(program.commands);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < walked.ends.size(); ++i) {
    if (walked.ends[i] == 0) continue;
    EXPECT_NEAR(static_cast<double>(found.ends[i]), static_cast<double>(walked.ends[i]), 1.0) << "command " << i;
    ++compared;
  }
  EXPECT_GT(compared, 0U);
  std::uint64_t all = 0;
  for (const MotionSegment& segment : found.segments) all += segment.clocks;
  EXPECT_NEAR(static_cast<double>(all), static_cast<double>(walk.clocks()), 1.0);
}

TEST(MotionClock, OneRateIsALineInTime) {
  Program program;
  program.piece(1000, 0.125, 0, 0, 0x1p-20);
  program.line(1000);
  program.commands.emplace_back(driver::EndCommand{});
  const Read found = read(program.commands);
  ASSERT_EQ(found.segments.size(), 1U);
  EXPECT_EQ(found.segments[0].clocks, 8000U);
  EXPECT_DOUBLE_EQ(found.segments[0].rate, 0.125);
  EXPECT_EQ(found.segments[0].acceleration, 0);
  EXPECT_EQ(found.ends[1], 8000U);
}

// The speed is v = begin + a t. The host sends the rate for the middle of the first update, begin + 16 a.
TEST(MotionClock, ARampHasItsAccelerationAndBeginsAtItsSpeed) {
  constexpr double kAcceleration = 1e-7;  // ticks per clock^2
  constexpr double kBegin = 0.01;
  Program program;
  program.piece(5000, kBegin + kAcceleration * 16, kAcceleration * 32, 0, 0x1p-20);
  program.line(2000);
  program.line(3000);
  program.commands.emplace_back(driver::EndCommand{});
  const Read found = read(program.commands);
  ASSERT_EQ(found.segments.size(), 2U);
  EXPECT_NEAR(found.segments[0].rate, kBegin, 1e-12);
  EXPECT_NEAR(found.segments[0].acceleration, kAcceleration, 1e-16);
  // 2000 = b t + a t^2 / 2
  const double t = (std::sqrt(kBegin * kBegin + 2 * kAcceleration * 2000) - kBegin) / kAcceleration;
  EXPECT_NEAR(static_cast<double>(found.segments[0].clocks), t, 1);
  EXPECT_NEAR(found.segments[1].rate, kBegin + kAcceleration * t, 2 * kAcceleration);
}

// The acceleration is first added at the 32nd clock.
TEST(MotionClock, APieceWithoutAnUpdateHasOneRate) {
  Program program;
  program.piece(10, 0.5, 1e-3, 0, 0x1p-20);
  program.line(10);
  program.commands.emplace_back(driver::EndCommand{});
  const Read found = read(program.commands);
  ASSERT_EQ(found.segments.size(), 1U);
  EXPECT_EQ(found.segments[0].clocks, 20U);
  EXPECT_DOUBLE_EQ(found.segments[0].rate, 0.5);
  EXPECT_EQ(found.segments[0].acceleration, 0);
}

TEST(MotionClock, AgreesWithTheSecondReaderOnRandomMotions) {
  std::mt19937_64 random(12);
  const auto share = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  for (int motion = 0; motion < 200; ++motion) {
    Program program;
    for (int stretch = 0; stretch < 2; ++stretch) {
      std::uint64_t ticks = 0;
      const int pieces = 1 + static_cast<int>(share() * 5);
      for (int i = 0; i < pieces; ++i) {
        const auto some = static_cast<std::uint64_t>(40 + share() * 20000);
        const double rate = 0.002 + share() * 0.8;
        const double updates = static_cast<double>(some) / rate / 32;
        // The rate changes by at most half over the piece, with or without jerk. Some pieces fall to their floors.
        const double even = (share() - 0.5) * rate / updates;
        const bool falls = even < 0 && share() < 0.2;
        const double acceleration = falls ? 4 * even : even;
        const double jerk = falls || share() < 0.5 ? 0 : -acceleration / updates * share();
        program.piece(some, rate, acceleration, jerk, 0.001);
        ticks += some;
      }
      while (ticks != 0) {
        const std::uint64_t part = std::min(ticks, static_cast<std::uint64_t>(22 + share() * 4000));
        program.line(part);
        ticks -= part;
      }
      if (stretch == 0) program.commands.emplace_back(driver::DwellCommand{100});
    }
    program.commands.emplace_back(driver::EndCommand{});
    expect_same(program);
    if (HasFailure()) FAIL() << "motion " << motion;
  }
}

}  // namespace
}  // namespace trammel::report
