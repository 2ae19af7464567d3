// The axis's golden model: both sources of steps end in the position, and the path's step list is the generator's.
#include "trammel/model/axis.hpp"

#include <gtest/gtest.h>

namespace trammel::model {
namespace {

Axis::Inputs settings() {
  Axis::Inputs in;
  in.shaper.step_length = 2;
  in.shaper.step_space = 1;
  return in;
}

void begin(Axis& axis, std::int64_t increment) {
  Axis::Inputs in = settings();
  in.generator.load_increment = true;
  for (int i = 0; i < 3; ++i) {
    in.generator.word = static_cast<std::uint16_t>(static_cast<std::uint64_t>(increment) >> (16 * i));
    axis.clock(in);
  }
  in.generator.load_increment = false;
  in.generator.swap = true;
  in.generator.active = true;
  axis.clock(in);
}

TEST(Axis, LineReachesThePosition) {
  for (const bool back : {false, true}) {
    Axis axis;
    const std::int64_t increment = std::int64_t{1} << 36;  // a pulse in 16 ticks
    begin(axis, back ? -increment : increment);
    Axis::Inputs in = settings();
    in.generator.tick = true;
    std::uint32_t path = 0;
    for (int k = 0; k < 1600 + 20; ++k) {
      if (k == 1600) in.generator.tick = false;
      axis.clock(in);
      if (axis.outputs().path_step) path += axis.outputs().path_dir ? ~std::uint32_t{0} : 1U;
    }
    EXPECT_EQ(path, back ? ~std::uint32_t{99} : 100U);
    EXPECT_EQ(axis.outputs().shaper.position, path);
    EXPECT_FALSE(axis.outputs().shaper.fault);
    EXPECT_TRUE(axis.quiet());
  }
}

TEST(Axis, ExternalStepsPassOneClockLater) {
  Axis axis;
  Axis::Inputs in = settings();
  in.ext_step = true;
  in.ext_dir = true;
  axis.clock(in);
  EXPECT_TRUE(axis.outputs().path_step);
  EXPECT_TRUE(axis.outputs().path_dir);
  EXPECT_FALSE(axis.quiet());
  in.ext_step = false;
  in.ext_dir = false;
  for (int i = 0; i < 30; ++i) {
    axis.clock(in);
    EXPECT_FALSE(axis.outputs().path_step);
    EXPECT_TRUE(axis.outputs().path_dir) << "held between steps";
  }
  EXPECT_EQ(axis.outputs().shaper.position, ~std::uint32_t{0});
}

TEST(Axis, StepEveryClockIsAFault) {
  Axis axis;
  begin(axis, static_cast<std::int64_t>(PulseGenerator::kOne));
  Axis::Inputs in = settings();
  in.generator.tick = true;
  for (int i = 0; i < 50; ++i) axis.clock(in);
  EXPECT_TRUE(axis.outputs().shaper.fault);
}

}  // namespace
}  // namespace trammel::model
