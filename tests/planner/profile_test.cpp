#include "trammel/planner/profile.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::planner {

using namespace driver;
namespace {

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

// The feed generator as the architecture page words it, in exact integers and whole updates of 32 clocks.
class FeedSimulation {
 public:
  void run(const FeedCommand& piece) {
    int128 rate = piece.rate;
    int128 acceleration = piece.acceleration;
    std::uint64_t slope = piece.rate >> 16;
    if (clocks_ == 0) {
      first_slope_ = slope;
    }
    jump(slope);
    for (std::uint64_t left = piece.ticks; left != 0;) {
      const uint128 sum = phase_ + static_cast<uint128>(slope) * 32;
      const auto ticks = static_cast<std::uint64_t>(sum >> 48);
      peak_slope_ = std::max(peak_slope_, slope);
      if (ticks >= left) {
        const uint128 need = (static_cast<uint128>(left) << 48) - phase_;
        const uint128 clocks = (need + slope - 1) / slope;
        clocks_ += static_cast<std::uint64_t>(clocks);
        phase_ = phase_ + slope * clocks - (static_cast<uint128>(left) << 48);
        last_slope_ = slope;
        break;
      }
      left -= ticks;
      phase_ = sum & ((uint128{1} << 48) - 1);
      clocks_ += 32;
      rate += acceleration;
      acceleration += piece.jerk;
      const int128 clamped = std::clamp<int128>(rate, static_cast<int128>(piece.floor) << 32, ~std::uint64_t{0});
      last_slope_ = slope;
      slope = static_cast<std::uint64_t>(clamped) >> 16;
      jump(slope);
    }
  }

  std::uint64_t clocks() const { return clocks_; }
  double first_rate() const { return std::ldexp(static_cast<double>(first_slope_), -48); }
  double last_rate() const { return std::ldexp(static_cast<double>(last_slope_), -48); }
  double peak_rate() const { return std::ldexp(static_cast<double>(peak_slope_), -48); }
  // Largest change of the rate from one update to the next, over piece borders too.
  double largest_jump() const { return std::ldexp(static_cast<double>(largest_jump_), -48); }

 private:
  void jump(std::uint64_t slope) {
    if (clocks_ != 0) {
      largest_jump_ = std::max(largest_jump_, slope > last_slope_ ? slope - last_slope_ : last_slope_ - slope);
    }
  }

