#include "trammel/linuxcnc/path_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "path_lines.hpp"
#include "path_progress.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/low_level/requests.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/run/configure.hpp"

namespace trammel::linuxcnc {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kIdle = 1ms;  // interval between two looks at the ring
constexpr double kWindow = 500;                  // operations: half a second at LinuxCNC's rate
constexpr double kSamePulse = 0.75;              // pulses by which a pose may differ from the card's position
constexpr double kSpeedTime = 0.02;              // s over which a speed is measured
constexpr std::string_view kRunName = "linuxcnc:";

// Removes soft limits and work offsets, because LinuxCNC uses other coordinates.
machine::Machine without_limits(machine::Machine machine) {
  if (machine.kinematics.name != machine::kKinematics[0]) {
    throw std::invalid_argument(
        fmt::format("kinematics {}: the planner module takes cartesian machines alone; use LinuxCNC's own planner",
                    machine.kinematics.name));
  }
  for (machine::MachineAxis& axis : machine.axes) {
    axis.min = -std::numeric_limits<double>::infinity();
    axis.max = std::numeric_limits<double>::infinity();
    axis.offsets = {};
  }
  machine.motion.window = std::min(machine.motion.window, kWindow);
  return machine;
}

double distance(const Pose& a, const Pose& b) {
  double linear = 0;
  double all = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const double square = (a[n] - b[n]) * (a[n] - b[n]);
    all += square;
    if (n < 3) linear += square;
  }
  return std::sqrt(linear > 0 ? linear : all);
}

void copy_text(char (&to)[128], const std::string& text) {
  const std::size_t length = std::min(text.size(), sizeof to - 1);
  std::memcpy(to, text.data(), length);
  to[length] = '\0';
}

}  // namespace

PathServer::PathServer(trammel_region& region, driver::Card& card, run::AttentiveBus& bus,
                       const machine::Machine& machine, PathUnits units)
    : region_(region), card_(card), bus_(bus), units_(units), machine_(without_limits(machine)), queue_(region) {
  report_.operations_done = queue_.done();
  position_ = std::make_unique<run::MachinePosition>(card_.read_snapshot(), machine_);
}

PathServer::~PathServer() = default;

void PathServer::set_machine(const machine::Machine& machine) {
  machine_ = without_limits(machine);
  position_ = std::make_unique<run::MachinePosition>(card_.read_snapshot(), machine_);
}

void PathServer::serve(const std::function<bool()>& meanwhile) {
  struct NoLonger {
    ~NoLonger() { bus.set_meanwhile({}); }
    run::AttentiveBus& bus;
  };
  meanwhile_ = &meanwhile;
  ending_ = false;
  bus_.set_meanwhile([this] { turn(); });
  const NoLonger no_longer{bus_};
  begin_overrides();
  look();
  while (!ending_) {
    idle();
    bus_.sleep(kIdle);
  }
  end_overrides();
}

// Called while the card is at rest.
void PathServer::idle() {
  if (queue_.front() != nullptr && !queue_.wants_stop()) return run_section();
  if (!queue_.barrier()) return;
  if (queue_.barrier()->kind == TRAMMEL_SET_POSE) set_pose(end_of(*queue_.barrier()));
  queue_.finish_barrier();
  report_.operations_done = queue_.done();
}

// Sets LinuxCNC's coordinates, at a whole number of pulses from the card's.
void PathServer::set_pose(const Pose& pose) {
  const gcode::Coordinates wanted = coordinates_of(pose, machine_, units_);
  const gcode::Coordinates here = position_->millimetres();
  for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
    const double pulses = (wanted[axis] - here[axis]) * machine_.axes[axis].steps_per_mm;
    if (std::abs(pulses) > kSamePulse) position_->set(axis, wanted[axis]);
  }
  look();
}

// Called after each sleep of the bus.
void PathServer::turn() {
  look();
  apply_overrides();
  if (queue_.take()) note_came();
  report_.operations_done = queue_.done();
  if (!(*meanwhile_)()) ending_ = true;
  stop_if_asked(now_);
}

void PathServer::note_came() {
  last_came_ = now_.time;
  last_beat_ = beat_;
}

void PathServer::look() {
  now_ = card_.read_snapshot();
  position_->look(now_);
  if (progress_) progress_->look(now_);
  follow_segments();
  measure_speed(now_);
}

void PathServer::follow_segments() {
  const Pose here = pose_of(position_->millimetres(), machine_, units_);
  std::copy(here.begin(), here.end(), std::begin(report_.pose));
  const std::size_t line = progress_ ? progress_->line() : 0;
  while (under_way_.size() > 1 && under_way_[1].line <= line) under_way_.pop_front();
  report_.distance_to_go = 0;
  if (under_way_.empty() || line == 0) return;
  report_.segments_begun = std::max(report_.segments_begun, under_way_.front().number);
  report_.distance_to_go = distance(here, under_way_.front().end);
}

