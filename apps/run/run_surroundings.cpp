#include "run_surroundings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "common/world_choice.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/roles.hpp"

namespace trammel::app {

namespace {

constexpr unsigned kEmergencyStop = report::Surroundings::kEmergencyStop;

// Time for which a carriage oscillates after the last pulse.
constexpr std::chrono::milliseconds kSwing{50};

std::uint64_t levels_of(const world::World& world) {
  return world.levels() | std::uint64_t{world.emergency_stop()} << kEmergencyStop;
}

}  // namespace

StopCause stop_cause(driver::Card& card, const run::RunError& error, const run::Plan& plan, std::size_t motors) {
  card.wait_until_stopped();
  card.bus().sleep(kSwing);
  const driver::Snapshot now = card.read_snapshot();
  const bool fault = now.faults != 0;
  const driver::Snapshot at = fault ? card.read_stop_snapshot() : now;
  StopCause cause;
  cause.line = error.line();
  cause.cycle = at.time;
  for (std::size_t motor = 0; motor < motors; ++motor) {
    cause.position.push_back(plan.start[motor] + at.position[motor]);
  }
  if (!fault) {
    cause.name = error.what();
    cause.reaction = "end of the run";
    return cause;
  }
  cause.name = card.read_fault_text();
  // The reaction follows from the bits of FAULT. If a ramp was insufficient (for example, an overtravel was exceeded),
  // the card has then stopped at once.
  const bool ramps = (at.faults & ~card.parts().registers.read(card_map::reg::kStopReaction)) == 0;
  cause.reaction = !ramps ? "immediate stop" : card.read_rest().exact() ? "ramp" : "ramp, then immediate stop";
  return cause;
}

void HoldWatch::progress(const run::Progress& progress) {
  const bool held = progress.status.button_hold;
  if (held && !held_) holds_.push_back({run_.cycles(), progress.line, std::nullopt});
  if (!held && held_) holds_.back().until = run_.cycles();
  held_ = held;
}

namespace {

// A quarter of a full step: a smaller difference is the normal lag of a motor.
std::vector<double> least_differences(const world::World& world) {
  std::vector<double> least;
  for (std::size_t n = 0; n < world.axes(); ++n) {
    least.push_back(world.axis(n).carriage.motor.pulses_a_full_step / 4);
  }
  return least;
}

}  // namespace

WorldRecord::WorldRecord(run::TextSink& sink, world::World& world)
    : world_(world),
      begin_(levels_of(world)),
      contacts_(world.contacts()),
      out_(sink, world.clock_hz(), least_differences(world), begin_),
      partings_(world.axes()) {
  world_.set_watcher(this);
}

WorldRecord::~WorldRecord() { world_.set_watcher(nullptr); }

void WorldRecord::pins_changed(const world::World& world) { out_.inputs(world.now(), levels_of(world)); }

void WorldRecord::moved(const world::World& world) {
  for (std::size_t n = 0; n < partings_.size(); ++n) {
    const world::Carriage& carriage = world.carriage(n);
    out_.apart(world.now(), n, static_cast<double>(carriage.commanded()) - carriage.position());
    const std::int64_t lost = carriage.lost();
    if (lost == 0) continue;
    Parting& parting = partings_[n];
    if (!parting.began) parting.began = world.now();
    if (std::abs(lost) > std::abs(parting.most)) parting.most = lost;
  }
}

void WorldRecord::finish() { out_.finish(); }

namespace {

std::string role_text(driver::Role role, const machine::Machine& machine) {
  if (!role.of_an_axis() || role.axis() >= machine.axes.size()) return driver::role_name(role);
  const std::string kind = driver::role_name(role);
  return fmt::format("{} {}", machine.axes[role.axis()].letter, kind.substr(0, kind.find(" of axis")));
}

// Describes one input for the page: its function, the world's contact at it, its level at the beginning, and its active
// level.
class Lanes {
 public:
  // `record`: null without a world.
  Lanes(const machine::Machine& machine, const WorldRecord* record) : machine_(machine) {
    if (record == nullptr) return;
    levels_ = record->levels_at_begin();
    contacts_ = record->contacts_at_begin();
  }
  nlohmann::ordered_json json(const simulation::RunResult& result) const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (unsigned input = 0; input <= kEmergencyStop; ++input) {
      const std::string role = roles(input);
      const world::World::ContactState* const contact = contact_at(input);
      const std::string wired = contact != nullptr ? contact->name : "";
      if (role.empty() && wired.empty() && !is_scripted(result, input)) continue;
      const bool active = active_level(input, contact);
      const bool level = contact == nullptr ? !active : level_at_begin(input);
      const std::string own = input == kEmergencyStop ? "emergency stop" : fmt::format("input {}", input);
      list.push_back({{"input", input},
                      {"name", !role.empty()    ? role
                               : !wired.empty() ? wired
                                                : own},
                      {"detail", wired.empty() ? own : fmt::format("{}, {}", own, wired)},
                      {"level", level ? 1 : 0},
                      {"active", active ? 1 : 0}});
    }
    return list;
  }

