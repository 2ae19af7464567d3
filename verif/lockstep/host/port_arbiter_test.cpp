// Lockstep of the port arbiter with 2 to 4 ports that make requests at random, and a core that answers at random;
// resets at any clock. The access is compared during a request, the answer of each port in every cycle.
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
constexpr std::uint64_t kComparedSignals = 1 + 3 * kPorts;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : check_("port_arbiter", seed), dice_(seed), model_(kPorts) { reset(); }

  // A port makes a new request at the earliest in the clock after its answer; the core answers at a random time.
  void random_clock(unsigned ask_every, unsigned answer_every) {
    for (unsigned port = 0; port < kPorts; ++port) {
      PortArbiter::Access& access = accesses_[port];
      access.request = !waiting_[port] && dice_.chance(ask_every);
      if (!access.request) continue;
      waiting_[port] = true;
      access = {true,         dice_.chance(2), dice_.chance(4), dice_.draw() & 0xFFF,
                dice_.draw(), dice_.chance(2), dice_.chance(2)};
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
    using namespace bus::register_answer;
    dut_->answer_i = in_place(kAck, ack) | in_place(kError, dice_.chance(2)) | in_place(kData, dice_.draw());
  }

  void drive() {
    using namespace bus::register_access;
    for (unsigned port = 0; port < kPorts; ++port) {
      const PortArbiter::Access& a = accesses_[port];
      const auto set = [this, port](const bus::Field& field, std::uint64_t value) {
        put(dut_->access_i, up(field, kWidth * port), value);
      };
      set(kRequest, a.request);
      set(kPort, 0);
      set(kWrite, a.write);
      set(kPartial, a.partial);
      set(kAddress, a.address);
      set(kData, a.data);
      set(kOfSession, a.of_session);
      set(kNewSession, a.new_session);
    }
  }

  void compare(const PortArbiter::Inner& inner, bool ack) {
    check_.next_cycle();
    using namespace bus::register_access;
    namespace answer = bus::register_answer;
    check_.compare("request", get(dut_->access_o, kRequest), inner.access.request);
    for (unsigned port = 0; port < kPorts; ++port) {
      const auto answered = [this, port](const bus::Field& field) {
        return get(dut_->answer_o, up(field, answer::kWidth * port));
      };
      check_.compare("ack", answered(answer::kAck), ack && port == inner.port);
      check_.compare("error", answered(answer::kError), get(dut_->answer_i, answer::kError));
      check_.compare("data", answered(answer::kData), get(dut_->answer_i, answer::kData));
    }
    // The access is stable from its request to the answer.
    if (!asked_) return;
    const PortArbiter::Access& a = accesses_[inner.port];
    check_.compare("access", dut_->access_o & ~in_place(kRequest, 1),
                   in_place(kPort, inner.port) | in_place(kWrite, a.write) | in_place(kPartial, a.partial) |
                       in_place(kAddress, a.address) | in_place(kData, a.data) | in_place(kOfSession, a.of_session) |
                       in_place(kNewSession, a.new_session));
    ++more_;
  }

  Simulated<Vdut> dut_;
  Checker check_;
  Dice dice_;
  PortArbiter model_;
  PortArbiter::Accesses accesses_{};
  bool waiting_[PortArbiter::kMaxPorts] = {};
  bool asked_ = false;  // the core has a request to answer
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