void PathServer::measure_speed(const driver::Snapshot& now) {
  const double seconds = static_cast<double>(now.time - speed_time_) / card_.identification().clock_hz;
  if (seconds < kSpeedTime) return;
  Pose here{};
  std::copy(std::begin(report_.pose), std::end(report_.pose), here.begin());
  report_.path_speed = progress_ ? distance(here, speed_at_) / seconds : 0;
  speed_time_ = now.time;
  speed_at_ = here;
}

// Requests a stop if one is wanted. After a probe's edge none is: LinuxCNC sees the probe and aborts the motion, but
// the card has already stopped by itself, and its capture is the result.
void PathServer::stop_if_asked(const driver::Snapshot& now) {
  probe_met_ = probe_met_ || (probing_ && now.status.probed);
  if (!progress_ || stop_asked_) return;
  if (!ending_ && (!queue_.wants_stop() || probe_met_)) return;
  stop_asked_ = true;
  card_.request_stop();
}

// Executes one run, which begins at the end of the previous one. It continues with the tick counts of that run; after a
// stopped run the counts start anew.
void PathServer::run_section() {
  progress_ = std::make_unique<PathProgress>(card_.identification().clock_hz, machine_.motion.max_override);
  under_way_.clear();
  probing_ = false;
  probe_met_ = false;
  stop_asked_ = false;
  note_came();
  run::RunSettings settings;
  settings.start = position_->millimetres();
  settings.stands_at = position_->pulses();
  settings.ticks = std::exchange(ticks_, {});
  const Pose from = pose_of(settings.start, machine_, units_);
  try {
    const driver::WatchdogScope watchdog(card_, run::watchdog_time(machine_.motion));
    run::Runner runner([&] { return std::make_unique<PathLines>(*this, from); }, machine_,
                       planner::limits_of(card_.identification()), settings);
    runner.add(*progress_);
    const run::Outcome outcome = runner.stream(card_);
    ticks_ = outcome.ticks;
    note_end(outcome);
  } catch (const run::StoppedOnPath&) {
    holding_ = false;
  } catch (const driver::StoppedError&) {
    holding_ = false;
  } catch (const driver::LinkError&) {
    end_section();
    throw;
  } catch (const std::runtime_error& error) {
    refuse(under_way_.empty() ? 0 : under_way_.front().id, error.what());
  }
  end_section();
  look();
  card_.parts().registers.throw_if_faulted(now_.status, "path");
  // Serves a hold or ratio request made at the last moment.
  driver::serve_requests(card_);
}

void PathServer::end_section() {
  progress_.reset();
  under_way_.clear();
  card_.parts().requests.take_stop();
  card_.parts().requests.take_abort();
}

void PathServer::note_end(const run::Outcome& outcome) {
  if (!under_way_.empty()) report_.segments_begun = under_way_.back().number;
  if (outcome.probes.empty()) return;
  const run::ProbeMade& probe = outcome.probes.back();
  const Pose edge = pose_of(probe.edge, machine_, units_);
  std::copy(edge.begin(), edge.end(), std::begin(report_.probe_pose));
  report_.probe_tripped = probe.tripped ? 1 : 0;
  ++report_.probes;
}

// `text` may begin with the position in the run's lines, which means nothing to LinuxCNC and is removed.
void PathServer::refuse(std::int32_t id, const std::string& text) {
  const std::size_t place = text.rfind(kRunName, 0) == 0 ? text.find(": ") : std::string::npos;
  queue_.refuse();
  report_.refusal = id;
  copy_text(report_.text, place == std::string::npos ? text : text.substr(place + 2));
  ++report_.refusals;
}

void PathServer::write_status(trammel_status& status) const {
  status.operations_done = report_.operations_done;
  status.segments_begun = report_.segments_begun;
  status.distance_to_go = report_.distance_to_go;
  status.path_speed = report_.path_speed;
  std::copy(std::begin(report_.pose), std::end(report_.pose), std::begin(status.pose));
  status.probes = report_.probes;
  status.probe_tripped = report_.probe_tripped;
  std::copy(std::begin(report_.probe_pose), std::end(report_.probe_pose), std::begin(status.probe_pose));
  status.refusals = report_.refusals;
  status.refusal = report_.refusal;
  if (report_.refusals != 0) std::copy(std::begin(report_.text), std::end(report_.text), std::begin(status.text));
  // A card at rest is not at the path's end while operations wait for their run.
  status.flags &= ~std::uint32_t{TRAMMEL_STATUS_AT_REST};
  if (!progress_ && queue_.empty() && !now_.status.busy) status.flags |= TRAMMEL_STATUS_AT_REST;
}

}  // namespace trammel::linuxcnc
