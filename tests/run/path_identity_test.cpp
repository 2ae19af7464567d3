#include "trammel/run/path_identity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <vector>

#include "clocks.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::run {
namespace {

std::string text_of(const std::vector<driver::PathStep>& steps) {
  PathIdentity identity;
  for (const driver::PathStep& step : steps) identity.path_step(step);
  return identity.text();
}

TEST(PathIdentity, EveryWordAndTheOrderCountAndTheTimeDoesNot) {
  const std::string text = text_of({{1, 7, 0, 1, 100}, {1, 9, 2, -1, 120}});
  EXPECT_EQ(text.size(), 16U);
  EXPECT_EQ(text_of({{1, 7, 0, 1, 103}, {1, 9, 2, -1, 177}}), text);
  EXPECT_NE(text_of({{2, 7, 0, 1}, {1, 9, 2, -1}}), text);
  EXPECT_NE(text_of({{1, 8, 0, 1}, {1, 9, 2, -1}}), text);
  EXPECT_NE(text_of({{1, 7, 1, 1}, {1, 9, 2, -1}}), text);
  EXPECT_NE(text_of({{1, 7, 0, -1}, {1, 9, 2, -1}}), text);
  EXPECT_NE(text_of({{1, 9, 2, -1}, {1, 7, 0, 1}}), text);
  EXPECT_NE(text_of({{1, 7, 0, 1}}), text);
}

TEST(ShaperDelay, MeasuresAndJudgesEachPulse) {
  ShaperDelay delay;
  EXPECT_FALSE(delay.range());
  delay.path_step({0, 1, 0, 1, 100});
  delay.path_step({0, 1, 1, -1, 100});
  delay.pin_step({106, 0, 1});
  delay.path_step({0, 2, 0, 1, 107});
  delay.pin_step({120, 0, 1});
  EXPECT_THROW(delay.finish(), std::runtime_error) << "one of axis 1 has not come";
  EXPECT_THROW(delay.pin_step({130, 1, 1}), std::runtime_error) << "the other direction";
  EXPECT_THROW(delay.pin_step({130, 0, 1}), std::runtime_error) << "nobody asked for it";
  delay.pin_step({131, 1, -1});
  delay.finish();
  EXPECT_EQ(delay.range()->least, 6U);
  EXPECT_EQ(delay.range()->most, 31U);
}

// Predicts the pulses at the pins from the path's steps by the shaper's rule (docs/reference/behaviour.md): a pulse
// comes 6 clocks after its step, or later if the pulse before it or the times of the direction require that.
class ShaperRule final : public driver::StepSink {
 public:
  struct Times {
    std::uint64_t length, space, setup, hold;  // clocks
  };
  explicit ShaperRule(const Times& times) : times_(times) {}
  void path_step(const driver::PathStep& step) override {
    Axis& axis = axes_[step.axis];
    std::uint64_t edge = step.cycle + 6;
    const std::uint64_t end = axis.edge + times_.length;
    if (step.direction == axis.direction) {
      if (axis.any) edge = std::max(edge, end + times_.space + 6);
    } else {
      edge += times_.setup + 3;
      if (axis.any) edge = std::max(edge, end + times_.space + times_.hold + times_.setup + 12);
    }
    axis = {edge, step.direction, true};
    expected_[step.axis].push_back({edge, step.axis, step.direction});
  }
  void pin_step(const driver::PinStep& step) override { made_[step.axis].push_back(step); }

  std::size_t differences() const {
    std::size_t count = 0;
    for (std::size_t a = 0; a < expected_.size(); ++a) {
      EXPECT_EQ(expected_[a].size(), made_[a].size()) << "axis " << a;
      for (std::size_t i = 0; i < std::min(expected_[a].size(), made_[a].size()); ++i) {
        const driver::PinStep& e = expected_[a][i];
        const driver::PinStep& m = made_[a][i];
        if (e.cycle == m.cycle && e.direction == m.direction) continue;
        if (count++ == 0) ADD_FAILURE() << "axis " << a << " pulse " << i << ": " << m.cycle << ", not " << e.cycle;
      }
    }
    return count;
  }

