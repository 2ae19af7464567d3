// The machine behind the protocol, as a card and a machine file make it. Calls run::Runner for each motion and run::home
// for homing. One thread; `meanwhile` is called from the bus's sleeps.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "trammel/driver/card.hpp"
#include "trammel/grbl/machine_side.hpp"
#include "trammel/run/machine_position.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::grbl {

// A bus whose sleeps are short and call a function; where `card_time` tells the time of a simulated card, that is no
// faster than the host's.
class AttentiveBus final : public driver::Bus {
 public:
  explicit AttentiveBus(driver::Bus& bus, std::function<std::chrono::nanoseconds()> card_time = {})
      : bus_(bus), card_time_(std::move(card_time)) {}
  void set_meanwhile(std::function<void()> meanwhile) { meanwhile_ = std::move(meanwhile); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override { return bus_.transfer(accesses, count); }
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return bus_.reports_refusals(); }
  std::string hold_origin() const override { return bus_.hold_origin(); }

 private:
  void keep_pace();

  driver::Bus& bus_;
  std::function<std::chrono::nanoseconds()> card_time_;
  std::function<void()> meanwhile_;
  bool inside_ = false;
  std::chrono::steady_clock::time_point host_{};
  std::chrono::nanoseconds card_{-1};
};

class CardMachine final : public MachineSide, private run::Observer {
 public:
  // `card` is open on `bus`, stands, and has no fault; both must outlive it. Throws run::PlaceError where the machine
  // may not move from where it stands (`trust`: a lost place is taken), and driver::Error.
  CardMachine(driver::Card& card, AttentiveBus& bus, const machine::Machine& machine, bool trust);

  const machine::Machine& machine() const override { return limited_; }
  planner::CardLimits limits() const override;
  void set_machine(const machine::Machine& machine) override;
  Live look() override;
  void wait() override;
  void set_meanwhile(std::function<void()> meanwhile) override { bus_.set_meanwhile(std::move(meanwhile)); }
  void hold(bool hold) override;
  void stop() override;
  double override_feed(double percent) override;
  void override_rapids(double percent) override;
  End run(gcode::LineSource& lines, const gcode::Coordinates& start, const std::map<int, double>& parameters) override;
  End home(const std::vector<std::size_t>& axes) override;
  bool can_home() const override;
  bool homed() override;
  bool has_probe() const override { return machine_.probe.input.has_value(); }
  Alarm fault() override;
  Alarm unlock() override;

 private:
  using Clock = std::chrono::steady_clock;
  void sending(const planner::PlannedBlock& block) override;
  void progress(const run::Progress& progress) override;
  void take_place();
  void set_up();
  void look_position();
  Alarm alarm_of_fault();
  // Calls `move`; what it throws becomes an End.
  End guarded(const std::function<void(End&)>& move);

  driver::Card& card_;
  AttentiveBus& bus_;
  bool trust_;
  machine::Machine machine_;
  machine::Machine limited_;  // with the soft limits of homed axes alone
  std::unique_ptr<run::MachinePosition> position_;
  bool moving_ = false;
  bool held_ = false;
  std::size_t line_ = 0;
  double planned_ = 0;
  Clock::time_point first_sent_;
  bool any_sent_ = false;
  std::uint64_t last_time_ = 0;
  gcode::Coordinates last_at_{};
  double speed_ = 0;
};

}  // namespace trammel::grbl
