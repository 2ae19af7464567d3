#include "trammel/grbl/card_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/low_level/requests.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/homing.hpp"

namespace trammel::grbl {
namespace {

using namespace std::chrono_literals;

constexpr auto kFresh = 20ms;         // a position reading is valid for this time
constexpr auto kInputsFresh = 100ms;  // a reading of the inputs is valid for this time
constexpr double kSpeedTime = 0.04;   // s of card time, over which a speed is measured
// Blocks that the planner collects before it sends any: twice the size of Grbl's planner.
constexpr double kWindow = 32;
constexpr double kMinute = 60;

// The runner owns its lines; this adapter lends them.
class BorrowedLines final : public gcode::LineSource {
 public:
  explicit BorrowedLines(gcode::LineSource& lines) : lines_(lines) {}
  bool next(std::string_view& line) override { return lines_.next(line); }
  const std::string& name() const override { return lines_.name(); }
  std::optional<std::string> failure() const override { return lines_.failure(); }

 private:
  gcode::LineSource& lines_;
};

}  // namespace

CardMachine::CardMachine(driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine, bool trust)
    : card_(card), bus_(bus), machine_(machine), limited_(machine) {
  set_up(trust);
  for (const auto piece_class : {driver::PieceClass::kFeed, driver::PieceClass::kRapid, driver::PieceClass::kFixed}) {
    set_ratio(piece_class, 100);
  }
}

planner::CardLimits CardMachine::limits() const { return planner::limits_of(card_.identification()); }

// Writes the settings to the card, and takes the place from it.
void CardMachine::set_up(bool trust) {
  run::CardPlace place = run::read_card_place(card_);
  limited_ = machine_;
  lost_.clear();
  gcode::Coordinates at{};
  try {
    const run::Start start = run::start_at(machine_, place, trust);
    limited_ = start.machine;
    at = start.at;
  } catch (const run::PlaceError& error) {
    lost_ = error.what();
    if (run::scales_fit(place, machine_)) at = run::standing_at(machine_, place);
  }
  run::configure(card_, machine_);
  run::set_keeps_place(card_, machine_);
  if (lost_.empty()) {
    run::keep_place(card_, place, run::scales_of(machine_), run::motors_of(machine_));
    run::guard_soft_limits(card_, limited_, run::read_card_place(card_));
  }
  limited_.motion.window = std::min(limited_.motion.window, kWindow);
  begin_at(at);
}

void CardMachine::begin_at(const gcode::Coordinates& at) {
  position_ = std::make_unique<run::MachinePosition>(card_.read_snapshot(), machine_);
  for (std::size_t n = 0; n < machine_.axes.size(); ++n) position_->set(n, at[n]);
  look_at_position();
  look_at_inputs();
}

// For a new scale: the coordinates stay, and the axes count as not homed.
void CardMachine::keep_coordinates(const gcode::Coordinates& at) {
  const auto all = static_cast<unsigned>((1U << machine_.axes.size()) - 1);
  run::place_axes(card_, machine_, all, at, 0);
}

void CardMachine::set_machine(const machine::Machine& machine) {
  const bool known = lost_.empty();
  const bool other_scales = run::scales_of(machine) != run::scales_of(machine_);
  const gcode::Coordinates at = position_->millimetres();
  machine_ = machine;
  if (known && other_scales) keep_coordinates(at);
  set_up(known);
}

void CardMachine::look_at_position() {
  const driver::Snapshot now = card_.read_snapshot();
  position_->look(now);
  live_.at = position_->millimetres();
  live_.held = now.status.held;
  faulted_ = now.status.faulted;
  const double clock = card_.identification().clock_hz;
  const double seconds = static_cast<double>(now.time - speed_time_) / clock;
  if (seconds >= kSpeedTime || !moving_) {
    double squares = 0;
    for (const char letter : {'X', 'Y', 'Z'}) {
      const auto axis = machine_.axis(letter);
      if (axis) squares += std::pow(live_.at[*axis] - speed_at_[*axis], 2);
    }
    live_.speed = std::sqrt(squares) / seconds * kMinute;
    speed_time_ = now.time;
    speed_at_ = live_.at;
  }
  if (live_.any_sent && begun_ == 0) begun_ = now.time;
  live_.seconds_left = live_.any_sent ? planned_ - static_cast<double>(now.time - begun_) / clock : 0;
}

void CardMachine::look_at_inputs() {
  live_.limits = 0;
  if (machine_.inputs.used() != 0) {
    const driver::ActiveRoles roles = card_.read_roles();
    live_.limits = roles.limit_minus | roles.limit_plus;
  }
  if (!machine_.probe.input) return;
  const bool level = (card_.read_inputs() >> *machine_.probe.input & 1U) != 0;
  live_.probe = level == machine_.probe.touched_level;
}

void CardMachine::look_again() {
  const auto now = Clock::now();
  if (now - looked_ >= kFresh) {
    look_at_position();
    looked_ = Clock::now();
  }
  if (now - looked_at_inputs_ >= kInputsFresh) {
    look_at_inputs();
    looked_at_inputs_ = Clock::now();
  }
}

Live CardMachine::look() {
  live_.line = moving_ ? line_ : 0;
  return live_;
}

bool CardMachine::probe_touches() {
  look_at_inputs();
  return live_.probe;
}

void CardMachine::set_meanwhile(std::function<void()> meanwhile) {
  bus_.set_meanwhile([this, meanwhile = std::move(meanwhile)] {
    look_again();
    meanwhile();
  });
}

// While a motion waits for lines, only this call serves the card's watchdog.
void CardMachine::wait() {
  if (moving_) driver::serve_requests(card_);
  bus_.sleep(kLongestSleep);
}

void CardMachine::hold(bool hold) {
  if (moving_) return card_.request_hold(hold);
  if (!hold) card_.set_hold(false);
}

void CardMachine::stop() {
  if (moving_) card_.request_stop();
}

void CardMachine::set_ratio(driver::PieceClass piece_class, double percent) {
  const std::uint32_t ratio = driver::Card::ratio_of(percent, 100 * machine_.motion.max_override);
  if (moving_) return card_.request_ratio(piece_class, ratio);
  if (piece_class == driver::PieceClass::kFeed || card_.parts().time_base.has_classes()) {
    card_.set_ratio(piece_class, ratio);
  }
}

double CardMachine::override_feed(double percent) {
  const double most = 100 * machine_.motion.max_override;
  set_ratio(driver::PieceClass::kFeed, std::min(percent, most));
  return std::min(percent, most);
}

void CardMachine::override_rapids(double percent) { set_ratio(driver::PieceClass::kRapid, percent); }

void CardMachine::sending(const planner::PlannedBlock& block) {
  live_.any_sent = true;
  planned_ += block.seconds;
}

End CardMachine::guarded(const std::function<void(End&)>& move) {
  End end;
  moving_ = true;
  live_.any_sent = false;
  planned_ = 0;
  begun_ = 0;
  line_ = 0;
  try {
    const driver::WatchdogScope watchdog(card_, run::watchdog_time(machine_.motion));
    move(end);
  } catch (const run::StoppedOnPath&) {
    end.stopped = true;
  } catch (const driver::StoppedError&) {
    end.stopped = true;
  } catch (const driver::LinkError&) {
    throw;
  } catch (const run::HomingError& error) {
    end.alarm = Alarm::kHomingNoSwitch;
    end.message = error.what();
  } catch (const std::runtime_error& error) {
    end.message = error.what();
    const End why = fault();
    end.alarm = why.alarm;
    if (!why.message.empty()) end.message = why.message;
  }
  moving_ = false;
  live_.any_sent = false;
  card_.parts().requests.take_hold();
  card_.parts().requests.take_stop();
  look_at_position();
  live_.speed = 0;
  speed_at_ = live_.at;
  return end;
}

End CardMachine::run(gcode::LineSource& lines, const Before& before) {
  return guarded([&](End& end) {
    run::RunSettings settings;
    settings.reader.parameters = before.parameters;
    settings.reader.spindle = 10 * before.spindle;
    settings.reader.spindle_speed = before.speed;
    settings.start = before.place;
    settings.stands_at = position_->pulses();
    settings.ticks = std::exchange(ticks_, {});
    run::Runner runner([&] { return std::make_unique<BorrowedLines>(lines); }, limited_, limits(), settings);
    runner.add(*this);
    const run::Outcome outcome = runner.stream(card_);
    ticks_ = outcome.ticks;
    if (!outcome.probes.empty()) end.probe = Probed{outcome.probes.back().tripped, outcome.probes.back().edge};
  });
}

std::vector<std::size_t> CardMachine::axes_with_switches() const {
  std::vector<std::size_t> axes;
  for (std::size_t n = 0; n < machine_.axes.size(); ++n) {
    if (machine_.axes[n].homing) axes.push_back(n);
  }
  return axes;
}

bool CardMachine::can_home() const { return !axes_with_switches().empty(); }

bool CardMachine::homed() {
  const std::uint8_t homed = card_.read_place().homed;
  const std::string missing = run::axes_without(machine_, homed);
  const auto axes = axes_with_switches();
  return std::none_of(axes.begin(), axes.end(),
                      [&](std::size_t axis) { return missing.find(machine_.axes[axis].letter) != std::string::npos; });
}

End CardMachine::home(const std::vector<std::size_t>& axes) {
  const End end =
      guarded([&](End&) { run::home(card_, machine_, *position_, axes.empty() ? axes_with_switches() : axes); });
  // After a successful homing, or if the place was known: axes that were not homed keep their place.
  if (end.alarm == Alarm::kNone || lost_.empty()) set_up(false);
  return end;
}

// The result of the present fault. The axes are at rest when it returns.
End CardMachine::fault() {
  if (!card_.read_status().faulted) return {};
  card_.wait_until_stopped();
  End end;
  end.message = card_.read_fault_text();
  const std::uint32_t faults = card_.read_faults();
  const std::uint8_t motors = run::motors_of(machine_);
  const bool lost = (card_.read_place().valid & motors) != motors;
  const bool soft = (faults & card_map::field::kFaultSoftLimit) != 0;
  end.alarm = lost ? Alarm::kPositionLost : soft ? Alarm::kSoftLimit : Alarm::kHardLimit;
  if (lost) end.message += "; the position may be lost: home the machine";
  return end;
}

End CardMachine::trouble() {
  End end = faulted_ ? fault() : End{};
  if (end.alarm == Alarm::kNone && !lost_.empty()) {
    end.alarm = Alarm::kPositionLost;
    end.message = lost_;
  }
  return end;
}

End CardMachine::unlock() {
  try {
    if (card_.read_status().faulted) card_.clear_faults();
  } catch (const driver::LinkError&) {
    throw;
  } catch (const driver::Error& error) {
    End end = fault();
    if (end.alarm == Alarm::kNone) end.alarm = Alarm::kHardLimit;
    end.message = error.what();
    return end;
  }
  set_up(true);
  return trouble();
}

}  // namespace trammel::grbl
