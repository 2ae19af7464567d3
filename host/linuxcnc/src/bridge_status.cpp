// Reports of the bridge: the status, notes, and the turns inside a path.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/linuxcnc/bridge.hpp"
#include "trammel/linuxcnc/joint_settings.hpp"

namespace trammel::linuxcnc {
namespace {

std::int64_t monotonic_now() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

void Bridge::serve_path() {
  inside_ = true;  // PathSide serves the bus itself
  try {
    guarded([this] { path_.serve([this] { return path_turn(); }); });
  } catch (...) {
    inside_ = false;
    throw;
  }
  inside_ = false;
}

bool Bridge::path_turn() {
  take_periods();
  publish();
  tell_who_is_there();
  const bool faulted = look_->snapshot().status.faulted;
  return path_wanted_ && !faulted && !(ended_ && ended_());
}

// Settings take effect only while the machine is off.
void Bridge::take_settings() {
  if (stream_.is_open()) return;
  const auto settings = region_.new_settings();
  if (settings) {
    settings_ = *settings;
    guarded([this] { configure_joints(card_, machine_, settings_); });
    settings_came_ = true;
  }
}

void Bridge::publish() {
  status_.flags = 0;
  look_->look(status_);
  if (watchdog_) card_.parts().watchdog.look();  // when nothing is sent, as in a hold
  status_.time = monotonic_now();
  const driver::Status& card = look_->snapshot().status;
  // The card has stopped, and no period has arrived that would have detected it.
  if (card.faulted && !stopped_ && !inside_) stopped_by_fault(look_->snapshot().faults);
  status_.state = stopped_            ? TRAMMEL_STOPPED
                  : stream_.is_open() ? TRAMMEL_STREAMING
                  : path_wanted_      ? TRAMMEL_ON_PATH
                                      : TRAMMEL_IDLE;
  if (stopped_) status_.flags |= TRAMMEL_STATUS_FAULT;
  if (!card.busy || (stream_.is_open() && stream_.at_rest())) {
    if (!inside_) status_.flags |= TRAMMEL_STATUS_AT_REST;
  }
  status_.last_period = stream_.last_period();
  status_.ahead = static_cast<std::uint32_t>(stream_.ahead());
  status_.late = stream_.counts().late;
  status_.dropped = stream_.counts().dropped;
  status_.joints = card_.identification().axes;
  const auto scales = pulses_per_unit(machine_, settings_);
  std::copy(scales.begin(), scales.end(), std::begin(status_.pulses_per_unit));
  path_.write_status(status_);
  region_.publish(status_);
}

void Bridge::tell_who_is_there() {
  const bool hal = region_.has_hal();
  const bool planner = region_.has_planner();
  if (hal != hal_there_) tell(hal ? "LinuxCNC's HAL component is there" : "LinuxCNC's HAL component has gone");
  if (planner != planner_there_) tell(planner ? "LinuxCNC's planner module is there" : "the planner module has gone");
  hal_there_ = hal;
  planner_there_ = planner;
}

void Bridge::tell(const std::string& text) const {
  if (options_.note) options_.note(text);
}

}  // namespace trammel::linuxcnc
