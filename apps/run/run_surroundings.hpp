// What the page of a run says beside the motion: inputs by role, causes with their reactions, and where carriages and
// pulses part. Not thread-safe.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "trammel/machine/machine.hpp"
#include "trammel/report/surroundings.hpp"
#include "trammel/run/observer.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/simulation/simulated_run.hpp"
#include "trammel/world/world.hpp"

namespace trammel::app {

// Of a run that a cause has ended, from the card: the cause, its reaction, time and place. Waits for its ramp's end.
struct StopCause {
  std::string name;      // "LIMIT (axis 0 plus)"; of a run that ended without a fault why it did
  std::string reaction;  // "ramp", "immediate stop", or "end of the run" without a fault
  std::uint64_t cycle = 0;
  std::vector<std::int64_t> position;  // pulses by motor, from machine zero on
  std::size_t line = 0;                // of the program
};
StopCause stop_cause(driver::Card& card, const run::RunError& error, const run::Plan& plan, std::size_t motors);

// Holds of the feed hold button, at the look at the card that has seen them (200 a second); and commands sent.
class HoldWatch final : public run::Observer {
 public:
  explicit HoldWatch(const simulation::SimulatedRun& run) : run_(run) {}
  void command(std::uint64_t number, const driver::Command& /*command*/) override { commands_ = number + 1; }
  void progress(const run::Progress& progress) override;

  struct Hold {
    std::uint64_t cycle = 0;
    std::size_t line = 0;
    std::optional<std::uint64_t> until;
  };
  const std::vector<Hold>& holds() const { return holds_; }
  std::uint64_t commands() const { return commands_; }

 private:
  const simulation::SimulatedRun& run_;
  std::vector<Hold> holds_;
  std::uint64_t commands_ = 0;
  bool held_ = false;
};

// Listens to a world for the page of a run.
class WorldRecord final : public world::Watcher {
 public:
  // At clock 0. All must outlive it; the sink has the page's head.
  WorldRecord(run::TextSink& sink, world::World& world);
  ~WorldRecord() override;
  WorldRecord(const WorldRecord&) = delete;
  WorldRecord& operator=(const WorldRecord&) = delete;

  void pins_changed(const world::World& world) override;
  void moved(const world::World& world) override;
  void finish();

  std::uint64_t levels_at_begin() const { return begin_; }
  const std::vector<world::World::ContactState>& contacts_at_begin() const { return contacts_; }
  // By axis of the world: the clock at which a carriage first was a whole field away from its pulses, and how far.
  struct Parting {
    std::optional<std::uint64_t> began;
    std::int64_t most = 0;  // pulses lost, the largest
  };
  const std::vector<Parting>& partings() const { return partings_; }

 private:
  world::World& world_;
  std::uint64_t begin_;
  std::vector<world::World::ContactState> contacts_;
  report::Surroundings out_;
  std::vector<Parting> partings_;
};

// Members of the report's JSON: lanes, causes, world (null without one) and stopped (null or the message).
nlohmann::ordered_json surroundings_json(const machine::Machine& machine, const simulation::RunResult& result,
                                         const HoldWatch& holds, const world::World* world, const WorldRecord* record,
                                         const std::optional<StopCause>& cause);

}  // namespace trammel::app
