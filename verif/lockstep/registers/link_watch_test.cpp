// Lockstep of the watch over the writing session's link: random accesses of several ports and sessions, accepted and
// refused answers, settings, and units of time; every output in every cycle.
#include "trammel/model/link_watch.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "../wires.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {
namespace {

namespace reg = card_map::reg;

constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  using Inputs = model::LinkWatch::Inputs;

  explicit Bench(std::uint64_t seed) : check_("link_watch", seed) { reset(); }

  void reset() {
    check_.event("reset");
    unit_ = false;
    dut_->rst_i = 1;
    apply({});
    dut_.clock();
    dut_->rst_i = 0;
    model_ = {};
    compare();
  }

  void clock(const Inputs& in) {
    if (in.ack) check_.event("access answered: address, port, error, write, of a session, of a new one", event(in));
    if (in.unit) check_.event("unit");
    unit_ = unit_ != in.unit;
    apply(in);
    dut_.clock();
    const bool lost = model_.lost();
    model_.clock(in);
    compare();
    losses_ += model_.lost() && !lost ? 1U : 0U;
    gone_ += model_.gone() ? 1U : 0U;
  }

  Checker& check() { return check_; }
  std::uint64_t losses() const { return losses_; }
  std::uint64_t gone() const { return gone_; }

 private:
  static std::uint64_t event(const Inputs& in) {
    return std::uint64_t{in.address} << 16 | std::uint64_t{in.port} << 8 | (in.error ? 8U : 0U) | (in.write ? 4U : 0U) |
           (in.of_session ? 2U : 0U) | (in.new_session ? 1U : 0U);
  }

  void apply(const Inputs& in) {
    using namespace bus::register_access;
    dut_->setting_i = wire(in.setting);
    dut_->access_i = in_place(kWrite, in.write) | in_place(kAddress, in.address) | in_place(kPort, in.port) |
                     in_place(kOfSession, in.of_session) | in_place(kNewSession, in.new_session);
    dut_->answer_i = in_place(bus::register_answer::kAck, in.ack) | in_place(bus::register_answer::kError, in.error);
    dut_->unit_i = unit_;
  }

  void compare() {
    check_.next_cycle();
    check_.compare("gone_o", dut_->gone_o, model_.gone());
    check_.compare("lost_o", dut_->lost_o, model_.lost());
  }

  Simulated<Vdut> dut_;
  model::LinkWatch model_;
  Checker check_;
  bool unit_ = false;
  std::uint64_t losses_ = 0;
  std::uint64_t gone_ = 0;
};

void random_accesses() {
  const std::uint64_t seed = seed_from_environment(20261128);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(400'000);
  for (std::uint64_t i = 0; i < length; ++i) {
    Bench::Inputs in;
    in.ack = dice.chance(6);
    in.error = in.ack && dice.chance(6);
    in.write = dice.chance(2);
    in.port = static_cast<std::uint8_t>(dice.chance(3) ? dice.below(4) : 1);
    in.address = dice.chance(20) ? reg::kStream : dice.chance(3) ? reg::kLinkTimeout : reg::kStatus;
    in.of_session = !dice.chance(5);
    in.new_session = in.of_session && dice.chance(20);
    in.setting.address = dice.chance(2) ? in.address : reg::kWatchdog;
    // A setting in the clock of its answer.
    const bool sets = in.ack && !in.error && in.write && in.of_session && in.address == reg::kLinkTimeout;
    if (sets && dice.chance(8)) in.setting = {true, reg::kLinkTimeout, dice.chance(3) ? 0 : dice.below(4)};
    if (!sets && dice.chance(20)) in.setting = {true, reg::kWatchdog, dice.below(4)};
    in.unit = dice.chance(9);
    if (dice.chance(3'000))
      bench.reset();
    else
      bench.clock(in);
  }
  EXPECT_EQ(bench.check().comparisons(), kComparedSignals * (length + 1));
  EXPECT_GT(bench.losses(), length / 5'000);
  EXPECT_GT(bench.gone(), length / 20);
}

TEST(LinkWatch, RandomAccesses) { EXPECT_EQ(judge(random_accesses), ""); }

}  // namespace
}  // namespace trammel::lockstep
