// The golden model of the pulse generator against the closed form x_k = floor(1/2 + k * increment / 2^40).
#include "trammel/model/pulse_generator.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include "trammel/skip/axis.hpp"

namespace trammel::model {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t kPulseLength = std::int64_t{1} << 40;

struct Line {
  std::int64_t increment;
  bool counted = false;
  bool mirror = false;
};

void begin(PulseGenerator& generator, const Line& line, std::uint32_t count = 0) {
  PulseGenerator::Inputs in;
  in.load_increment = true;
  for (int i = 0; i < 3; ++i) {
    in.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(line.increment) >> (16 * i));
    generator.clock(in);
  }
  in = {};
  in.load_count = true;
  for (int i = 0; i < 2; ++i) {
    in.word = static_cast<std::uint16_t>(count >> (16 * i));
    generator.clock(in);
  }
  in = {};
  in.swap = true;
  in.active = true;
  in.counted = line.counted;
  in.mirror = line.mirror;
  generator.clock(in);
  for (int i = 0; i < 3; ++i) generator.clock({});
}

int signed_step(const PulseGenerator& generator) {
  const auto& out = generator.outputs();
  if (!out.step) return 0;
  return out.dir ? -1 : 1;
}

// Passes one tick through the pipeline; returns its signed step and checks that the step appears in the right clock
// only.
int tick(PulseGenerator& generator) {
  PulseGenerator::Inputs in;
  in.tick = true;
  generator.clock(in);
  EXPECT_FALSE(generator.outputs().step);
  generator.clock({});
  EXPECT_FALSE(generator.outputs().step);
  generator.clock({});
  const int step = signed_step(generator);
  generator.clock({});
  EXPECT_FALSE(generator.outputs().step) << "a step lasts one clock";
  return step;
}

std::int64_t closed_form(std::int64_t k, std::int64_t increment) {
  return static_cast<std::int64_t>((static_cast<Wide>(k) * increment + kPulseLength / 2) >> 40);
}

// round(p * 2^40 / L), half away from zero; 1 <= L < 2^40, |p| <= L.
std::int64_t increment_of(std::int64_t pulses, std::int64_t ticks) {
  const Wide twice = (static_cast<Wide>(std::abs(pulses)) << 41) + ticks;
  const auto magnitude = static_cast<std::int64_t>(twice / (2 * static_cast<Wide>(ticks)));
  return pulses < 0 ? -magnitude : magnitude;
}

TEST(PulseGenerator, StandsAtTheClosedFormAtEveryTick) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 300; ++n) {
    const auto magnitude = static_cast<std::int64_t>(random() >> 24) >> (n % 30);
    const std::int64_t increment = n == 0   ? kPulseLength
                                   : n == 1 ? -kPulseLength
                                            : (n % 2 != 0 ? -magnitude : magnitude);
    PulseGenerator generator;
    begin(generator, {increment});
    std::int64_t x = 0;
    for (std::int64_t k = 1; k <= 1000; ++k) {
      const bool foretold = skip::PulsesAhead(generator).silent_ticks() == 0;
      const int step = tick(generator);
      x += step;
      ASSERT_EQ(foretold, step != 0);
      ASSERT_EQ(x, closed_form(k, increment)) << "k " << k << " increment " << increment;
    }
  }
}

TEST(PulseGenerator, KeepsTheLineWithinItsBoundAndLandsOnTheEnd) {
  std::mt19937_64 random(2);
  for (int n = 0; n < 200; ++n) {
    const auto ticks = static_cast<std::int64_t>(random() % 2000 + 1);
    const auto pulses = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * ticks + 1)) - ticks;
    PulseGenerator generator;
    begin(generator, {increment_of(pulses, ticks)});
    std::int64_t x = 0;
    for (std::int64_t k = 1; k <= ticks; ++k) {
      x += tick(generator);
      // |x - p k / L| <= 1/2 + k / 2^41, multiplied by 2^41 L.
      const Wide error = static_cast<Wide>(x) * ticks - static_cast<Wide>(pulses) * k;
      ASSERT_LE((error < 0 ? -error : error) << 41, ((Wide{1} << 40) + k) * ticks);
    }
    ASSERT_EQ(x, pulses);
  }
}

