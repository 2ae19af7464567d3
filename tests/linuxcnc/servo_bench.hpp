// LinuxCNC's side and a card in one thread and in simulated time: a component that writes periods into the shared
// memory, the bridge, and the golden model, whose steps are compared with the commanded targets.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/linuxcnc/bridge.hpp"
#include "trammel/linuxcnc/refused_paths.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::linuxcnc {

inline constexpr std::uint64_t kServoClocks = 1000;  // clocks per period at 1 MHz
inline constexpr double kFraction = driver::PositionStream::kPulse;

// A temporary folder, removed with the object.
class RegionFolder {
 public:
  RegionFolder() {
    std::string name = "/tmp/trammel-region-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path = name;
  }
  ~RegionFolder() { std::filesystem::remove_all(path); }
  std::string path;
};

inline machine::Machine servo_machine() {
  return machine::parse_machine(machine::default_machine_text() + "[probe]\ninput = 9\n[inputs]\nx_index = 3\n",
                                "servo_machine");
}

// An input that changes to `level` when a motor reaches `pulse`.
struct ServoEdge {
  unsigned input = 0;
  unsigned axis = 0;
  std::int64_t pulse = 0;
  bool level = true;  // from that pulse on
};

class ServoBench : public driver::StepSink, public ServoRecord {
 public:
  using Targets = std::array<double, card_map::kMaxAxes>;  // pulses

  explicit ServoBench(const std::string& name = "test")
      : engine(sim::make_model_engine(model_options())), region(name, folder.path), bus(*engine, kServoPeriod) {
    engine->set_sink(this);
    for (unsigned input = 0; input < sim::kInputs; ++input) engine->set_input(input, false);
    card.emplace(driver::Card::open(bus));
    paths = refuse_paths(region.memory());
    BridgeOptions options;
    options.note = [this](const std::string& text) {
      notes.push_back(text);
      if (std::getenv("TRAMMEL_TELL") != nullptr) std::printf("%lu: %s\n", number, text.c_str());
    };
    options.record = this;
    bridge.emplace(region, *card, bus, servo_machine(), *paths, options);
  }

  // The component's work: writes a period. False if the ring is full.
  bool post(const Targets& targets, std::uint32_t flags = TRAMMEL_PERIOD_ENABLE) {
    trammel_region& memory = region.memory();
    trammel_period period{};
    period.number = ++number;
    period.duration = 1'000'000;
    period.flags = flags;
    for (unsigned n = 0; n < TRAMMEL_JOINTS; ++n) period.target[n] = std::llround(targets[n] * kFraction);
    if (memory.period_head - memory.period_tail >= TRAMMEL_PERIODS) return false;
    memory.periods[memory.period_head % TRAMMEL_PERIODS] = period;
    ++memory.period_head;
    return true;
  }
  // Writes the component's settings.
  void give(const trammel_settings& settings) {
    region.memory().settings = settings;
    region.memory().settings_sequence += 2;
  }
  // Runs the card until the next period. The inputs follow the motors.
  void pass(std::uint64_t clocks = kServoClocks) {
    due += clocks;
    if (engine->cycles() > due) due = engine->cycles();  // the bridge has run the card while it waited
    if (edges.empty() && engine->cycles() < due) engine->wait(due - engine->cycles());
    while (engine->cycles() < due) {
      engine->wait(std::min<std::uint64_t>(10, due - engine->cycles()));
      for (const ServoEdge& edge : edges) {
        const std::int64_t at = engine->positions()[edge.axis];
        if (at >= edge.pulse && !met) met = at;  // inputs do not change while the bridge uses the card
        engine->set_input(edge.input, (at >= edge.pulse) == edge.level);
      }
    }
  }
  void period(const Targets& targets, std::uint32_t flags = TRAMMEL_PERIOD_ENABLE) {
    post(targets, flags);
    bridge->turn(std::chrono::nanoseconds(0));
    pass();
  }
  // Disables and then enables the machine, at rest at these positions.
  void enable(const Targets& at = {}) {
    due = engine->cycles();
    for (int n = 0; n < 3; ++n) period(at, 0);
    // After a stop, the time base needs its ramp to return.
    for (int n = 0; n < 1000 && status().state != TRAMMEL_STREAMING; ++n) period(at);
    for (int n = 0; n < 10; ++n) period(at);
  }
  const trammel_status& status() const { return bridge->status(); }

  void pin_step(const driver::PinStep&) override {}
  void path_step(const driver::PathStep& step) override { steps.push_back(step); }
  void opened(std::uint64_t, const std::array<std::int64_t, card_map::kMaxAxes>& positions) override {
    origin = positions;
    steps.clear();
    lines.clear();
  }
  void line(const trammel_period& period, std::int64_t) override { lines.push_back(period); }
  void closed(std::uint64_t) override {}

  // Largest distance between the end of a line and its target, in pulses. All lines must have ended. The first two
  // commands are lines, and the third is the FEED.
  double farthest() const {
    double most = 0;
    std::array<std::int64_t, card_map::kMaxAxes> position = origin;
    std::size_t step = 0;
    for (std::size_t n = 0; n < lines.size(); ++n) {
      const std::uint64_t command = n < 2 ? n : n + 1;
      for (; step < steps.size() && steps[step].command <= command; ++step) {
        position[steps[step].axis] += steps[step].direction;
      }
      for (unsigned a = 0; a < 3; ++a) {
        const double away = static_cast<double>(position[a]) - static_cast<double>(lines[n].target[a]) / kFraction;
        most = std::max(most, std::abs(away));
      }
    }
    return most;
  }

  static sim::ModelOptions model_options() {
    sim::ModelOptions options;
    options.clock_hz = 1'000'000;
    return options;
  }

  RegionFolder folder;
  std::unique_ptr<sim::Engine> engine;
  Region region;
  run::AttentiveBus bus;
  std::optional<driver::Card> card;
  std::unique_ptr<PathSide> paths;
  std::optional<Bridge> bridge;
  std::vector<ServoEdge> edges;
  std::optional<std::int64_t> met;  // position at which the first edge came
  std::vector<std::string> notes;
  std::uint64_t number = 0;
  std::uint64_t due = 0;
  std::array<std::int64_t, card_map::kMaxAxes> origin{};
  std::vector<driver::PathStep> steps;  // since the stream was opened
  std::vector<trammel_period> lines;    // periods since the stream was opened
};

// Three joints on sines that start and end at rest.
inline ServoBench::Targets servo_sines(int n, int periods) {
  constexpr double kTurn = 6.283185307179586;
  const double share = static_cast<double>(n) / periods;
  const double slow = 0.5 * (1 - std::cos(kTurn / 2 * share));
  return {900.3 * (1 - std::cos(kTurn * 3 * slow)), -700.7 * std::sin(kTurn * 4 * slow), 1234.5 * slow};
}

}  // namespace trammel::linuxcnc
