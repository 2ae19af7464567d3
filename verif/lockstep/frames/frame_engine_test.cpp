// Lockstep of the frame engine: requests of every kind, damaged ones and noise; the port and the inner port answer at
// random; new connections and resets at any clock.
#include "trammel/model/frame_engine.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include "byte_ports.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {
namespace {

using model::FrameEngine;

constexpr std::uint64_t kComparedSignals = 2;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("frame_engine", seed), dice_(seed), source_(dice_) { reset(); }

  // `gap`: clocks from byte to byte; `pace`: the port takes a byte in one of this many clocks; `delay`: longest time
  // of an answer.
  void random_clock(unsigned gap, unsigned pace, unsigned delay) {
    const FrameEngine::Outputs& out = model_.outputs();
    // Resets are more frequent while a decision is under way.
    const bool ends = in_.byte_valid && in_.byte == frames::kEnd;
    if (dice_.chance(20000) || (inner_.open() && dice_.chance(3000)) || (ends && dice_.chance(300))) return reset();
    in_.restart = dice_.chance(restart_);
    if (in_.restart) check_.event("restart");
    in_.byte_valid = ++since_byte_ >= gap && (listening() || dice_.chance(200));
    if (in_.byte_valid) {
      since_byte_ = 0;
      in_.byte = source_.next(model_.session().last(), model_.session().epoch());
      check_.event("byte", in_.byte);
    }
    if (in_.byte_valid && in_.byte == frames::kEnd) {
      if (dice_.chance(100)) return reset();
      in_.restart = in_.restart || dice_.chance(100);
    }
    // A new connection after half an escape, followed by a frame from its beginning; and one in the clock in which a
    // reply is decided.
    const bool half = last_byte_ == frames::kEscape && since_byte_ == 1 && dice_.chance(30);
    if (half) source_.clear();
    in_.restart = in_.restart || half || (++since_answer_ == 5 && dice_.chance(60));
    last_byte_ = in_.byte_valid ? in_.byte : last_byte_;
    in_.ready = dice_.chance(pace);
    replies_ += out.valid && in_.ready && out.byte == frames::kEnd ? 1U : 0U;
    if (out.request) {
      ++requests_;
      inner_.ask(1 + dice_.below(delay), dice_.chance(30), dice_.draw());
    }
    const InnerPort::Answer answer = inner_.now();
    in_.ack = answer.ack;
    if (answer.ack) since_answer_ = 0;
    in_.error = answer.ack ? answer.error : dice_.chance(2);
    in_.data = answer.ack ? answer.data : dice_.draw();
    drive();
    dut_.clock();
    model_.clock(in_);
    check_.next_cycle();
    compare();
  }

  void set_restart(unsigned one_in) { restart_ = one_in; }
  // Makes this many connections in sequence, to reach epochs of all bits.
  void reset_and_connect(unsigned count) {
    reset();
    for (unsigned i = 0; i < count; ++i) {
      in_.restart = true;
      drive();
      dut_.clock();
      model_.clock(in_);
      check_.next_cycle();
      compare();
    }
  }

  Checker& check() { return check_; }
  std::uint64_t requests() const { return requests_; }
  std::uint64_t replies() const { return replies_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  bool listening() const { return model_.listening(); }

  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive();
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset();
    inner_.clear();
    source_.clear();
    in_ = {};
    since_byte_ = 0;
  }

  void drive() {
    dut_->restart_i = in_.restart;
    dut_->received_i = in_.byte_valid;
    dut_->byte_i = in_.byte;
    dut_->ready_i = in_.ready;
    using namespace bus::register_answer;
    dut_->answer_i = in_place(kAck, in_.ack) | in_place(kError, in_.error) | in_place(kData, in_.data);
  }

  void compare() {
    const FrameEngine::Outputs& out = model_.outputs();
    check_.compare("valid_o", dut_->valid_o, out.valid);
    using namespace bus::register_access;
    check_.compare("request", get(dut_->access_o, kRequest), out.request);
    if (out.valid) {
      check_.compare("byte_o", dut_->byte_o, out.byte);
      ++more_;
    }
    // The access is stable from its request to the answer; the data of a read may be anything.
    if (!out.request && !inner_.open()) return;
    check_.compare("access, without data", dut_->access_o & ~in_place(kRequest, 1) & ~in_place(kData, ~0U),
                   in_place(kWrite, out.write) | in_place(kAddress, out.address) |
                       in_place(kOfSession, out.of_session) | in_place(kNewSession, out.new_session));
    ++more_;
    if (!out.write) return;
    check_.compare("access, data", get(dut_->access_o, kData), out.data);
    ++more_;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  FrameEngine model_;
  FrameEngine::Inputs in_;
  InnerPort inner_;
  FrameSource source_;
  unsigned since_byte_ = 0;
  unsigned since_answer_ = 0;
  std::uint8_t last_byte_ = 0;
  unsigned restart_ = 5000;  // one in this many clocks
  std::uint64_t requests_ = 0;
  std::uint64_t replies_ = 0;
  std::uint64_t more_ = 0;
};

void random_traffic() {
  const std::uint64_t seed = seed_from_environment(20261122);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(6'000'000);
  unsigned gap = 10;
  unsigned pace = 1;
  unsigned delay = 1;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (i % 5000 == 0) {
      gap = 10 + (dice.chance(2) ? 0 : dice.below(30));
      pace = 1 + dice.below(6);
      delay = 1 + dice.below(20);
      bench.set_restart(dice.chance(4) ? 200 : 5000);
      if (dice.chance(20)) bench.reset_and_connect(dice.below(1U << dice.below(17)));
    }
    bench.random_clock(gap, pace, delay);
  }
  EXPECT_GT(bench.check().cycles(), length * 99 / 100);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  EXPECT_GT(bench.requests(), length / 250);
  EXPECT_GT(bench.replies(), length / 2500);
}

TEST(FrameEngine, RandomTraffic) { EXPECT_EQ(judge(random_traffic), ""); }

}  // namespace
}  // namespace trammel::lockstep
