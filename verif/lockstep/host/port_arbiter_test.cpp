// Lockstep of the port arbiter with 2 to 4 ports that ask at random, and a core that answers at random; resets at any
// clock. The access is compared where a request stands, the answer of each port in every cycle.
#include "trammel/model/port_arbiter.hpp"

#include <Vdut.h>
#include <gtest/gtest.h>

#include <array>

#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {
namespace {

using model::PortArbiter;

constexpr unsigned kPorts = TRAMMEL_PORTS;
constexpr std::uint64_t kComparedSignals = 4;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("port_arbiter", seed), dice_(seed), model_(kPorts) { reset(); }

  // A port asks again at the earliest in the clock after its answer; the core answers when it likes.
  void random_clock(unsigned ask_every, unsigned answer_every) {
    for (unsigned port = 0; port < kPorts; ++port) {
      PortArbiter::Access& access = accesses_[port];
      access.request = !waiting_[port] && dice_.chance(ask_every);
      if (!access.request) continue;
      waiting_[port] = true;
      access = {true, dice_.chance(2), dice_.chance(4), dice_.draw() & 0xFFF, dice_.draw()};
      check_.event("request of port", port);
    }
    drive();
    const PortArbiter::Inner inner = model_.inner(accesses_);
    asked_ = asked_ || inner.access.request;
    const bool ack = asked_ && dice_.chance(answer_every);
    answer(ack);
    dut_->eval();
    compare(inner, ack);
    if (dice_.chance(3000)) return reset();
    dut_.clock();
    model_.clock(accesses_, ack);
    if (!ack) return;
    asked_ = false;
    waiting_[inner.port] = false;
    ++answers_[inner.port];
  }

  Checker& check() { return check_; }
  std::uint64_t answers(unsigned port) const { return answers_[port]; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    drive();
    answer(false);
    dut_.clock();
    dut_->rst_i = 0;
    model_.reset();
    for (unsigned port = 0; port < kPorts; ++port) {
      waiting_[port] = false;
      accesses_[port].request = false;
    }
    asked_ = false;
  }

  void answer(bool ack) {
    dut_->ack_i = ack;
    dut_->error_i = dice_.chance(2);
    dut_->data_i = dice_.draw();
  }

  // {request, write, partial, 0, address, data} of each port.
  void drive() {
    std::array<std::uint32_t, 6> words{};
    for (unsigned port = 0; port < kPorts; ++port) {
      const PortArbiter::Access& a = accesses_[port];
      const std::uint64_t access = std::uint64_t{a.request} << 47 | std::uint64_t{a.write} << 46 |
                                   std::uint64_t{a.partial} << 45 | std::uint64_t{a.address} << 32 | a.data;
      for (unsigned halfword = 0; halfword < 3; ++halfword) {
        const unsigned place = 3 * port + halfword;
        words[place / 2] |= static_cast<std::uint32_t>(access >> (16 * halfword) & 0xFFFF) << (16 * (place % 2));
      }
    }
    for (std::size_t i = 0; i < (48 * kPorts + 31) / 32; ++i) dut_->access_i[i] = words[i];
  }

  void compare(const PortArbiter::Inner& inner, bool ack) {
    check_.next_cycle();
    check_.compare("request_o", dut_->request_o, inner.access.request);
    check_.compare("ack_o", dut_->ack_o, ack ? 1U << inner.port : 0U);
    check_.compare("error_o", dut_->error_o, dut_->error_i);
    check_.compare("data_o", dut_->data_o, dut_->data_i);
    // The access stands from its request to the answer.
    if (!asked_) return;
    const PortArbiter::Access& a = accesses_[inner.port];
    check_.compare("access_o", dut_->access_o,
                   std::uint64_t{inner.port} << 46 | std::uint64_t{a.write} << 45 | std::uint64_t{a.partial} << 44 |
                       std::uint64_t{a.address} << 32 | a.data);
    ++more_;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  PortArbiter model_;
  PortArbiter::Accesses accesses_{};
  bool waiting_[PortArbiter::kMaxPorts] = {};
  bool asked_ = false;  // the core
  std::uint64_t answers_[PortArbiter::kMaxPorts] = {};
  std::uint64_t more_ = 0;
};

void random_ports() {
  const std::uint64_t seed = seed_from_environment(20261113);
  Bench bench(seed);
  Dice dice(seed);
  const std::uint64_t length = scaled(200'000);
  unsigned ask_every = 1;
  unsigned answer_every = 1;
  for (std::uint64_t i = 0; i < length; ++i) {
    if (i % 500 == 0) {
      ask_every = 1 + dice.below(20);
      answer_every = 1 + dice.below(6);
    }
    bench.random_clock(ask_every, answer_every);
  }
  EXPECT_EQ(bench.check().cycles(), length);
  EXPECT_EQ(bench.check().comparisons(), bench.expected());
  for (unsigned port = 0; port < kPorts; ++port) EXPECT_GT(bench.answers(port), length / 100);
}

TEST(PortArbiter, RandomPorts) { EXPECT_EQ(judge(random_ports), ""); }

}  // namespace
}  // namespace trammel::lockstep
