// The rules of the soft limits: which pulse is a cause, how soon, when it may be cleared, and which axis is named.
#include "trammel/model/soft_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>
#include <vector>

namespace trammel::model {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

enum class Towards : std::uint8_t { Minus, Plus };

// The soft limits of a card and the positions of its axes.
struct Guarded {
  explicit Guarded(unsigned axes = 4) : block(axes) {}

  void clock() {
    block.clock(in);
    in.counts = 0;
    for (unsigned n = 0; n < card_map::kMaxAxes; ++n) in.position[n] += moves[n];
    moves = {};
    ++now;
    if (block.cause()) caused.push_back(now);
  }
  void run(unsigned clocks) {
    for (; clocks != 0; --clocks) clock();
  }
  void set(std::uint32_t address, std::uint32_t data) {
    in.setting = {true, address, data};
    clock();
    in.setting.set = false;
  }
  void range(unsigned axis, std::int64_t minus, std::int64_t plus) {
    set(reg::soft_minus(axis), static_cast<std::uint32_t>(minus));
    set(reg::soft_plus(axis), static_cast<std::uint32_t>(plus));
  }
  void begin_pulse(unsigned axis, Towards towards) {
    const auto bit = static_cast<std::uint8_t>(1U << axis);
    in.counts |= bit;
    in.back = static_cast<std::uint8_t>(towards == Towards::Minus ? in.back | bit : in.back & ~bit);
    moves[axis] = towards == Towards::Minus ? ~std::uint32_t{0} : 1U;
  }
  // True when the pulse was a cause.
  bool pulse(unsigned axis, Towards towards) {
    const std::size_t before = caused.size();
    begin_pulse(axis, towards);
    run(20);
    return caused.size() != before;
  }
  bool pulses(unsigned axis, Towards towards, unsigned count) {
    bool any = false;
    for (; count != 0; --count) any = pulse(axis, towards) || any;
    return any;
  }
  void clear() {
    in.clear = true;
    clock();
    in.clear = false;
  }

