// Data for the page of a run in addition to the motion: inputs by role, causes with their reactions, and deviations
// between carriages and pulses. Not thread-safe.
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

// The cause that ended a run, from the card: its reaction, time and position. Waits for the end of the ramp.
struct StopCause {
  std::string name;      // "LIMIT (X plus)"; without a fault, the reason of the end
  std::string reaction;  // "ramp", "immediate stop", or "end of the run" without a fault
  std::uint64_t cycle = 0;
  std::vector<std::int64_t> position;  // pulses by motor, relative to machine zero
  std::size_t line = 0;                // program line
};
StopCause stop_cause(driver::Card& card, const run::RunError& error, const run::Plan& plan, std::size_t motors);

// Records holds of the feed hold button, with the time of the poll that has seen them (200 polls per second), and the
// number of commands sent.
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

// Records the events of a world for the page of a run.
class WorldRecord final : public world::Watcher {
 public:
  // Construct at clock 0. `sink` and `world` must outlive this object; the sink must already contain the page's head.
  WorldRecord(run::TextSink& sink, world::World& world);
  ~WorldRecord() override;
  WorldRecord(const WorldRecord&) = delete;
  WorldRecord& operator=(const WorldRecord&) = delete;

  void pins_changed(const world::World& world) override;
  void moved(const world::World& world) override;
  void finish();

  std::uint64_t levels_at_begin() const { return begin_; }
  const std::vector<world::World::ContactState>& contacts_at_begin() const { return contacts_; }
  // By axis of the world: the clock at which a carriage was first a whole field away from its pulses, and the distance.
  struct Parting {
    std::optional<std::uint64_t> began;
    std::int64_t most = 0;  // largest number of lost pulses
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
