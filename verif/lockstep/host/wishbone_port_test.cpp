// Lockstep of the Wishbone port, classic or pipelined, between a random master that sometimes gives up and a random
// register file; resets at any clock.
#include "trammel/model/wishbone_port.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using model::WishbonePort;

constexpr bool kPipelined = TRAMMEL_PIPELINED != 0;
constexpr std::uint64_t kComparedSignals = 4;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("wishbone_port", seed), dice_(seed), model_(kPipelined) { reset(); }

  void random_clock(unsigned pace) {
    if (dice_.chance(500)) reset();
    master(pace);
    file();
    drive();
    dut_.clock();
    model_.clock(in_);
    check_.next_cycle();
    compare();
  }

  Checker& check() { return check_; }
  std::uint64_t requests() const { return requests_; }
  std::uint64_t answers() const { return answers_; }
  std::uint64_t given_up() const { return given_up_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive();
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset();
    in_ = {};
    open_ = false;
    wait_ = 0;
    known_ = false;
    check_.next_cycle();
    compare();
  }

  // Classic: STB and its signals are stable until the answer; pipelined: until there is no stall. In both modes some
  // masters give up.
  void master(unsigned pace) {
    const WishbonePort::Outputs& out = model_.outputs();
    if (out.ack || out.err) ++answers_;
    const bool gone = kPipelined ? taken_ : (out.ack || out.err) && in_.stb;
    if (gone && !(kPipelined && dice_.chance(2))) in_.stb = false;
    if (in_.cyc && dice_.chance(60)) {
      given_up_ += in_.stb || open_ ? 1 : 0;
      in_.cyc = dice_.chance(3);  // drops CYC, or only STB
      in_.stb = false;
    }
    if (!in_.stb || gone) {
      if (!in_.stb && dice_.chance(20)) in_.cyc = false;
      if (dice_.chance(pace)) {
        in_.cyc = true;
        in_.stb = true;
      }
      in_.we = dice_.chance(2);
      in_.adr = dice_.draw() & 0xFFF;
      in_.sel = dice_.chance(4) ? static_cast<std::uint8_t>(dice_.below(16)) : WishbonePort::kAllBytes;
      in_.dat = dice_.draw();
      if (dice_.chance(20)) in_.stb = !in_.stb;  // STB without CYC
    }
    taken_ = in_.cyc && in_.stb && !out.stall;
  }

  void file() {
    if (model_.outputs().request) {
      wait_ = 1 + dice_.below(12);
      open_ = true;
      ++requests_;
    }
    in_.ack = wait_ == 1;
    if (in_.ack) open_ = false;
    if (wait_ != 0) --wait_;
    in_.error = dice_.chance(3);
    in_.data = dice_.draw();
    known_ = known_ || in_.ack;
  }

  void drive() {
    dut_->cyc_i = in_.cyc;
    dut_->stb_i = in_.stb;
    dut_->we_i = in_.we;
    dut_->adr_i = static_cast<SData>(in_.adr);
    dut_->sel_i = in_.sel;
    dut_->dat_i = in_.dat;
    using namespace bus::register_answer;
    dut_->answer_i = in_place(kAck, in_.ack) | in_place(kError, in_.error) | in_place(kData, in_.data);
  }

  void compare() {
    const WishbonePort::Outputs& out = model_.outputs();
    check_.compare("ack_o", dut_->ack_o, out.ack);
    check_.compare("err_o", dut_->err_o, out.err);
    check_.compare("stall_o", dut_->stall_o, out.stall);
    using namespace bus::register_access;
    check_.compare("request", get(dut_->access_o, kRequest), out.request);
    if (known_) {
      check_.compare("dat_o", dut_->dat_o, out.dat);
      ++more_;
    }
    // The access is stable from its request to the answer.
    if (!out.request && !open_) return;
    check_.compare("access", dut_->access_o & ~in_place(kRequest, 1),
                   in_place(kWrite, out.write) | in_place(kPartial, out.partial) | in_place(kAddress, out.address) |
                       in_place(kData, out.data) | in_place(kOfSession, 1));
    ++more_;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  WishbonePort model_;
  WishbonePort::Inputs in_;
  bool taken_ = false;  // pipelined: the last STB was accepted
  bool open_ = false;   // the register file has a request to answer
  bool known_ = false;  // dat_o is defined
  std::uint32_t wait_ = 0;
  std::uint64_t requests_ = 0;
  std::uint64_t answers_ = 0;
  std::uint64_t given_up_ = 0;
  std::uint64_t more_ = 0;
};

void random_traffic() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(200'000);
  unsigned pace = 1;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (i % 500 == 0) pace = 1 + dice.below(8);
    bench.random_clock(pace);
  }
  EXPECT_GT(bench.check().cycles(), length);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.requests(), length / 40);
  EXPECT_GT(bench.answers(), length / 50);
  EXPECT_GT(bench.given_up(), length / 500);
}

TEST(WishbonePort, RandomTraffic) { EXPECT_EQ(judge(random_traffic), ""); }

}  // namespace
}  // namespace trammel::lockstep
