#include "trammel/run/homing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "switch_search.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/roles.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/jog.hpp"
#include "trammel/run/jog_path.hpp"

namespace trammel::run {
namespace {

using driver::AxisRole;
using driver::Role;

constexpr double kSearchShare = 1.1;  // fraction of max - min
constexpr double kSquaringShare = 0.01;
constexpr double kLeastSquaring = 2;  // mm
constexpr double kMostSquaring = 25;  // mm

machine::Machine without_soft_limits(machine::Machine machine) {
  for (machine::MachineAxis& axis : machine.axes) {
    axis.min = -std::numeric_limits<double>::infinity();
    axis.max = std::numeric_limits<double>::infinity();
  }
  return machine;
}

double search_distance(const machine::MachineAxis& axis) {
  return axis.homing->search_distance != 0 ? axis.homing->search_distance : kSearchShare * (axis.max - axis.min);
}

double squaring_bound(const machine::MachineAxis& axis) {
  if (axis.homing->squaring != 0) return axis.homing->squaring;
  const double share = kSquaringShare * (axis.max - axis.min);
  return std::isfinite(share) ? std::clamp(share, kLeastSquaring, kMostSquaring) : kMostSquaring;
}

class Homing {
 public:
  Homing(driver::Card& card, const machine::Machine& machine, MachinePosition& position, const HomingOptions& options)
      : card_(card),
        machine_(machine),
        free_(without_soft_limits(machine)),
        kinematics_(machine),
        position_(position),
        options_(options),
        search_(card, free_, position) {}

  void check(const std::vector<std::size_t>& axes) const;
  std::vector<HomedAxis> run(const std::vector<std::size_t>& axes);
  void restore();

 private:
  using Group = std::vector<std::size_t>;
  // Final edges, by axis of the card: the positions of all motors at each edge.
  using Edges = std::map<unsigned, planner::Pulses>;

  const machine::AxisHoming& homing(std::size_t axis) const { return *machine_.axes[axis].homing; }
  char letter(std::size_t axis) const { return machine_.axes[axis].letter; }
  std::uint32_t inputs(AxisRole role, unsigned motor) const {
    return machine_.inputs.roles[Role(role, motor).number()].inputs;
  }
  void say(const std::string& text) const {
    if (options_.say) options_.say(text);
  }
  std::vector<unsigned> motors_with_a_switch(std::size_t axis) const;
  std::optional<WantedEdge> wanted(std::size_t axis, unsigned motor, AxisRole role) const;
  std::vector<WantedEdge> all_wanted(const Group& group, bool to_active, double velocity_share) const;
  void ignore_limits(const Group& group);
  void leave_pressed(const Group& group);
  double way_off(std::size_t axis, const driver::ActiveRoles& active) const;
  void search(const Group& group);
  Edges latch(const Group& group);
  void add_edges(Edges& edges, const std::vector<FoundEdge>& found) const;
  double coordinate(std::size_t axis, const planner::Pulses& at) const;
  void square(std::size_t axis, const Edges& edges);
  void move_motor(std::size_t axis, unsigned motor, std::int64_t pulses);
  void place(const Group& group, const Edges& edges);
  void go_home(const Group& group);
  void forget(const std::vector<std::size_t>& axes);