  SoftLimits block;
  SoftLimits::Inputs in;
  std::array<std::uint32_t, card_map::kMaxAxes> moves{};
  std::uint64_t now = 0;
  std::vector<std::uint64_t> caused;
};

TEST(SoftLimits, TheEndsBelongToTheRange) {
  Guarded limits;
  limits.range(2, -3, 2);
  limits.set(reg::kSoftLimits, 1U << 2);
  EXPECT_FALSE(limits.pulses(2, Towards::Plus, 2)) << "2 is the last";
  EXPECT_TRUE(limits.pulse(2, Towards::Plus));
  EXPECT_EQ(limits.block.limit_state(), field::kLimitStateSoftPlus | 2U << field::kLimitStateSoftAxisShift);
  EXPECT_TRUE(limits.pulse(2, Towards::Plus)) << "further out";
  limits.clear();
  EXPECT_EQ(limits.block.limit_state(), 0U);
  limits.run(50);
  EXPECT_FALSE(limits.block.cause()) << "an event: FAULT may be cleared while the axis stands there";
  EXPECT_FALSE(limits.pulse(2, Towards::Minus)) << "moving back is free, beyond the end too";
  EXPECT_TRUE(limits.pulse(2, Towards::Plus)) << "outwards is blocked still";
  limits.clear();
  EXPECT_FALSE(limits.pulses(2, Towards::Minus, 7));
  EXPECT_TRUE(limits.pulse(2, Towards::Minus)) << "-3 was the last";
  EXPECT_EQ(limits.block.limit_state(), 2U << field::kLimitStateSoftAxisShift);
}

TEST(SoftLimits, OnlyAxesThatHaveThem) {
  Guarded limits;
  EXPECT_FALSE(limits.pulses(1, Towards::Plus, 5)) << "none after reset";
  limits.set(reg::kSoftLimits, 1U << 2);
  EXPECT_FALSE(limits.pulses(1, Towards::Plus, 5));
  EXPECT_TRUE(limits.pulse(2, Towards::Plus)) << "ends that were never written are 0";
  limits.set(reg::kSoftLimits, 0);
  EXPECT_FALSE(limits.pulse(2, Towards::Plus));
}

TEST(SoftLimits, TheFirstAxisIsNamed) {
  Guarded limits(8);
  limits.set(reg::kSoftLimits, 0xFF);
  limits.pulse(6, Towards::Minus);
  limits.pulse(3, Towards::Plus);
  EXPECT_EQ(limits.block.limit_state(), 6U << field::kLimitStateSoftAxisShift);
  limits.clear();
  limits.pulse(3, Towards::Plus);
  EXPECT_EQ(limits.block.limit_state(), field::kLimitStateSoftPlus | 3U << field::kLimitStateSoftAxisShift);
}

// A range that ends less than 2^31 pulses away is judged correctly from any position, also across the carry of 2^32.
TEST(SoftLimits, PositionsWrap) {
  constexpr std::int64_t kFar = (std::int64_t{1} << 31) - 2;
  for (const std::uint32_t here : {0U, 5U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU, 0xFFFFFFF0U}) {
    Guarded limits;
    limits.in.position[0] = here;
    limits.range(0, std::int64_t{here} - kFar, std::int64_t{here} + kFar);
    limits.set(reg::kSoftLimits, 1);
    EXPECT_FALSE(limits.pulse(0, Towards::Plus)) << here;
    EXPECT_FALSE(limits.pulses(0, Towards::Minus, 2)) << here;
    limits.range(0, std::int64_t{here} - 2, std::int64_t{here} + 1);
    EXPECT_FALSE(limits.pulse(0, Towards::Minus)) << here;
    EXPECT_TRUE(limits.pulse(0, Towards::Minus)) << here;
    EXPECT_FALSE(limits.pulses(0, Towards::Plus, 4)) << here;
    EXPECT_TRUE(limits.pulse(0, Towards::Plus)) << here;
  }
}

// Axes at the highest rate of the shapers, on both sides of their ends. Each pulse that ends beyond an end is a cause
// in time, and there is no other cause.
void every_pulse_is_judged(unsigned axes) {
  constexpr std::int64_t kEnd = 6;
  Guarded limits(axes);
  for (unsigned n = 0; n < axes; ++n) limits.range(n, -kEnd, kEnd);
  limits.set(reg::kSoftLimits, (1U << axes) - 1);
  const std::uint64_t latest = limits.block.round() + 2;  // from the position to the cause; FAULT: one clock later
  std::mt19937_64 random(axes);
  std::vector<unsigned> since(axes, 20);
  std::vector<Towards> directions(axes, Towards::Plus);
  std::vector<std::uint64_t> due;
  std::uint64_t beyond = 0;
  for (unsigned i = 0; i < 200'000; ++i) {
    for (unsigned n = 0; n < axes; ++n) {
      const auto at = static_cast<std::int32_t>(limits.in.position[n]);
      // Far outside, the axis mostly turns back.
      const bool turns = random() % 8 == 0 || std::abs(at) > kEnd + 5;
      const Towards inwards = at > 0 ? Towards::Minus : Towards::Plus;
      const Towards towards = turns                ? inwards
                              : random() % 50 == 0 ? (inwards == Towards::Minus ? Towards::Plus : Towards::Minus)
                                                   : directions[n];
      if (++since[n] < (towards == directions[n] ? 6U : 13U) || random() % 3 == 0) continue;
      since[n] = 0;
      directions[n] = towards;
      limits.begin_pulse(n, towards);
      const std::int32_t after = at + (towards == Towards::Plus ? 1 : -1);
      if (towards == Towards::Plus ? after > kEnd : after < -kEnd) due.push_back(limits.now + 1);
    }
    const std::size_t before = limits.caused.size();
    limits.clock();
    if (limits.caused.size() != before) {
      ASSERT_FALSE(due.empty()) << "clock " << i << ": no pulse was too far";
      ++beyond;
    }
    // One cause may stand for several pulses of its axis.
    while (!due.empty() && limits.now >= due.front() + latest) {
      const auto in_time = [&](std::uint64_t at) { return at > due.front() + 1 && at <= due.front() + latest; };
      ASSERT_TRUE(std::any_of(limits.caused.rbegin(), limits.caused.rend(), in_time)) << "clock " << i;
      due.erase(due.begin());
    }
  }
  EXPECT_GT(beyond, 1'000U);
}

TEST(SoftLimits, EveryPulseIsJudgedInTime) {
  for (const unsigned axes : {1U, 3U, 4U, 5U, 8U}) every_pulse_is_judged(axes);
}

}  // namespace
}  // namespace trammel::model
