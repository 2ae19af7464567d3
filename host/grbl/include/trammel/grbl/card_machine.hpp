// The machine behind the protocol, as a card and a machine file make it: each motion is a run::Runner, homing is
// run::home(). One thread; `meanwhile` is called from the bus's sleeps.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "trammel/driver/card.hpp"
#include "trammel/grbl/machine_side.hpp"
#include "trammel/run/attentive_bus.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/machine_position.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::grbl {

class CardMachine final : public MachineSide, private run::Observer {
 public:
  // Longest sleep of the bus: a real-time command waits no longer.
  static constexpr std::chrono::nanoseconds kLongestSleep = std::chrono::milliseconds(5);

  // `card` is open on `bus` and stands; both must outlive it. `trust`: a place that was lost is taken for the
  // machine's. Throws driver::Error, and driver::ArgumentError for a machine that the card cannot drive.
  CardMachine(driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine, bool trust);

  const machine::Machine& machine() const override { return limited_; }
  planner::CardLimits limits() const override;
  void set_machine(const machine::Machine& machine) override;
  Live look() override;
  bool probe_touches() override;
  void wait() override;
  void set_meanwhile(std::function<void()> meanwhile) override;
  void hold(bool hold) override;
  void stop() override;
  double override_feed(double percent) override;
  void override_rapids(double percent) override;
  End run(gcode::LineSource& lines, const Before& before) override;
  End home(const std::vector<std::size_t>& axes) override;
  bool can_home() const override;
  bool homed() override;
  bool has_probe() const override { return machine_.probe.input.has_value(); }
  End trouble() override;
  End unlock() override;

 private:
  using Clock = std::chrono::steady_clock;
  void sending(const planner::PlannedBlock& block) override;
  void progress(const run::Progress& progress) override { line_ = progress.line; }
  void set_up(bool trust);
  void begin_at(const gcode::Coordinates& at);
  void keep_coordinates(const gcode::Coordinates& at);
  void look_at_position();
  void look_at_inputs();
  void look_again();
  void set_ratio(driver::PieceClass piece_class, double percent);
  End fault();
  // Calls `move`; what it throws becomes an End.
  End guarded(const std::function<void(End&)>& move);
  std::vector<std::size_t> axes_with_switches() const;

  driver::Card& card_;
  run::AttentiveBus& bus_;
  machine::Machine machine_;
  machine::Machine limited_;  // with the soft limits of homed axes alone, and a window for a sender
  std::string lost_;          // why the place is not known; empty where it is
  std::unique_ptr<run::MachinePosition> position_;
  planner::PathTicks ticks_;  // of the motions so far
  bool moving_ = false;
  std::size_t line_ = 0;
  double planned_ = 0;       // s of motion sent
  std::uint64_t begun_ = 0;  // card clock of the first look behind it; 0: none yet
  Live live_;
  bool faulted_ = false;
  Clock::time_point looked_{};  // at the position
  Clock::time_point looked_at_inputs_{};
  std::uint64_t speed_time_ = 0;  // card clock of the last measure of speed
  gcode::Coordinates speed_at_{};
};

}  // namespace trammel::grbl
