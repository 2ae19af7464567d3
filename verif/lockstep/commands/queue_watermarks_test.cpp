// Lockstep of the queues' watermarks: rooms and watermarks close to each other; both outputs in every cycle.
#include "trammel/model/queue_watermarks.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr std::uint32_t kGeometryDepth = TRAMMEL_GEOMETRY_DEPTH;
constexpr std::uint32_t kFeedDepth = TRAMMEL_FEED_DEPTH;
constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("queue_watermarks", seed) { reset(); }

  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::QueueWatermarks(kGeometryDepth, kFeedDepth);
    compare();
  }

  void clock(const model::QueueWatermarks::Inputs& in) {
    if (in.setting.set) check_.event("setting", std::uint64_t{in.setting.address} << 32 | in.setting.data);
    dut_->setting_i = wire(in.setting);
    dut_->geometry_room_i = static_cast<std::uint16_t>(in.geometry_room);
    dut_->feed_room_i = static_cast<std::uint16_t>(in.feed_room);
    dut_.clock();
    model_.clock(in);
    compare();
    low_ += model_.outputs().geometry_low ? 1U : 0U;
    low_ += model_.outputs().feed_low ? 1U : 0U;
  }

  Checker& check() { return check_; }
  std::uint64_t low() const { return low_; }

 private:
  void compare() {
    check_.next_cycle();
    check_.compare("geometry low", dut_->geometry_low_o, model_.outputs().geometry_low);
    check_.compare("feed low", dut_->feed_low_o, model_.outputs().feed_low);
  }

  Simulated<Vdut> dut_;
  model::QueueWatermarks model_{kGeometryDepth, kFeedDepth};
  Checker check_;
  std::uint64_t low_ = 0;  // number of outputs that were low
};

void random_rooms() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(300'000);
  std::uint32_t marks[2] = {0, 0};
  for (std::uint64_t i = 0; i < length; ++i) {
    if (dice.chance(1000)) {
      bench.reset();
      marks[0] = marks[1] = 0;
      continue;
    }
    model::QueueWatermarks::Inputs in;
    // Half of them next to the watermark.
    const auto room = [&](std::uint32_t depth, std::uint32_t mark) {
      if (dice.chance(2)) return dice.below(depth + 1);
      const std::uint32_t queued = mark + dice.below(3) - 1;
      return queued > depth ? depth * dice.below(2) : depth - queued;
    };
    in.geometry_room = room(kGeometryDepth, marks[0]);
    in.feed_room = room(kFeedDepth, marks[1]);
    if (dice.chance(20)) {
      const unsigned which = dice.below(3);
      constexpr std::uint32_t kAddresses[] = {reg::kGeometryWatermark, reg::kFeedWatermark, reg::kStopReaction};
      const std::uint32_t depth = which == 0 ? kGeometryDepth : kFeedDepth;
      const std::uint32_t value = dice.chance(4) ? 0xFFFF - dice.below(3) : dice.below(depth + 3);
      in.setting = {!dice.chance(5), kAddresses[which], value | (which == 2 ? dice.draw() : 0)};
      if (in.setting.set && which < 2) marks[which] = value;
    }
    bench.clock(in);
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * bench.check().cycles());
  EXPECT_GT(bench.check().cycles(), length);
  EXPECT_GT(bench.low(), length / 4);
  EXPECT_LT(bench.low(), length * 7 / 4);
}

TEST(QueueWatermarks, RandomRooms) { EXPECT_EQ(judge(random_rooms), ""); }

}  // namespace
}  // namespace trammel::lockstep
