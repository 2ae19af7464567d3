// Delay from a contact to its pin, against a world that gets the same pulses and is observed in every clock.
#include <gmock/gmock.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "world_card.hpp"

namespace trammel::world {
namespace {

struct PinChange {
  std::uint64_t cycle;
  unsigned input;
  bool level;
};

// The golden model; it records when its inputs are set and how long its accesses take.
class NotingEngine final : public sim::Engine {
 public:
  explicit NotingEngine(std::vector<PinChange>& changes, std::uint64_t& longest)
      : changes_(changes), longest_access_(longest) {}

  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    const std::uint64_t before = cycles();
    const std::size_t made = engine_->transfer(accesses, count);
    longest_access_ = std::max(longest_access_, cycles() - before);
    return made;
  }
  void set_input(unsigned input, bool level) override {
    changes_.push_back({cycles(), input, level});
    engine_->set_input(input, level);
  }
  void sleep(std::chrono::nanoseconds time) override { engine_->sleep(time); }
  bool reports_refusals() const override { return true; }
  void wait(std::uint64_t clocks) override { engine_->wait(clocks); }
  void set_inputs(std::uint32_t levels) override { engine_->set_inputs(levels); }
  void set_emergency_stop(bool pressed) override { engine_->set_emergency_stop(pressed); }
  void reset() override { engine_->reset(); }
  void set_sink(driver::StepSink* sink) override { engine_->set_sink(sink); }
  std::uint64_t cycles() const override { return engine_->cycles(); }
  std::uint32_t step_pins() const override { return engine_->step_pins(); }
  std::optional<std::uint64_t> lockstep_cycles() const override { return std::nullopt; }
  std::uint64_t comparisons() const override { return 0; }
  std::vector<std::int64_t> positions() const override { return engine_->positions(); }

 private:
  std::unique_ptr<sim::Engine> engine_ = model_card();
  std::vector<PinChange>& changes_;
  std::uint64_t& longest_access_;
};

// Changes of the pins in a world that gets `steps`, clock by clock up to `end`.
std::vector<PinChange> contacts(const std::string& world_text, const std::vector<driver::PinStep>& steps,
                                std::uint64_t end) {
  World world(parse_world(world_text, "test world"), kCardClock);
  std::vector<PinChange> changes;
  std::uint32_t levels = world.levels();
  auto step = steps.begin();
  for (std::uint64_t clock = 0; clock <= end; ++clock) {
    for (; step != steps.end() && step->cycle <= clock; ++step) world.pulse(step->cycle, step->axis, step->direction);
    world.run_to(clock);
    for (unsigned input = 0; input < sim::kInputs; ++input) {
      if (((levels ^ world.levels()) >> input & 1U) == 0) continue;
      changes.push_back({clock, input, (world.levels() >> input & 1U) != 0});
    }
    levels = world.levels();
  }
  return changes;
}

// Four switches within the travel of the program, so that many changes fall into accesses.
std::string narrow_world() {
  std::string text = changed_world("above = 300", "above = 3");
  text = changed_world("below = -100", "below = -3", text);
  text = changed_world("above = 300", "above = 2", text);
  return changed_world("input = 2\naxis = \"y\"\nbelow = -100", "input = 2\naxis = \"y\"\nbelow = -2", text);
}

std::string back_and_forth() {
  std::string program;
  for (int n = 0; n < 12; ++n) program += "G1 X4 Y3 F4500\nG1 X-4 Y-3.3\nG1 X-4.2\n";
  return program;
}

TEST(WorldLatency, APinIsAtMostOneAccessBehindItsContact) {
  std::vector<PinChange> at_pins;
  std::uint64_t longest_access = 0;
  WorldCard c(narrow_world(), std::make_unique<NotingEngine>(at_pins, longest_access));
  c.machine.inputs = {};
  ASSERT_EQ(c.end_of(back_and_forth()), "its end");
  at_pins.erase(at_pins.begin(), std::find_if(at_pins.begin(), at_pins.end(), [](auto& p) { return p.cycle != 0; }));
  const auto made = contacts(narrow_world(), c.steps.pins, c.engine.cycles());
  ASSERT_GT(made.size(), 300U);
  std::uint64_t latest = 0;
  std::size_t at_once = 0;
  std::size_t unseen = 0;
  auto pin = at_pins.begin();
  for (const PinChange& change : made) {
    // Two bounces of a contact within one access leave the pin unchanged.
    if (pin == at_pins.end() || pin->input != change.input || pin->level != change.level ||
        pin->cycle > change.cycle + longest_access) {
      ++unseen;
      continue;
    }
    ASSERT_GE(pin->cycle, change.cycle);
    latest = std::max(latest, pin->cycle - change.cycle);
    at_once += pin->cycle == change.cycle ? 1U : 0U;
    ++pin;
  }
  EXPECT_EQ(pin, at_pins.end());
  EXPECT_LE(latest, longest_access);
  EXPECT_LE(longest_access, 500U);
  EXPECT_EQ(unseen % 2, 0U);
  EXPECT_GT(at_once, made.size() / 2);
  RecordProperty("latest_clocks", static_cast<int>(latest));
  RecordProperty("longest_access_clocks", static_cast<int>(longest_access));
  std::printf("%zu changes, %zu in their own clock, %zu hidden in an access; latest %d clocks, longest access %d\n",
              made.size(), at_once, unseen, static_cast<int>(latest), static_cast<int>(longest_access));
}

}  // namespace
}  // namespace trammel::world
