// The golden model of the step shaper, judged by a checker that sees only its pins.
#include "trammel/model/step_shaper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

#include "trammel/skip/axis.hpp"

namespace trammel::model {
namespace {

StepShaper::Inputs times(unsigned length, unsigned space, unsigned setup, unsigned hold) {
  StepShaper::Inputs in;
  in.step_length = static_cast<std::uint16_t>(length);
  in.step_space = static_cast<std::uint16_t>(space);
  in.dir_setup = static_cast<std::uint16_t>(setup);
  in.dir_hold = static_cast<std::uint16_t>(hold);
  return in;
}

// Watches STEP and DIR (mode 0, any polarity) and checks all times and the position.
class PinChecker {
 public:
  explicit PinChecker(const StepShaper::Inputs& set) : set_(set) {}

  void watch(const StepShaper::Outputs& out) {
    ++now_;
    const bool step = out.step != ((set_.mode & 4) != 0);
    const bool dir = out.dir != ((set_.mode & 8) != 0);
    if (dir != dir_) {
      ASSERT_FALSE(step || step_) << "DIR turns in a pulse";
      if (pulses_ != 0) {
        ASSERT_GE(now_ - fell_, set_.dir_hold) << "hold";
      }
      turned_ = now_;
      any_turn_ = true;
    }
    if (step && !step_) {
      if (pulses_ != 0) {
        ASSERT_GE(now_ - fell_, std::max<std::uint64_t>(1, set_.step_space)) << "space";
      }
      if (any_turn_) {
        ASSERT_GE(now_ - turned_, set_.dir_setup) << "setup";
      }
      rose_ = now_;
      ++pulses_;
      position_ += dir ? ~std::uint32_t{0} : 1U;
      order_.push_back(dir);
    }
    if (!step && step_) {
      ASSERT_EQ(now_ - rose_, std::max<std::uint64_t>(1, set_.step_length)) << "length";
      fell_ = now_;
    }
    if (step) {
      ASSERT_LE(now_ - rose_, std::max<std::uint64_t>(1, set_.step_length)) << "stuck high";
    }
    ASSERT_EQ(out.position, position_) << "pins and position differ";
    step_ = step;
    dir_ = dir;
  }

  const std::deque<bool>& order() const { return order_; }
  std::uint32_t position() const { return position_; }