  driver::Card& card_;
  const machine::Machine& machine_;
  machine::Machine free_;
  kinematics::Kinematics kinematics_;
  MachinePosition& position_;
  const HomingOptions& options_;
  SwitchSearch search_;
  std::map<std::size_t, HomedAxis> homed_;
};

void Homing::check(const std::vector<std::size_t>& axes) const {
  for (const std::size_t axis : axes) {
    if (machine_.axes[axis].homing) continue;
    throw driver::ArgumentError(
        fmt::format("homing: the machine file has no [homing.{}]", static_cast<char>(letter(axis) - 'A' + 'a')));
  }
  if (!card_map::has_engine(card_.identification().engines, card_map::engine::kMachineInputs) ||
      card_.captures_present() == 0) {
    throw driver::ArgumentError("homing: needs a card with machine inputs and captures");
  }
}

// Motors of the axis that have their own home switch, the first motor first.
std::vector<unsigned> Homing::motors_with_a_switch(std::size_t axis) const {
  std::vector<unsigned> motors{static_cast<unsigned>(axis)};
  for (unsigned n = static_cast<unsigned>(machine_.axes.size()); n < kinematics_.joints(); ++n) {
    if (kinematics_.joint(n).settings == axis && inputs(AxisRole::kHome, n) != 0) motors.push_back(n);
  }
  return motors;
}

// The edge at the velocity and over the distance of the search; none if the role has no input.
std::optional<WantedEdge> Homing::wanted(std::size_t axis, unsigned motor, AxisRole role) const {
  const std::uint32_t bits = inputs(role, motor);
  if (bits == 0) return std::nullopt;
  WantedEdge edge;
  edge.axis = axis;
  edge.motor = motor;
  while ((bits >> edge.input & 1U) == 0) ++edge.input;
  edge.name = role == AxisRole::kIndex ? "index" : "home";
  edge.velocity = homing(axis).search_velocity;
  edge.distance = search_distance(machine_.axes[axis]);
  edge.at_speed = homing(axis).at_speed;
  return edge;
}

// The edges of all switches of a group, at `velocity_share` times the search velocity.
std::vector<WantedEdge> Homing::all_wanted(const Group& group, bool to_active, double velocity_share) const {
  std::vector<WantedEdge> all;
  for (const std::size_t axis : group) {
    const std::vector<unsigned> motors = motors_with_a_switch(axis);
    for (const unsigned motor : motors) {
      WantedEdge edge = *wanted(axis, motor, AxisRole::kHome);
      edge.velocity *= velocity_share;
      edge.to_active = to_active;
      if (motors.size() > 1) edge.squaring = squaring_bound(machine_.axes[axis]);
      all.push_back(edge);
    }
  }
  return all;
}

// The home switch may also be a limit switch.
void Homing::ignore_limits(const Group& group) {
  for (const std::size_t axis : group) {
    if (!homing(axis).ignore_limits) continue;
    card_.set_role({AxisRole::kLimitMinus, static_cast<unsigned>(axis)}, 0);
    card_.set_role({AxisRole::kLimitPlus, static_cast<unsigned>(axis)}, 0);
  }
}

// The velocity that moves the axis off a pressed switch. If the switch serves both ends, the card's record of the end
// that was reached determines the direction.
double Homing::way_off(std::size_t axis, const driver::ActiveRoles& active) const {
  const double off = -homing(axis).search_velocity;
  const auto n = static_cast<unsigned>(axis);
  const std::uint32_t home = inputs(AxisRole::kHome, n);
  if ((home & inputs(AxisRole::kLimitMinus, n) & inputs(AxisRole::kLimitPlus, n)) == 0) return off;
  const bool minus = (active.limit_minus >> n & 1U) != 0;
  const bool plus = (active.limit_plus >> n & 1U) != 0;
  if (minus == plus) {
    throw HomingError(fmt::format(
        "{} stands in a switch that serves both ends, and the card does not know at which: move it off by `trammel jog "
        "{}<distance> --override-limits`",
        letter(axis), letter(axis)));
  }
  return plus ? -std::abs(off) : std::abs(off);
}

// Leaves the pressed switches. The directions are read before the limits' roles are removed, because the card then
// forgets which end was reached.
void Homing::leave_pressed(const Group& group) {
  const std::uint32_t levels = card_.read_inputs();
  const driver::ActiveRoles active = card_.read_roles();
  std::vector<WantedEdge> pressed;
  for (WantedEdge edge : all_wanted(group, false, 1)) {
    if (edge.at_speed || (levels >> edge.input & 1U) == 0) continue;
    if (homing(edge.axis).shared) {
      throw HomingError(
          fmt::format("{}: its home switch at input {} is shared, and pressed before it moves: move the "
                      "axis that presses it off",
                      letter(edge.axis), edge.input));
    }
    edge.velocity = way_off(edge.axis, active);
    edge.squaring = 0;
    pressed.push_back(edge);
  }
  ignore_limits(group);
  if (pressed.empty()) return;
  for (const WantedEdge& edge : pressed) say(fmt::format("{}: its switch is pressed: leaves it", letter(edge.axis)));
  search_.find(pressed);
}

void Homing::search(const Group& group) {
  for (const std::size_t axis : group) {
    say(fmt::format("{}: searches its switch at {:g} mm/s, at most {:.4g} mm", letter(axis),
                    homing(axis).search_velocity, search_distance(machine_.axes[axis])));
  }
  for (const FoundEdge& edge : search_.find(all_wanted(group, true, 1))) {
    HomedAxis& axis = homed_[edge.wanted.axis];
    axis.axis = edge.wanted.axis;
    if (edge.wanted.motor < machine_.axes.size()) axis.search_edge = axis.edge = coordinate(axis.axis, edge.at);
  }
}

void Homing::add_edges(Edges& edges, const std::vector<FoundEdge>& found) const {
  for (const FoundEdge& edge : found) edges[edge.wanted.motor] = edge.at;
}

// Leaves the switches and approaches them slowly, or leaves them slowly, by the sign of latch_velocity. Then moves to
// the index.
Homing::Edges Homing::latch(const Group& group) {
  Edges edges;
  std::vector<WantedEdge> leave;
  std::vector<WantedEdge> into;
  std::vector<WantedEdge> off;
  std::vector<WantedEdge> index;
  for (const std::size_t axis : group) {
    const machine::AxisHoming& how = homing(axis);
    if (how.latch_velocity == 0) continue;
    const bool same = (how.latch_velocity < 0) == (how.search_velocity < 0);
    const double share = std::abs(how.latch_velocity / how.search_velocity);
    for (WantedEdge edge : all_wanted({axis}, true, 1)) {
      WantedEdge back = edge;
      back.to_active = false;
      back.velocity *= same ? -1 : -share;
      edge.velocity *= share;
      (same ? leave : off).push_back(back);
      if (same) into.push_back(edge);
    }
    if (!how.use_index) continue;
    WantedEdge mark = *wanted(axis, static_cast<unsigned>(axis), AxisRole::kIndex);
    mark.velocity = how.latch_velocity;
    index.push_back(mark);
  }
  search_.find(leave);
  add_edges(edges, search_.find(into));
  add_edges(edges, search_.find(off));
  add_edges(edges, search_.find(index));
  return edges;
}

double Homing::coordinate(std::size_t axis, const planner::Pulses& at) const {
  return kinematics_.coordinates(at)[axis];
}

// Moves one motor of an axis by a line that does not move the other motors.
void Homing::move_motor(std::size_t axis, unsigned motor, std::int64_t pulses) {
  gcode::Coordinates distance{};
  distance[axis] = static_cast<double>(pulses) / machine_.axes[axis].steps_per_mm;
  JogPath path = jog_path(free_, card_.timing(), position_.pulses(), distance, std::abs(homing(axis).latch_velocity));
  for (std::size_t n = 0; n < path.pulses.size(); ++n) path.pulses[n] = n == motor ? pulses : 0;
  path.mask = static_cast<std::uint8_t>(1U << motor);
  driver::Stream stream(card_);
  for (const driver::FeedCommand& piece : path.pieces) stream.put(piece);
  stream.put(line_of(path, 0, path.ticks));
  stream.finish();
  position_.look(card_.read_snapshot());
}

// Squares the axis: moves the second motor so that both are at the same distance from their own edges.
void Homing::square(std::size_t axis, const Edges& edges) {
  const std::vector<unsigned> motors = motors_with_a_switch(axis);
  if (motors.size() < 2) return;
  const unsigned first = motors[0];
  const unsigned second = motors[1];
  const std::int64_t way_of_first = position_.pulses()[first] - edges.at(first)[first];
  const std::int64_t way_of_second = position_.pulses()[second] - edges.at(second)[second];
  const std::int64_t by = way_of_first - way_of_second;
  homed_[axis].squared_by = static_cast<double>(by) / machine_.axes[axis].steps_per_mm;
  say(fmt::format("{}: squares its second motor by {:.4f} mm", letter(axis), homed_[axis].squared_by));
  if (by != 0) move_motor(axis, second, by);
}

// Sets machine zero from the edges. A motor is homed when all of its axes are.
void Homing::place(const Group& group, const Edges& edges) {
  unsigned named = 0;
  unsigned done = 0;
  gcode::Coordinates at = position_.millimetres();
  const gcode::Coordinates now = at;
  for (const std::size_t axis : group) {
    HomedAxis& result = homed_[axis];
    const auto edge = edges.find(static_cast<unsigned>(axis));
    if (edge != edges.end()) result.edge = coordinate(axis, edge->second);
    at[axis] = homing(axis).offset + now[axis] - result.edge;
    named |= 1U << axis;
    say(fmt::format("{}: the edge was counted at {:.4f} mm, and is {:.4f} mm from now on", letter(axis), result.edge,
                    homing(axis).offset));
  }
  for (const auto& [axis, result] : homed_) done |= 1U << axis;
  std::uint8_t motors = 0;
  for (std::size_t n = 0; n < kinematics_.joints(); ++n) {
    if ((kinematics_.axes_of(n) & ~done) == 0) motors = static_cast<std::uint8_t>(motors | 1U << n);
  }
  place_axes(card_, machine_, named, at, motors);
  for (const std::size_t axis : group) position_.set(axis, at[axis]);
}

void Homing::go_home(const Group& group) {
  for (const std::size_t axis : group) {
    gcode::Coordinates distance{};
    distance[axis] = homing(axis).final_position - position_.millimetres()[axis];
    const double speed =
        homing(axis).final_velocity != 0 ? homing(axis).final_velocity : machine_.axes[axis].max_velocity;
    if (std::abs(distance[axis]) * machine_.axes[axis].steps_per_mm < 1) continue;
    Jog jog(card_, free_, position_);
    jog.start(distance, speed);
    jog.wait();
  }
}

std::vector<HomedAxis> Homing::run(const std::vector<std::size_t>& axes) {
  std::map<unsigned, Group> groups;
  for (const std::size_t axis : axes) groups[homing(axis).sequence].push_back(axis);
  driver::InputStops stops = input_stops(machine_);
  stops.probe = stops.probe_ramps = true;
  card_.set_input_stops(stops);
  if (card_.has_soft_limits()) card_.set_soft_limits({});
  forget(axes);
  for (const auto& [sequence, group] : groups) {
    leave_pressed(group);
    search(group);
    const Edges edges = latch(group);
    for (const std::size_t axis : group) square(axis, edges);
    place(group, edges);
    go_home(group);
    configure_inputs(card_, machine_);
    card_.set_input_stops(stops);
  }
  std::vector<HomedAxis> all;
  for (const auto& [axis, result] : homed_) all.push_back(result);
  return all;
}

// Marks the axes as not homed, until they have found their edges.
void Homing::forget(const std::vector<std::size_t>& axes) {
  unsigned named = 0;
  for (const std::size_t axis : axes) named |= 1U << axis;
  std::uint8_t motors = 0;
  for (std::size_t n = 0; n < kinematics_.joints(); ++n) {
    if ((kinematics_.axes_of(n) & named) != 0) motors = static_cast<std::uint8_t>(motors | 1U << n);
  }
  const auto homed = static_cast<std::uint8_t>(card_.read_place().homed & motors);
  if (homed != 0) card_.set_place(homed, true, false);
}

// Restores the inputs, and the soft limits of homed axes only.
void Homing::restore() {
  for (unsigned unit = 0; unit < card_.captures_present(); ++unit) card_.stop_capture(unit);
  configure_inputs(card_, machine_);
  const CardPlace place = read_card_place(card_);
  const std::string not_homed = axes_without(machine_, place.bits.homed);
  machine::Machine guarded = machine_;
  for (std::size_t n = 0; n < guarded.axes.size(); ++n) {
    if (not_homed.find(guarded.axes[n].letter) != std::string::npos) guarded.axes[n] = free_.axes[n];
  }
  guard_soft_limits(card_, guarded, place);
}

}  // namespace

std::vector<HomedAxis> home(driver::Card& card, const machine::Machine& machine, MachinePosition& position,
                            const std::vector<std::size_t>& axes, const HomingOptions& options) {
  Homing homing(card, machine, position, options);
  homing.check(axes);
  try {
    std::vector<HomedAxis> result = homing.run(axes);
    homing.restore();
    return result;
  } catch (const std::exception&) {
    try {
      homing.restore();
    } catch (const driver::Error&) {
      // Report the first error: it names the failed link or the reason of the stop.
    }
    throw;
  }
}

}  // namespace trammel::run