TEST(PulseGenerator, LongLinesLandOnTheirEnd) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 30'000; ++n) {
    const std::int64_t ticks = n == 0 ? kPulseLength - 1 : static_cast<std::int64_t>(random() >> (24 + n % 30)) + 1;
    const std::int64_t length = std::min(ticks, kPulseLength - 1);
    // With few pulses the test can jump from step to step, at any length of the line.
    const std::int64_t most = std::min<std::int64_t>(length, 200);
    const auto pulses = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * most + 1)) - most;
    PulseGenerator generator;
    begin(generator, {increment_of(pulses, length)});
    std::int64_t x = 0;
    auto left = static_cast<std::uint64_t>(length);
    for (;;) {
      const std::uint64_t silent = std::min(skip::PulsesAhead(generator).silent_ticks(), left);
      skip::PulsesAhead(generator).silent_ticks(silent);
      left -= silent;
      if (left == 0) break;
      x += skip::PulsesAhead(generator).step_at_once() ? -1 : 1;
      --left;
    }
    ASSERT_EQ(x, pulses) << length;
  }
}

TEST(PulseGenerator, SkippingEqualsTicking) {
  std::mt19937_64 random(4);
  for (int n = 0; n < 300; ++n) {
    const auto magnitude = static_cast<std::int64_t>(random() >> 24) >> (n % 9);
    const Line line{n % 2 != 0 ? -magnitude : magnitude, n % 3 == 0, n % 5 == 0};
    PulseGenerator ticked;
    PulseGenerator skipped;
    begin(ticked, line, 7);
    begin(skipped, line, 7);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(skip::at_rest(skipped));
      const std::uint64_t silent = std::min<std::uint64_t>(skip::PulsesAhead(skipped).silent_ticks(), 600);
      if (i % 2 != 0) skip::PulsesAhead(skipped).silent_ticks(silent);
      for (std::uint64_t k = 0; k < silent; ++k) {
        ASSERT_EQ(tick(ticked), 0);
        if (i % 2 == 0) skip::PulsesAhead(skipped).silent_ticks(1);
      }
      ASSERT_EQ(skip::PulsesAhead(ticked).silent_ticks(), skip::PulsesAhead(skipped).silent_ticks());
      ASSERT_EQ(tick(ticked), tick(skipped));
      ASSERT_EQ(ticked.outputs().live, skipped.outputs().live);
    }
  }
}

// A step that is computed at once and placed in the pipeline appears like a step from a tick.
TEST(PulseGenerator, PlacedStepsShowLikeTickedOnes) {
  std::mt19937_64 random(5);
  for (int n = 0; n < 400; ++n) {
    const auto magnitude = static_cast<std::int64_t>(random() >> 24) | 1 << 20;
    const Line line{n % 2 != 0 ? -magnitude : magnitude, false, n % 5 == 0};
    PulseGenerator ticked;
    begin(ticked, line);
    PulseGenerator placed = ticked;
    const std::uint64_t silent = std::min<std::uint64_t>(skip::PulsesAhead(ticked).silent_ticks(), 5000);
    if (silent == 5000) continue;
    for (std::uint64_t k = 0; k < silent; ++k) ASSERT_EQ(tick(ticked), 0);
    skip::PulsesAhead(placed).silent_ticks(silent);
    PulseGenerator::Inputs in;
    in.tick = true;
    ticked.clock(in);
    const auto ago = static_cast<std::uint64_t>(n % 4);
    for (std::uint64_t k = 0; k < ago; ++k) ticked.clock({});
    skip::PulsesAhead(placed).place_step(ago, skip::PulsesAhead(placed).step_at_once());
    for (int k = 0; k < 200; ++k) {
      ASSERT_EQ(placed.outputs().step, ticked.outputs().step) << "ago " << ago << " clock " << k;
      ASSERT_EQ(placed.outputs().dir, ticked.outputs().dir);
      in.tick = k > 4 && random() % 2 == 0;
      ticked.clock(in);
      placed.clock(in);
    }
  }
}

TEST(PulseGenerator, MirroredLineMakesMirroredSteps) {
  std::mt19937_64 random(6);
  for (int n = 0; n < 300; ++n) {
    // Few significant bits, so that the phase reaches exactly 1/2 and 0.
    const std::int64_t increment = static_cast<std::int64_t>(random() >> 60) << 36 | (n % 2 == 0 ? 0 : n);
    PulseGenerator there;
    PulseGenerator back;
    begin(there, {increment, false, true});
    begin(back, {-increment, false, true});
    for (int k = 0; k < 200; ++k) ASSERT_EQ(tick(there), -tick(back)) << "increment " << increment << " tick " << k;
  }
}