 private:
  StepShaper::Inputs set_;
  std::uint64_t now_ = 0;
  std::uint64_t rose_ = 0;
  std::uint64_t fell_ = 0;
  std::uint64_t turned_ = 0;
  std::uint64_t pulses_ = 0;
  std::uint32_t position_ = 0;
  bool step_ = false;
  bool dir_ = false;
  bool any_turn_ = false;
  std::deque<bool> order_;
};

// Random steps, never more than the shaper has places for, until it is idle. Each accepted step becomes one pulse, in
// order.
void judge_pins(StepShaper::Inputs in, unsigned steps, std::mt19937& random) {
  StepShaper shaper;
  PinChecker pins(in);
  std::deque<bool> wanted;
  while (wanted.size() < steps || shaper.outputs().busy) {
    const bool room = wanted.size() - pins.order().size() < StepShaper::kPlaces;
    in.step = wanted.size() < steps && room && random() % 4 == 0;
    if (random() % 3 == 0) in.dir = !in.dir;
    if (in.step) wanted.push_back(in.dir);
    shaper.clock(in);
    ASSERT_NO_FATAL_FAILURE(pins.watch(shaper.outputs()));
    ASSERT_FALSE(shaper.outputs().fault);
  }
  EXPECT_EQ(pins.order(), wanted);
}

TEST(StepShaper, KeepsRandomTimes) {
  std::mt19937 random(1);
  for (int n = 0; n < 400; ++n) {
    const unsigned top = 1U + (random() % 4 == 0 ? 300U : 12U);
    const auto time = [&random, top] { return static_cast<unsigned>(random() % top); };
    StepShaper::Inputs in = times(time(), time(), time(), time());
    in.mode = static_cast<std::uint8_t>(random() % 4 << 2);
    // Inverted pins must be inverted from the first clock on.
    judge_pins(in, 60, random);
    if (HasFatalFailure()) return;
  }
}

TEST(StepShaper, KeepsLargestTimes) {
  std::mt19937 random(2);
  for (unsigned which = 0; which < 16; ++which) {
    const auto largest = [which](unsigned bit) { return (which >> bit & 1) != 0 ? 0xFFFFU : 0U; };
    judge_pins(times(largest(0), largest(1), largest(2), largest(3)), 6, random);
    if (HasFatalFailure()) return;
  }
}

// The pins alone, decoded as up/down or quadrature, give the position.
TEST(StepShaper, UpDownAndQuadratureDecodeToThePosition) {
  std::mt19937 random(3);
  for (std::uint8_t mode = 0; mode < 16; ++mode) {
    if ((mode & 3) == 0) continue;
    StepShaper shaper;
    StepShaper::Inputs in = times(2, 3, 1, 4);
    in.mode = mode;
    shaper.clock(in);
    std::uint32_t decoded = 0;
    bool old_first = false;
    bool old_second = false;
    for (int i = 0; i < 20'000; ++i) {
      in.step = random() % 20 == 0;
      if (random() % 50 == 0) in.dir = !in.dir;
      shaper.clock(in);
      const bool first = shaper.outputs().step != ((mode & 4) != 0);
      const bool second = shaper.outputs().dir != ((mode & 8) != 0);
      if ((mode & 3) == 1) {
        if (first && !old_first) ++decoded;
        if (second && !old_second) --decoded;
        ASSERT_FALSE(first && second);
      } else {
        ASSERT_FALSE(first != old_first && second != old_second) << "both edges at once";
        if (first != old_first) decoded += first == second ? ~std::uint32_t{0} : 1U;
        if (second != old_second) decoded += first == second ? 1U : ~std::uint32_t{0};
      }
      ASSERT_EQ(decoded, shaper.outputs().position);
      old_first = first;
      old_second = second;
    }
    EXPECT_NE(decoded, 0U);
  }
}

TEST(StepShaper, StepAtFullPlacesIsAFaultAndAcceptedOnesAreMade) {
  StepShaper shaper;
  StepShaper::Inputs in = times(50, 50, 0, 0);
  in.step = true;
  unsigned accepted = 0;
  while (!shaper.outputs().fault) {
    shaper.clock(in);
    ++accepted;
    ASSERT_LT(accepted, 20U);
  }
  --accepted;
  EXPECT_EQ(accepted, StepShaper::kPlaces + 1) << "one under way, and every place taken";
  in.step = false;
  for (int i = 0; i < 2000; ++i) shaper.clock(in);
  EXPECT_EQ(shaper.outputs().position, accepted);
  EXPECT_FALSE(shaper.outputs().fault) << "an event";
}

TEST(StepShaper, WaitingFromOneHoldTickToTheNextIsAFault) {
  for (const bool waits : {false, true}) {
    StepShaper shaper;
    StepShaper::Inputs in = times(waits ? 400 : 20, 0, 0, 0);
    // The second step waits for about 400 clocks, with wait ticks at 10, 110, 210 and 310; all but the first are
    // faults.
    unsigned faults = 0;
    for (unsigned i = 0; i < 1000; ++i) {
      in.step = i < 2;
      in.wait_tick = i % 100 == 10;
      shaper.clock(in);
      faults += shaper.outputs().fault ? 1U : 0U;
    }
    EXPECT_EQ(faults, waits ? 3U : 0U);
    EXPECT_EQ(shaper.outputs().position, 2U);
  }
}

TEST(StepShaper, AdvancingEqualsClocking) {
  std::mt19937 random(5);
  StepShaper clocked;
  StepShaper skipping;
  StepShaper::Inputs in = times(40, 30, 20, 60);
  std::uint64_t skipped = 0;
  for (int n = 0; n < 100'000; ++n) {
    in.step = random() % 80 == 0;
    in.dir = random() % 2 == 0;
    in.wait_tick = random() % 20 == 0;
    clocked.clock(in);
    skipping.clock(in);
    in.step = in.wait_tick = false;
    const std::uint64_t n_idle = std::min<std::uint64_t>(skip::horizon(skipping, in), random() % 100);
    const StepShaper::Outputs before = clocked.outputs();
    skip::advance(skipping, in, n_idle);
    skipped += n_idle;
    for (std::uint64_t i = 0; i < n_idle; ++i) {
      in.wait_tick = clocked.state().waiting == 0 && random() % 2 == 0;
      clocked.clock(in);
      ASSERT_EQ(clocked.outputs().step, before.step);
      ASSERT_EQ(clocked.outputs().busy, before.busy);
    }
    ASSERT_EQ(clocked.outputs().step, skipping.outputs().step);
    ASSERT_EQ(clocked.outputs().dir, skipping.outputs().dir);
    ASSERT_EQ(clocked.outputs().position, skipping.outputs().position);
    ASSERT_EQ(clocked.outputs().busy, skipping.outputs().busy);
    ASSERT_EQ(clocked.outputs().fault, skipping.outputs().fault);
  }
  EXPECT_GT(skipped, 10'000U);
}

}  // namespace
}  // namespace trammel::model
