// The machine behind the protocol, implemented by a card and a machine file: each motion is a run::Runner, homing is
// run::home(). Used by one thread; `meanwhile` is called from the bus's sleeps.
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
  // Longest sleep of the bus, and so the longest delay of a real-time command.
  static constexpr std::chrono::nanoseconds kLongestSleep = std::chrono::milliseconds(5);

  // `card` is open on `bus` and at rest; both must outlive this object. `trust`: accept a lost place as the machine's
  // place. Throws driver::Error, and driver::ArgumentError for a machine that the card cannot drive.
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
  // Calls `move` and converts its exceptions to an End, except driver::LinkError.
  End guarded(const std::function<void(End&)>& move);
  std::vector<std::size_t> axes_with_switches() const;

  driver::Card& card_;
  run::AttentiveBus& bus_;
  machine::Machine machine_;
  machine::Machine limited_;  // with soft limits of homed axes only, and a short look-ahead window
  std::string lost_;          // reason why the place is unknown; empty if it is known
  std::unique_ptr<run::MachinePosition> position_;
  planner::PathTicks ticks_;  // tick counts of the motions so far
  bool moving_ = false;
  std::size_t line_ = 0;
  double planned_ = 0;       // duration of the motion sent, s
  std::uint64_t begun_ = 0;  // card time at the first poll after the first block was sent; 0: none yet
  Live live_;
  bool faulted_ = false;
  Clock::time_point looked_{};  // last poll of the position
  Clock::time_point looked_at_inputs_{};
  std::uint64_t speed_time_ = 0;  // card time of the last speed measurement
  gcode::Coordinates speed_at_{};
};

}  // namespace trammel::grbl