TEST(PulseGenerator, CountEndsTheLine) {
  for (const std::uint32_t count : {0U, 1U, 2U, 3U, 17U, 65'537U}) {
    PulseGenerator generator;
    begin(generator, {kPulseLength, true}, count);
    EXPECT_EQ(generator.outputs().live, count != 0);
    PulseGenerator::Inputs in;
    in.tick = true;
    std::uint32_t steps = 0;
    for (std::uint32_t i = 0; i < count + 10U; ++i) {
      generator.clock(in);
      steps += generator.outputs().step ? 1U : 0U;
      ASSERT_EQ(generator.outputs().live, steps < count);
    }
    EXPECT_EQ(steps, count);
    EXPECT_EQ(skip::PulsesAhead(generator).silent_ticks(), UINT64_MAX);
  }
}

TEST(PulseGenerator, SwapIsSeamless) {
  PulseGenerator generator;
  begin(generator, {kPulseLength});
  PulseGenerator::Inputs in;
  in.load_increment = true;
  in.tick = true;
  const std::uint64_t next = static_cast<std::uint64_t>(-kPulseLength);
  int x = 0;
  for (int i = 0; i < 3; ++i) {
    in.word = static_cast<std::uint16_t>(next >> (16 * i));
    generator.clock(in);
    x += signed_step(generator);
  }
  in = {};
  in.tick = true;
  in.swap = true;
  in.active = true;
  generator.clock(in);  // the fourth and last tick of the old line
  x += signed_step(generator);
  in.swap = false;
  for (int i = 0; i < 2; ++i) {
    generator.clock(in);
    x += signed_step(generator);
  }
  EXPECT_EQ(x, 4);
  generator.clock(in);
  EXPECT_EQ(signed_step(generator), -1) << "the first tick after the swap is the new line's";
}

TEST(PulseGenerator, ClearDropsStepsInFlight) {
  PulseGenerator generator;
  begin(generator, {kPulseLength});
  PulseGenerator::Inputs in;
  in.tick = true;
  generator.clock(in);
  generator.clock(in);
  in.clear = true;
  generator.clock(in);
  in.clear = false;
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(generator.outputs().step);
    generator.clock(in);
  }
}

// Lines 1 to 8 of the second paper: v = 5000 lines per second at 10 MHz, one start, 2000 clocks.
TEST(PulseGenerator, OneShotLinesOfThePaper) {
  struct Case {
    std::array<int, 4> ends;
    double largest;  // perpendicular distance, pulses
  };
  const std::array<Case, 8> cases{{{{0, 0, 20, 40}, 0.447},
                                   {{10, 10, 40, 20}, 0.316},
                                   {{10, -10, 40, -20}, 0.316},
                                   {{-10, 10, -40, 20}, 0.316},
                                   {{-10, -10, -40, -40}, 0},
                                   {{-10, -5, 30, 20}, 0.636},
                                   {{7, -2, -32, -38}, 0.678},
                                   {{-10, 20, 30, 20}, 0}}};
  constexpr std::int64_t kClocks = 10'000'000 / 5000;
  for (const Case& c : cases) {
    const std::int64_t dx = c.ends[2] - c.ends[0];
    const std::int64_t dy = c.ends[3] - c.ends[1];
    PulseGenerator generator_x;
    PulseGenerator generator_y;
    begin(generator_x, {increment_of(dx, kClocks), true, true}, static_cast<std::uint32_t>(std::abs(dx)));
    begin(generator_y, {increment_of(dy, kClocks), true, true}, static_cast<std::uint32_t>(std::abs(dy)));
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t worst = 0;
    for (int k = 0; k < kClocks; ++k) {
      x += tick(generator_x);
      y += tick(generator_y);
      worst = std::max(worst, std::abs(x * dy - y * dx));
    }
    EXPECT_EQ(x, dx);
    EXPECT_EQ(y, dy);
    EXPECT_FALSE(generator_x.outputs().live || generator_y.outputs().live);
    EXPECT_NEAR(static_cast<double>(worst) / std::hypot(dx, dy), c.largest, 0.0005);
  }
}

}  // namespace
}  // namespace trammel::model