  uint128 phase_ = 0;  // 48 fraction bits
  std::uint64_t clocks_ = 0;
  std::uint64_t first_slope_ = 0;
  std::uint64_t last_slope_ = 0;
  std::uint64_t peak_slope_ = 0;
  std::uint64_t largest_jump_ = 0;
};

// Over a path of as many units as ticks, at a clock of 1 Hz: rates are ticks a clock.
Profile profile(std::uint64_t ticks, double rate, double acceleration) {
  return trapezoid(ticks, {static_cast<double>(ticks), rate, acceleration}, 1);
}

FeedSimulation simulate(const Profile& pieces) {
  FeedSimulation simulation;
  for (const FeedCommand& piece : pieces) {
    simulation.run(piece);
  }
  return simulation;
}

std::uint64_t total_ticks(const Profile& pieces) {
  std::uint64_t sum = 0;
  for (const FeedCommand& piece : pieces) {
    sum += piece.ticks;
  }
  return sum;
}

double ideal_clocks(double ticks, double rate, double acceleration) {
  return rate * rate / acceleration >= ticks ? 2 * std::sqrt(ticks / acceleration) : ticks / rate + rate / acceleration;
}

// The time that may differ: a tick at the rest rate at each end, and an update at each of the ramps' four ends.
double time_slack(double acceleration) { return 2 / std::sqrt(acceleration) + 128; }

TEST(Profile, HasThreePiecesWithAllTicks) {
  // 9 and 20 mm at 80 steps/mm, 128 ticks a pulse, 100 mm/s and 1000 mm/s^2 at 100 MHz.
  const Profile pieces = profile(92160, 100.0 * 80 * 128 / 1e8, 1000.0 * 80 * 128 / 1e16);
  ASSERT_EQ(pieces.size(), 2U);  // 10 mm would be just the two ramps
  const Profile longer = profile(204800, 100.0 * 80 * 128 / 1e8, 1000.0 * 80 * 128 / 1e16);
  ASSERT_EQ(longer.size(), 3U);
  EXPECT_EQ(total_ticks(longer), 204800U);
  EXPECT_GT(longer[0].acceleration, 0);
  EXPECT_EQ(longer[1].acceleration, 0);
  EXPECT_LT(longer[2].acceleration, 0);
  const FeedSimulation run = simulate(longer);
  EXPECT_NEAR(static_cast<double>(run.clocks()), 0.3e8, 0.3e8 * 0.005);
  EXPECT_NEAR(run.peak_rate(), 100.0 * 80 * 128 / 1e8, 1e-9);
  EXPECT_NEAR(run.last_rate(), std::sqrt(1000.0 * 80 * 128 / 1e16), 1e-6);
}

TEST(Profile, EndsARampAtTheWantedSpeed) {
  const double rate = 0.05;
  const double acceleration = 1e-9;
  const Profile pieces = profile(10'000'000, rate, acceleration);
  ASSERT_EQ(pieces.size(), 3U);
  FeedSimulation ramp;
  ramp.run(pieces[0]);
  EXPECT_NEAR(ramp.last_rate(), rate, rate * 0.0005);
  EXPECT_LE(ramp.last_rate(), rate);
}

TEST(Profile, VeryShortMovesAreOnePiece) {
  for (std::uint64_t ticks : {1U, 2U, 22U}) {
    const Profile pieces = profile(ticks, 0.5, 0.25);
    EXPECT_EQ(total_ticks(pieces), ticks);
    EXPECT_LE(simulate(pieces).clocks(), 3 * ticks + 1);
  }
}

TEST(Profile, VerySlowFeedsEnd) {
  const Profile pieces = profile(3, 1e-9, 1e-9);
  ASSERT_EQ(pieces.size(), 1U);
  const auto clocks = static_cast<double>(simulate(pieces).clocks());
  EXPECT_NEAR(clocks, 3e9, 3e9 * 0.001);
}

TEST(Profile, RefusesNonsense) {
  EXPECT_THROW(profile(0, 0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(profile(std::uint64_t{1} << 40, 0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(profile(5, 0.0, 0.1), std::invalid_argument);
  EXPECT_THROW(profile(5, 0.1, -1.0), std::invalid_argument);
}

TEST(Profile, RandomMovesKeepTheirLimits) {
  std::size_t three_pieces = 0;
  const bool passed = rc::check("limits, ticks and time of random profiles", [&] {
    const double rate = std::exp2(-*rc::gen::inRange(0, 2600) / 100.0) * 0.9;
    const double acceleration = std::exp2(-*rc::gen::inRange(800, 5000) / 100.0);
    const auto ticks = static_cast<std::uint64_t>(std::exp2(*rc::gen::inRange(0, 3000) / 100.0));
    const double ideal = ideal_clocks(static_cast<double>(ticks), rate, acceleration);
    RC_PRE(ideal < 3e8);

    const Profile pieces = profile(ticks, rate, acceleration);
    three_pieces += pieces.size() == 3 ? 1U : 0U;
    RC_ASSERT(total_ticks(pieces) == ticks);
    for (const FeedCommand& piece : pieces) {
      RC_ASSERT(piece.ticks >= 1U);
      RC_ASSERT(piece.floor >= 1U);
    }
    const FeedSimulation run = simulate(pieces);
    const double rest = std::sqrt(acceleration);
    const double update = 32 * acceleration;
    RC_ASSERT(run.peak_rate() <= rate * (1 + 1e-9));
    // Within a piece at most an update's worth; at the border of two pieces up to one more of each ramp's end.
    RC_ASSERT(run.largest_jump() <= std::max(2 * update, std::sqrt(3.0) * rest) * 1.0001 + 1e-14);
    RC_ASSERT(run.first_rate() <= std::min(rate, 1.7322 * rest + update) * (1 + 1e-9));
    RC_ASSERT(run.last_rate() <= std::min(rate, 1.7322 * rest + update) * (1 + 1e-9));
    const auto clocks = static_cast<double>(run.clocks());
    RC_ASSERT(clocks <= ideal * 1.03 + time_slack(acceleration));
    RC_ASSERT(clocks >= ideal * 0.97 - time_slack(acceleration));
    RC_ASSERT(std::abs(duration(pieces) - clocks) <= 0.03 * clocks + time_slack(acceleration));
  });
  EXPECT_TRUE(passed);
  EXPECT_GT(three_pieces, 10U);
}

TEST(Profile, RampsAccelerateAtMostAsAskedFor) {
  EXPECT_TRUE(rc::check("acceleration of the pieces", [] {
    const double acceleration = std::exp2(-*rc::gen::inRange(800, 5000) / 100.0);
    const double rate = std::exp2(-*rc::gen::inRange(0, 2600) / 100.0) * 0.9;
    const auto ticks = static_cast<std::uint64_t>(std::exp2(*rc::gen::inRange(0, 3900) / 100.0));
    for (const FeedCommand& piece : profile(ticks, rate, acceleration)) {
      const double gained = std::ldexp(std::abs(static_cast<double>(piece.acceleration)), -64);
      RC_ASSERT(gained <= 32 * acceleration * (1 + 1e-9) + 0x1p-63);
    }
  }));
}

}  // namespace
}  // namespace trammel::planner
