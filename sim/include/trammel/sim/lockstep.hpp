// Lockstep of one block or of the whole card: RTL and golden model get the same inputs, and every output and all
// visible state is compared in every cycle. The first difference stops the run with everything needed to repeat it.
// Not thread-safe; one Checker for each run.
#pragma once

#include <verilated.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace trammel::lockstep {

// A difference between RTL and model. what() names block, cycle, signal, both values, seed and the last events.
class Mismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A signal that differs.
struct Difference {
  const char* signal;
  std::uint64_t rtl;
  std::uint64_t model;
};

// What happened, for the report of a mismatch that is found later.
class EventLog {
 public:
  static constexpr std::size_t kKept = 32;

  // `what` must outlive the log (a string literal).
  void add(std::uint64_t cycle, const char* what, std::uint64_t value) { events_.push_back({cycle, what, value}); }
  std::size_t size() const { return events_.size(); }
  // No mismatch is left to be found up to `cycle`: of the events that are not younger only the last kKept stay.
  void settle(std::uint64_t cycle);
  // The last kKept that are not younger than `cycle`, a line each.
  std::string text(std::uint64_t cycle) const;

 private:
  struct Event {
    std::uint64_t cycle;
    const char* what;
    std::uint64_t value;
  };
  // The end of the events that are not younger than `cycle`.
  std::vector<Event>::const_iterator end_of(std::uint64_t cycle) const;

  std::vector<Event> events_;
};

// Throws the Mismatch of `differences`, all of one cycle. Throws std::logic_error when there are none: RTL and model
// were found to differ, and nobody can say in what.
[[noreturn]] void fail(std::string_view block, std::uint64_t cycle, std::uint64_t seed,
                       const std::vector<Difference>& differences, const std::string& events);

// Adds to the sum of the clocks that the process's Checkers have compared; the test executable prints it at its end.
// From any thread.
void count_compared(std::uint64_t cycles);
std::uint64_t compared();

class Checker {
 public:
  Checker(std::string block, std::uint64_t seed) : block_(std::move(block)), seed_(seed) {}
  ~Checker() { count_compared(cycles_); }
  Checker(const Checker&) = delete;
  Checker& operator=(const Checker&) = delete;

  // Keeps the event for the report of a later mismatch; `what` must outlive the Checker (a string literal).
  void event(const char* what, std::uint64_t value = 0) {
    events_.add(cycles_, what, value);
    if (events_.size() >= 8 * EventLog::kKept) events_.settle(cycles_);
  }

  // Compares one signal in the present cycle; throws Mismatch on a difference.
  template <class Rtl, class Model>
  void compare(const char* signal, Rtl rtl, Model model) {
    ++comparisons_;
    const auto a = static_cast<std::uint64_t>(rtl);
    const auto b = static_cast<std::uint64_t>(model);
    if (a != b) differ(signal, a, b);
  }

  void next_cycle() { ++cycles_; }
  std::uint64_t cycles() const { return cycles_; }
  std::uint64_t comparisons() const { return comparisons_; }

 private:
  [[noreturn]] void differ(const char* signal, std::uint64_t rtl, std::uint64_t model) const;

  std::string block_;
  std::uint64_t seed_;
  std::uint64_t cycles_ = 0;
  std::uint64_t comparisons_ = 0;
  EventLog events_;
};

// The seed that Simulated takes by itself: TRAMMEL_STATE_SEED from the environment, else TRAMMEL_SEED, else 1; brought
// into the range 1 to INT_MAX, since Verilator takes a seed of its own for 0.
int state_seed();

// In place of a seed: all bits begin with 0, as the flip-flops of an FPGA do after configuration.
inline constexpr int kZeros = 0;

// Builds with TRAMMEL_RTL_COVERAGE (cmake/TrammelVerilate.cmake): adds what the context's model counted to the
// process's sums, which are written at its end to FOLDER/TEST.PROCESS.dat. FOLDER is TRAMMEL_RTL_COVERAGE of the
// environment; without it, and in other builds, nothing happens. From any thread.
void count_coverage(VerilatedContext& context);

// rising_edge.hpp; every Verilated copy has its own.
template <class Dut>
void rising_edge(Dut& dut);

// Owns a Verilated model and its context. Several live side by side: eval() does not select its context by itself,
// so every evaluation and the destructor make it the thread's current one first. One thread at a time; not always the
// same.
template <class Dut>
class Simulated {
 public:
  // `seed`: of the random bits with which registers and inputs begin, at least 1; or kZeros.
  explicit Simulated(int seed = state_seed()) : context_(std::make_unique<VerilatedContext>()) {
    select();
    context_->threads(1);                         // else the context starts threads that nothing uses
    context_->randReset(seed == kZeros ? 0 : 2);  // 2: random bits
    context_->randSeed(seed);
    dut_ = std::make_unique<Dut>(context_.get());
    dut_->clk_i = 0;
    dut_->eval();
  }
  ~Simulated() {
    select();
    dut_->final();
    count_coverage(*context_);
    dut_.reset();
  }
  Simulated(const Simulated&) = delete;
  Simulated& operator=(const Simulated&) = delete;

  Dut* operator->() { return dut_.get(); }
  Dut& operator*() { return *dut_; }
  // One clock period: inputs were set before the call; after it the outputs show the state after the rising edge.
  void clock() {
    select();
    rising_edge(*dut_);
  }
  // The same with both edges evaluated, `at_edge` called after each.
  template <class AtEdge>
  void clock_by_both_edges(AtEdge at_edge) {
    select();
    dut_->clk_i = 1;
    dut_->eval();
    at_edge();
    dut_->clk_i = 0;
    dut_->eval();
    at_edge();
  }
  VerilatedContext& context() { return *context_; }

 private:
  // Not in each clock anew: setting it also writes a variable that all threads share.
  void select() {
    if (Verilated::threadContextp() != context_.get()) Verilated::threadContextp(context_.get());
  }

  std::unique_ptr<VerilatedContext> context_;
  std::unique_ptr<Dut> dut_;
};

// The seed of a random scenario: TRAMMEL_SEED from the environment, else `fallback`.
std::uint64_t seed_from_environment(std::uint64_t fallback);

// The length of a random scenario (clocks, commands, whatever it counts): `length`, times TRAMMEL_LONG where the
// environment has it: a factor above 0, at most 10^6; below 1 the scenario is shorter. Throws std::invalid_argument
// when it is something else.
std::uint64_t scaled(std::uint64_t length);

// Runs a scenario of a test executable, which judges either the sound RTL or, called with --seeded-bug, a copy with a
// seeded bug. Over sound RTL the report of a Mismatch is returned, an empty text for none. Over a seeded bug at least
// one of the executable's scenarios must end in a Mismatch (main.cpp asks caught() at the end); those after it are not
// run, and the text is empty.
std::string judge(const std::function<void()>& scenario);
void expect_seeded_bug();
const std::string& caught();  // the report of the seeded bug's mismatch; empty: none

}  // namespace trammel::lockstep