 private:
  std::string roles(unsigned input) const {
    if (input == kEmergencyStop) return "";
    std::vector<std::string> list;
    for (unsigned number = 0; number < machine_.inputs.roles.size(); ++number) {
      if ((machine_.inputs.roles[number].inputs >> input & 1U) == 0) continue;
      list.push_back(number < driver::kAxisRoles * 8
                         ? role_text({static_cast<driver::AxisRole>(number / 8), number % 8}, machine_)
                         : role_text(static_cast<driver::CardRole>(number), machine_));
    }
    if (machine_.probe.input == input) list.emplace_back("probe");
    return fmt::format("{}", fmt::join(list, ", "));
  }
  const world::World::ContactState* contact_at(unsigned input) const {
    for (const world::World::ContactState& one : contacts_) {
      if (one.input.value_or(kEmergencyStop) == input) return &one;
    }
    return nullptr;
  }
  bool level_at_begin(unsigned input) const { return (levels_ >> input & 1U) != 0; }
  // For an input without a role on the card: the level of the world's pressed contact. Without a contact either: 1.
  bool active_level(unsigned input, const world::World::ContactState* contact) const {
    if (input == kEmergencyStop) return true;
    if (machine_.probe.input == input) return machine_.probe.touched_level;
    if ((machine_.inputs.used() >> input & 1U) != 0) return (machine_.inputs.inverted() >> input & 1U) == 0;
    return contact == nullptr || contact->pressed == level_at_begin(input);
  }
  static bool is_scripted(const simulation::RunResult& result, unsigned input) {
    using Kind = simulation::OperatorEvent::Kind;
    for (const simulation::MadeEvent& made : result.events) {
      if (made.event.kind == Kind::kInput && made.event.input == input) return true;
      if (made.event.kind == Kind::kEmergencyStop && input == kEmergencyStop) return true;
    }
    return false;
  }

  const machine::Machine& machine_;
  std::uint64_t levels_ = 0;
  std::vector<world::World::ContactState> contacts_;
};

nlohmann::ordered_json causes_json(const HoldWatch& holds, const std::optional<StopCause>& stop) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const HoldWatch::Hold& hold : holds.holds()) {
    nlohmann::ordered_json entry{
        {"name", "feed hold button"}, {"reaction", "hold"}, {"cycle", hold.cycle}, {"line", hold.line}};
    if (hold.until) entry["until"] = *hold.until;
    list.push_back(entry);
  }
  if (stop) {
    list.push_back({{"name", stop->name},
                    {"reaction", stop->reaction},
                    {"cycle", stop->cycle},
                    {"position", stop->position},
                    {"line", stop->line}});
  }
  return list;
}

nlohmann::ordered_json page_world_json(const world::World& world, const WorldRecord& record) {
  nlohmann::ordered_json json = world_json(world);
  for (std::size_t n = 0; n < world.axes(); ++n) {
    const WorldRecord::Parting& parting = record.partings()[n];
    nlohmann::ordered_json& axis = json["axes"][n];
    axis["pulses_per_mm"] = world.axis(n).pulses_a_mm;
    axis["motor"] = world.axis(n).card_axis;
    axis["most_lost"] = parting.most;
    axis["began"] = nullptr;
    if (parting.began) axis["began"] = *parting.began;
  }
  return json;
}

}  // namespace

nlohmann::ordered_json surroundings_json(const machine::Machine& machine, const simulation::RunResult& result,
                                         const HoldWatch& holds, const world::World* world, const WorldRecord* record,
                                         const std::optional<StopCause>& cause) {
  nlohmann::ordered_json json;
  json["stopped"] = nullptr;
  if (cause) json["stopped"] = fmt::format("by {}, at line {}", cause->name, cause->line);
  json["causes"] = causes_json(holds, cause);
  json["lanes"] = Lanes(machine, record).json(result);
  json["world"] = nullptr;
  if (record != nullptr) json["world"] = page_world_json(*world, *record);
  return json;
}

}  // namespace trammel::app