 private:
  struct Axis {
    std::uint64_t edge = 0;
    int direction = 1;
    bool any = false;
  };
  Times times_;
  std::array<Axis, card_map::kMaxAxes> axes_{};
  std::array<std::vector<driver::PinStep>, card_map::kMaxAxes> expected_;
  std::array<std::vector<driver::PinStep>, card_map::kMaxAxes> made_;
};

// A program whose lines come slowly: card time passes before each line.
class SlowLines final : public gcode::LineSource {
 public:
  SlowLines(std::unique_ptr<gcode::LineSource> lines, driver::Bus& bus, std::chrono::nanoseconds pause)
      : lines_(std::move(lines)), bus_(bus), pause_(pause) {}
  bool next(std::string_view& line) override {
    bus_.sleep(pause_);
    return lines_->next(line);
  }
  const std::string& name() const override { return lines_->name(); }

 private:
  std::unique_ptr<gcode::LineSource> lines_;
  driver::Bus& bus_;
  std::chrono::nanoseconds pause_;
};

constexpr char kProgram[] =
    "F3000\nG1 X8 Y3\nG2 X12 Y7 I4\nG1 X2 Y9.3 Z1.7\nG3 X2 Y9.3 J-3\nG1 X9\nX3\nX4.1\nX3.99\nX4\nG0 X0 Y0 Z0\nM2\n";

struct Made {
  std::string identity;
  std::uint64_t count;
  std::uint64_t cycles;
};

// Disturbances of one run's timing.
struct Trouble {
  double bytes_per_second = 1e9;
  std::chrono::nanoseconds line_pause{0};
  unsigned holds = 0;
  unsigned overrides = 0;
  unsigned seed = 1;
};

Made run(const Trouble& trouble) {
  constexpr double kSeconds = 2;
  const machine::Machine machine = machine::default_machine();
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, kSlowClock, false});
  sim::TimedBus bus(*engine, kSlowClock, trouble.bytes_per_second);
  std::mt19937_64 random(trouble.seed);
  const auto moment = [&] {
    return static_cast<std::uint64_t>(random() % static_cast<unsigned>(kSeconds * kSlowClock));
  };
  for (unsigned i = 0; i < trouble.holds; ++i) {
    const std::uint64_t at = moment();
    bus.at(at, [](sim::Engine& e) { e.write(card_map::reg::kHold, 1); });
    bus.at(at + kSlowClock / 10, [](sim::Engine& e) { e.write(card_map::reg::kHold, 0); });
  }
  for (unsigned i = 0; i < trouble.overrides; ++i) {
    const auto ratio = static_cast<std::uint32_t>(random() % 60000 + 5000);
    bus.at(moment(), [ratio](sim::Engine& e) { e.write(card_map::reg::kRatioFeed, ratio); });
  }
  driver::Card card = driver::Card::open(bus);
  PathIdentity identity;
  ShaperDelay delay;
  // 2 us and 1 us are one clock each at 400 kHz.
  ShaperRule rule({1, 1, 1, 1});
  StepFork fork;
  fork.add(identity);
  fork.add(delay);
  fork.add(rule);
  engine->set_sink(&fork);
  const auto lines = [&]() -> std::unique_ptr<gcode::LineSource> {
    return std::make_unique<SlowLines>(std::make_unique<gcode::TextLines>(kProgram, "p.ngc"), bus, trouble.line_pause);
  };
  Runner runner(lines, machine, planner::limits_of(card.identification()));
  runner.plan();
  runner.run(card);
  delay.finish();
  EXPECT_EQ(rule.differences(), 0U);
  return {identity.text(), identity.count(), engine->cycles()};
}

TEST(PathIdentity, IsTheSameHeldOverriddenAndStarved) {
  const Made plain = run({});
  ASSERT_GT(plain.count, 4000U);
  const auto expect_same = [&](const char* what, const Trouble& trouble) {
    const Made other = run(trouble);
    EXPECT_EQ(other.identity, plain.identity) << what;
    EXPECT_EQ(other.count, plain.count) << what;
    EXPECT_GT(other.cycles, plain.cycles + plain.cycles / 50) << what << " cost time";
  };
  Trouble slow_bus;
  slow_bus.bytes_per_second = 500;
  expect_same("slow bus", slow_bus);
  Trouble slow_input;
  slow_input.line_pause = std::chrono::milliseconds(400);
  expect_same("slow input", slow_input);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Trouble all;
    all.seed = seed;
    all.holds = all.overrides = 10;
    expect_same("holds and overrides", all);
    all.bytes_per_second = 2000;
    all.line_pause = std::chrono::milliseconds(20);
    expect_same("everything", all);
  }
}

}  // namespace
}  // namespace trammel::run
