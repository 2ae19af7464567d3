// The cases of one cause, reaction and state: goes to the window once, and tries each of its clocks in a child
// process.
#pragma once

#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "in_child.hpp"
#include "stop_judge.hpp"

namespace trammel::test {
// clocks: covers each phase of the scan of the roles, and eight ticks
inline constexpr unsigned kWindow = 128;  // clocks: each phase of the scan of the roles, and of eight ticks

// The results of the cases of one cause and reaction.
struct Tally {
  std::uint64_t cases = 0;
  std::uint64_t stops = 0;
  std::uint64_t compared = 0;  // clocks in which RTL and model were compared
};

inline void choose(StopBench& bench, const Cause& cause, Reaction reaction) {
  const bool ramp = reaction == Reaction::kRamp || reaction == Reaction::kShortRamp;
  // The second cause has a ramp, too.
  bench.write(reg::kStopReaction, (ramp ? cause.fault : 0) | field::kStopReactionDriveFault * (ramp ? 1U : 0U));
  bench.write(reg::kStopCauses,
              reaction == Reaction::kOff ? 0 : field::kStopCausesProbe | field::kStopCausesToolSetter);
  for (unsigned n = 0; n < kWatchedAxes; ++n)
    bench.write(reg::overtravel(n), reaction == Reaction::kShortRamp ? kShortOvertravel : 0xFFFFU);
}

inline void begin(StopBench& bench, const State& state, const Program& program) {
  for (const driver::Command& command : program.commands) {
    if (!bench.send(command)) throw std::logic_error("the program is refused");
  }
  if (state.enter != nullptr) state.enter(bench);
}

// The cases of one cause, reaction and state at the clocks given.
class Window {
 public:
  Window(std::unique_ptr<WatchedCard> card, const Cause& cause, Reaction reaction, const State& state)
      : cause_(cause), reaction_(reaction), state_(state), program_(state.program()), bench_(std::move(card)) {
    bench_.set_up();
    choose(bench_, cause, reaction);
    if (state.prepare != nullptr) state.prepare(bench_);
    if (cause.prepare != nullptr) cause.prepare(bench_);
    const std::uint64_t armed = bench_.now();
    if (cause.of_silence) {
      wait_for_an_input();
      begin_to_wait();
    } else if (cause.timed()) {
      const std::uint64_t way = clocks_to_the_window();
      struck_ = armed + std::get<std::uint64_t>(cause.strike);
      bench_.host.wait(*struck_ - way - kWindow - armed);
      way_ = way;
    } else if (!cause.of_program()) {
      begin(bench_, state, program_);
    }
    bench_.card().settle();
  }

  void judge(unsigned clock, Tally& tally) {
    const std::uint64_t before = bench_.card().compared();
    std::istringstream result(in_child([&] {
      const bool stopped = run(clock);
      bench_.card().settle();
      return std::to_string(stopped ? 1 : 0) + " " + std::to_string(bench_.card().compared() - before);
    }));
    std::uint64_t stopped = 0;
    std::uint64_t compared = 0;
    result >> stopped >> compared;
    ++tally.cases;
    tally.stops += stopped;
    tally.compared += compared;
  }

 private:
  // The program is sent and begins when its input rises, so that no access comes before the judge's first.
  void wait_for_an_input() {
    program_.commands.insert(program_.commands.begin(), driver::WaitInputCommand{kBeginInput, true});
    program_.paths.insert(program_.paths.begin(), kBarrier);
    State sent = state_;
    sent.enter = nullptr;
    begin(bench_, sent, program_);
  }
  void begin_to_wait() {
    const std::uint64_t unit = std::get<std::uint64_t>(cause_.strike);
    struck_ = (bench_.now() / unit + 2) * unit;
    way_ = std::stoull(in_child([&] {
      const std::uint64_t from = bench_.now();
      begin_by_input();
      return std::to_string(bench_.now() - from);
    }));
    bench_.host.wait(*struck_ - way_ - kWindow - bench_.now());
  }
  void begin_by_input() {
    bench_.set_input(kBeginInput, true);
    state_.enter(bench_);
  }

  bool run(unsigned clock) {
    Program program = program_;
    if (cause_.of_program()) {
      std::get<void (*)(Program&, unsigned)>(cause_.strike)(program, clock);
      State sent = state_;
      sent.enter = nullptr;
      begin(bench_, sent, program);
    }
    if (cause_.of_silence) {
      bench_.host.wait(*struck_ - way_ - clock - bench_.now());
      begin_by_input();
    } else if (cause_.timed()) {
      const std::uint64_t sending = *struck_ - way_ - clock;
      bench_.host.wait(sending - bench_.now());
      begin(bench_, state_, program);
    }
    const StopCase of{cause_, reaction_, state_, program, clock};
    return StopJudge(bench_, of, struck_).run();
  }
  std::uint64_t clocks_to_the_window() {
    return std::stoull(in_child([&] {
      const std::uint64_t from = bench_.now();
      begin(bench_, state_, program_);
      return std::to_string(bench_.now() - from);
    }));
  }

  const Cause& cause_;
  Reaction reaction_;
  const State& state_;
  Program program_;
  StopBench bench_;
  std::optional<std::uint64_t> struck_;
  std::uint64_t way_ = 0;
};

}  // namespace trammel::test
