#include "trammel/linuxcnc/bridge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/linuxcnc/joint_settings.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"

namespace trammel::linuxcnc {
namespace {

namespace field = card_map::field;

// Per turn. After a stall many periods are in the ring, and the status must be updated while they are processed.
constexpr unsigned kMostPeriods = 8;

// After this many periods of a machine that is on and is not followed, the reason is told: a quarter of a second at 1
// kHz, as long as LinuxCNC's component waits for the card.
constexpr unsigned kIgnoredPeriods = 250;

std::uint32_t cause_of(std::uint32_t faults) {
  return faults == 0 ? 0 : static_cast<std::uint32_t>(__builtin_ctz(faults)) + 1;
}

}  // namespace

Bridge::Bridge(Region& region, driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine,
               PathSide& path, BridgeOptions options)
    : region_(region),
      card_(card),
      bus_(bus),
      machine_(machine),
      path_(path),
      options_(std::move(options)),
      stream_(card, options_.record) {
  set_up();
  publish();
}

void Bridge::set_up() {
  run::configure(card_, machine_);
  run::set_keeps_place(card_, machine_);
  driver::CardPlace place = driver::read_card_place(card_);
  if (!place.was_set()) {
    driver::keep_place(card_, place, run::scales_of(machine_), run::motors_of(machine_));
    place = driver::read_card_place(card_);
  }
  run::guard_homed_axes(card_, machine_, place);
  look_.emplace(card_, machine_);
}

void Bridge::run(const std::function<bool()>& ended) {
  ended_ = ended;
  while (!ended()) turn(kTurn);
  stop();
}

void Bridge::turn(std::chrono::nanoseconds longest) {
  region_.wait(longest);
  take_periods();
  if (path_wanted_ && !stopped_) serve_path();
  take_settings();
  publish();
  tell_who_is_there();
}

void Bridge::stop() {
  if (stream_.is_open()) guarded([this] { close(); });
  publish();
}

void Bridge::take_periods() {
  for (unsigned n = 0; n < kMostPeriods; ++n) {
    const auto period = region_.take_period();
    if (!period) return;
    take(*period);
    if (path_wanted_ && !inside_) return;
  }
}

void Bridge::take(const trammel_period& period) {
  last_flags_ = period.flags;
  const bool enabled = (period.flags & TRAMMEL_PERIOD_ENABLE) != 0;
  const bool clears = (period.flags & TRAMMEL_PERIOD_CLEAR) != 0;
  path_wanted_ = enabled && armed_ && (period.flags & TRAMMEL_PERIOD_PATH) != 0;
  if (inside_) {
    armed_ = armed_ && enabled;
    return;
  }
  if (clears && !clear_seen_) clear();
  clear_seen_ = clears;
  if (!enabled) {
    armed_ = !stopped_;
    ignored_ = 0;
  }
  guarded([&] {
    const std::uint32_t refused = look_->set_index_waits(period.flags >> TRAMMEL_PERIOD_INDEX_SHIFT);
    if ((refused & ~index_refused_) != 0) {
      set_text("index-enable: the machine file names no index input for this joint, or no capture unit is free");
      tell(status_.text);
    }
    index_refused_ = refused;
    if (enabled && !path_wanted_) return take_enabled(period);
    if (stream_.is_open()) close();
    set_hold(false);
  });
}

void Bridge::take_enabled(const trammel_period& period) {
  if (!stream_.is_open()) {
    if (stopped_) return;
    if (!armed_) return ignore("it was not seen off since the last stop, or since this program started");
    // After a stop the time base ramps back to full ratio first.
    const std::uint32_t ratio = look_->snapshot().ratio;
    if (ratio != driver::Card::kFullRatio) return ignore(fmt::format("the card's ratio is {} / 65536", ratio));
    open();
  }
  ignored_ = 0;
  set_hold((period.flags & TRAMMEL_PERIOD_HOLD) != 0);
  stream_.follow(period, holding_ && look_->snapshot().status.held);
}

void Bridge::ignore(const std::string& why) {
  if (++ignored_ != kIgnoredPeriods) return;
  tell(fmt::format("the machine is on, but its targets are not followed: {}; switch it off and on again", why));
}

void Bridge::open() {
  const driver::Snapshot now = card_.read_snapshot();
  watchdog_.emplace(card_, run::watchdog_time(machine_.motion));
  stream_.open(servo_settings(machine_, settings_), look_->from_zero(now));
}

void Bridge::close(bool ramp) {
  struct NoLonger {
    ~NoLonger() {
      bridge.watchdog_.reset();
      bridge.holding_ = false;
    }
    Bridge& bridge;
  };
  const NoLonger no_longer{*this};
  waiting([&] {
    if (ramp) {
      stream_.end_on_ramp();
    } else {
      stream_.close();
    }
    if (holding_) card_.set_hold(false);
  });
}

// Runs a call that waits for the card; meanwhile periods are taken and the status is published.
void Bridge::waiting(const std::function<void()>& call) {
  struct NoLonger {
    ~NoLonger() {
      bridge.bus_.set_meanwhile({});
      bridge.inside_ = false;
    }
    Bridge& bridge;
  };
  const NoLonger no_longer{*this};
  inside_ = true;
  bus_.set_meanwhile([this] {
    take_periods();
    publish();
  });
  call();
}

void Bridge::set_hold(bool hold) {
  if (hold == holding_) return;
  card_.set_hold(hold);
  holding_ = hold;
}

// Called after an under-run at rest. The ratio returns at once, because a ramp is only for motion: during the ramp
// LinuxCNC would move too far ahead for one line.
void Bridge::come_back_at_once() {
  constexpr int kLooks = 100;  // polls; the card needs 8 clocks
  const std::uint32_t slew = card_.parts().registers.read(card_map::reg::kSlew);
  card_.set_slew_time(std::chrono::nanoseconds(0));
  for (int looks = 0; card_.read_snapshot().ratio != driver::Card::kFullRatio && looks < kLooks; ++looks) {
  }
  card_.parts().registers.write(card_map::reg::kSlew, slew, "slew");
}

// After a clear, an enabled machine must be disabled before a motion can start.
void Bridge::clear() {
  if (!stopped_) return;
  try {
    if (card_.read_status().faulted) card_.clear_faults();
    card_.parts().registers.write(card_map::reg::kStreaming, 0, "clear");
  } catch (const driver::LinkError&) {
    throw;
  } catch (const driver::Error& error) {
    set_text(error.what());
    return tell(fmt::format("not cleared: {}", error.what()));
  }
  stopped_ = false;
  status_.cause = 0;
  status_.text[0] = '\0';
  armed_ = false;
  tell("cleared");
}

void Bridge::guarded(const std::function<void()>& call) {
  try {
    call();
  } catch (const driver::LinkError&) {
    throw;
  } catch (const driver::FaultError& error) {
    stopped_by_fault(error.faults());
  } catch (const driver::ArgumentError& error) {
    ++status_.refused;
    stopped_by(TRAMMEL_CAUSE_TARGET, error.what());
  } catch (const driver::StateError& error) {
    // Usually the link was so slow that the line had ended when the card was read. At rest nothing is lost.
    if (!stream_.is_open() || !stream_.at_rest() || inside_) return stopped_by(TRAMMEL_CAUSE_OTHER, error.what());
    ++status_.missing;
    close(true);
    come_back_at_once();
    tell(fmt::format("under-run at rest, nothing was lost: {}", error.what()));
  } catch (const driver::Error& error) {
    stopped_by(TRAMMEL_CAUSE_OTHER, error.what());
  }
}

void Bridge::stopped_by_fault(std::uint32_t faults) {
  const bool resting = stream_.at_rest();
  waiting([this] { stream_.abandon(); });
  watchdog_.reset();
  holding_ = false;
  const std::string why = card_.read_fault_text();
  const bool missing = faults == field::kFaultMissingPeriod;
  const CardLook::Pulses at = look_->from_zero(card_.read_stop_snapshot());
  if (missing) {
    ++status_.missing;
    card_.clear_faults();
    card_.parts().registers.write(card_map::reg::kStreaming, 0, "missing period");
    if (resting && !stopped_) {
      come_back_at_once();
      return tell("under-run at rest: no period came in time; nothing was lost");
    }
  }
  set_stopped(cause_of(faults), at, why);
}

void Bridge::stopped_by(std::uint32_t cause, const std::string& text) {
  const CardLook::Pulses at = look_->from_zero(card_.read_snapshot());
  stopped_ = true;
  if (stream_.is_open()) {
    try {
      close(true);
    } catch (const driver::FaultError& error) {
      return stopped_by_fault(error.faults());
    }
  }
  watchdog_.reset();
  set_stopped(cause, at, text);
}

void Bridge::set_stopped(std::uint32_t cause, const CardLook::Pulses& at, const std::string& text) {
  stopped_ = true;
  armed_ = false;
  path_wanted_ = false;
  status_.cause = cause;
  std::copy(at.begin(), at.end(), std::begin(status_.stop_position));
  set_text(text);
  tell(fmt::format("stopped: {}; disable the machine and set the pin clear", text));
}

void Bridge::set_text(const std::string& text) {
  const std::size_t length = std::min(text.size(), sizeof(status_.text) - 1);
  std::copy_n(text.begin(), length, std::begin(status_.text));
  status_.text[length] = '\0';
}

}  // namespace trammel::linuxcnc
