// Lockstep of one block or of the whole card: RTL and golden model are clocked together, and every output and all
// visible state is compared in every cycle. The first difference stops the run with everything needed to repeat it.
// Not thread-safe; one Checker for each run.
#pragma once

#include <verilated.h>

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace trammel::lockstep {

// A difference between RTL and model. what() names block, cycle, signal, both values, seed and the last events.
class Mismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Checker {
 public:
  Checker(std::string block, std::uint64_t seed) : block_(std::move(block)), seed_(seed) {}

  // Keeps the event for the report of a later mismatch; `what` must outlive the Checker (a string literal).
  void event(const char* what, std::uint64_t value = 0) {
    events_[event_count_ % events_.size()] = {cycles_, what, value};
    ++event_count_;
  }

  // Compares one signal in the present cycle; throws Mismatch on a difference.
  template <class Rtl, class Model>
  void compare(const char* signal, Rtl rtl, Model model) {
    ++comparisons_;
    const auto a = static_cast<std::uint64_t>(rtl);
    const auto b = static_cast<std::uint64_t>(model);
    if (a != b) fail(signal, a, b);
  }

  void next_cycle() { ++cycles_; }
  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  struct Event {
    std::uint64_t cycle;
    const char* what;
    std::uint64_t value;
  };
  [[noreturn]] void fail(const char* signal, std::uint64_t rtl, std::uint64_t model) const;

  std::string block_;
  std::uint64_t seed_;
  std::uint64_t cycles_ = 0;
  std::uint64_t comparisons_ = 0;
  std::uint64_t event_count_ = 0;
  std::array<Event, 32> events_{};
};

// Owns a Verilated model and its context. Several live side by side: eval() does not select its context by itself,
// so every evaluation and the destructor make it the thread's current one first.
template <class Dut>
class Simulated {
 public:
  Simulated() : context_(std::make_unique<VerilatedContext>()) {
    Verilated::threadContextp(context_.get());
    dut_ = std::make_unique<Dut>(context_.get());
    dut_->clk_i = 0;
  }
  ~Simulated() {
    Verilated::threadContextp(context_.get());
    dut_->final();
    dut_.reset();
  }
  Simulated(const Simulated&) = delete;
  Simulated& operator=(const Simulated&) = delete;

  Dut* operator->() { return dut_.get(); }
  // One clock period: inputs were set before the call; after it the outputs show the state behind the rising edge.
  void clock() {
    Verilated::threadContextp(context_.get());
    dut_->clk_i = 0;
    dut_->eval();
    dut_->clk_i = 1;
    dut_->eval();
  }
  VerilatedContext& context() { return *context_; }

 private:
  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<Dut> dut_;
};

// The seed of a random scenario: TRAMMEL_SEED from the environment, else `fallback`.
std::uint64_t seed_from_environment(std::uint64_t fallback);

// The judge's own test: in a normal build the scenario must pass and must have compared something; in a build over
// a seeded bug (TRAMMEL_SEEDED_BUG) it must end in a Mismatch. Returns an empty text when the expectation is met.
template <class Scenario>
std::string judge(Scenario&& scenario) {
#ifdef TRAMMEL_SEEDED_BUG
  try {
    scenario();
  } catch (const Mismatch&) {
    return {};
  }
  return "the seeded bug was not caught";
#else
  scenario();
  return {};
#endif
}

}  // namespace trammel::lockstep
