// A planner module in the test's own memory, its path server, and a card on the model engine in simulated time.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "steps.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/linuxcnc/path_server.hpp"
#include "trammel/sim/timed_bus.hpp"

namespace trammel::linuxcnc {

inline constexpr std::uint32_t kPathClock = 200'000;
inline constexpr double kPathPulses = 80;  // pulses per mm

// Builds the operations that LinuxCNC hands to its planner.
class Operations {
 public:
  Operations& line(int motion, const Pose& end, double speed = 0) {
    trammel_operation& operation = add(TRAMMEL_LINE, motion, end);
    operation.speed = speed;
    return *this;
  }
  Operations& rapid(const Pose& end) { return line(1, end, 150); }
  Operations& feed(const Pose& end, double speed) { return line(2, end, speed); }
  Operations& probe(const Pose& end, double speed) { return line(5, end, speed); }
  // `normal`: index of the axis perpendicular to the plane.
  Operations& arc(const Pose& end, const std::array<double, 3>& centre, std::size_t normal, int turns, double speed) {
    trammel_operation& operation = add(TRAMMEL_ARC, 3, end);
    std::copy(centre.begin(), centre.end(), operation.centre);
    operation.normal[normal] = 1;
    operation.turns = turns;
    operation.speed = speed;
    return *this;
  }
  Operations& control(std::uint32_t blending, double tolerance = 0) {
    blending_ = blending;
    tolerance_ = tolerance;
    return *this;
  }
  Operations& command(std::uint32_t kind, const Pose& end = {}) {
    trammel_operation operation{};
    operation.kind = kind;
    std::copy(end.begin(), end.end(), operation.end);
    all.push_back(operation);
    return *this;
  }

  std::vector<trammel_operation> all;
  std::uint64_t segments = 0;

 private:
  trammel_operation& add(std::uint32_t kind, int motion, const Pose& end) {
    trammel_operation operation{};
    operation.kind = kind;
    operation.motion = motion;
    operation.segment = ++segments;
    operation.id = static_cast<std::int32_t>(segments);
    operation.blending = blending_;
    operation.tolerance = tolerance_;
    std::copy(end.begin(), end.end(), operation.end);
    all.push_back(operation);
    return all.back();
  }

  std::uint32_t blending_ = TRAMMEL_BLEND;
  double tolerance_ = 0;
};

class PathBench {
 public:
  explicit PathBench(const machine::Machine& of = machine::default_machine(), PathUnits units = PathUnits::kMillimetres)
      : machine(of), server(*region, card, path_bus, machine, units) {
    engine->set_sink(&steps);
  }

  // Writes an operation into the ring, as the module does in a servo period.
  void post(const trammel_operation& operation) {
    const std::uint64_t head = region->operation_head;
    if (head - region->operation_tail == TRAMMEL_OPERATIONS) throw std::logic_error("the ring is full");
    region->operations[head % TRAMMEL_OPERATIONS] = operation;
    region->operation_head = head + 1;
  }
  void post(std::uint32_t kind, const Pose& end = {}) { post(Operations().command(kind, end).all.front()); }
  void scales(double feed, double rapid) {
    region->path_settings = {++beats_, feed, rapid};
    region->path_settings_sequence += 2;
  }
  double seconds() const { return static_cast<double>(engine->cycles()) / kPathClock; }

  // Hands over one operation per period, except while stalled. Ends when all operations are done and the card is at
  // rest.
  using Period = std::function<void(unsigned)>;
  void run(const std::vector<trammel_operation>& operations, const Period& each = {}) {
    std::size_t given = 0;
    unsigned period = 0;
    server.serve([&] {
      status = {};
      server.write_status(status);
      if (each) each(period);
      if (given < operations.size() && !stalled) post(operations[given++]);
      if (++period > 200'000) throw std::logic_error("it does not end");
      return given < operations.size() || (status.flags & TRAMMEL_STATUS_AT_REST) == 0 ||
             status.operations_done != region->operation_head;
    });
    under_runs = card.parts().registers.read(card_map::reg::kUnderruns);
  }

  machine::Machine machine;
  std::unique_ptr<trammel_region> region = std::make_unique<trammel_region>();
  std::unique_ptr<sim::Engine> engine = sim::make_model_engine(sim::EngineOptions{4, kPathClock, false});
  sim::TimedBus bus{*engine, kPathClock, 1e9};
  run::AttentiveBus path_bus{bus, kServoPeriod};
  driver::Card card = driver::Card::open(path_bus);
  PathServer server;
  test::Steps steps;
  trammel_status status{};
  bool stalled = false;
  std::uint32_t under_runs = 0;  // number of under-run holds when the last run ended

 private:
  std::uint64_t beats_ = 0;
};

inline Operations long_way() {
  Operations operations;
  for (int n = 0; n < 16; ++n) operations.feed({n % 2 == 0 ? 8.0 : 0.0, (n + 1) * 0.5}, 40);
  return operations;
}

inline std::vector<std::pair<unsigned, int>> path_of(const test::Steps& steps) {
  std::vector<std::pair<unsigned, int>> path;
  for (const driver::PathStep& step : steps.path) path.emplace_back(step.axis, step.direction);
  return path;
}

// The path of the same program, from its text by the runner.
inline std::vector<std::pair<unsigned, int>> runner_path(const std::string& text, const machine::Machine& machine) {
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, kPathClock, false});
  sim::TimedBus bus(*engine, kPathClock, 1e9);
  driver::Card card = driver::Card::open(bus);
  test::Steps steps;
  engine->set_sink(&steps);
  run::Runner runner([&] { return std::make_unique<gcode::TextLines>(text, "p.ngc"); }, machine,
                     planner::limits_of(card.identification()));
  runner.plan();
  runner.run(card);
  return path_of(steps);
}

}  // namespace trammel::linuxcnc
