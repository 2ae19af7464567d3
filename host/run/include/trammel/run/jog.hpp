// Jogging: moves one or several axes by hand, either for as long as the operator asks for it or by a distance. Every
// jog is one path that ends at rest before the first soft limit, so no action or omission of the host leads beyond the
// limit. The feed of the path is sent at once. The geometry is sent in short lines, a little more than a stop distance
// ahead. If the host dies and no more lines arrive, the card's under-run hold ramps to a stop on the path. A card
// without the under-run hold gets the whole path at once.
//
// The time base executes the operator's changes: a new speed is a new ratio, and a stop is a hold. Each change is one
// write to the card, takes effect some clocks later, and is ramped with at most half of each axis's acceleration.
// During a jog, the jog controls the card's ratio, slew and hold; at its end it restores ratio and slew. Not
// thread-safe.
#pragma once

#include <cstdint>
#include <optional>

#include "trammel/driver/card.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/jog_path.hpp"
#include "trammel/run/machine_position.hpp"

namespace trammel::run {

class Jog {
 public:
  // The card is configured for the machine, and `position` is its present position. All three must outlive the jog;
  // nothing else moves the card during a jog.
  Jog(driver::Card& card, const machine::Machine& machine, MachinePosition& position);

  // Start a jog at once; the card must be in position (driver::StateError). Velocities in mm/s and distances in mm, by
  // axis, in machine directions; `speed` in mm/s along the path of all axes. Limits of the machine slow a jog down.
  // Throw driver::ArgumentError for no motion, or if an axis is already at the soft limit towards which it would move.
  //
  // Moves up to a soft limit. The speed may be raised up to the limits of the axes, unless the path is too short for
  // that.
  void start(const gcode::Coordinates& velocity);
  // Moves by a distance, or to the first soft limit on the way. The speed may be lowered, and raised again up to
  // `speed`.
  void start(const gcode::Coordinates& distance, double speed);

  // Time for which the card keeps its present speed without a call of moving(), before it begins to stop.
  static constexpr double kAheadSeconds = 0.1;

  // Sets the speed of the current jog along its path, mm/s; returns the new speed, which is within the jog's limits.
  // Has no effect once the jog is stopping.
  double set_speed(double speed);
  // Ramps to a stop.
  void stop();

  // Whether the jog is still in progress. Also sends the next lines, so it must be called several times in
  // kAheadSeconds. When the jog is over, the position is up to date. Throws driver::FaultError, the exceptions of
  // driver::Stream::put(), and driver::StoppedError if a stop was requested; in the last case the card is at rest and
  // the position up to date.
  bool moving();
  // Waits until the jog is over.
  void wait();

 private:
  struct TimeBase {
    std::uint32_t ratio;
    std::uint32_t slew;
  };
  void begin(const JogPath& path, double speed);
  void feed(int most);
  void send_line();
  void set_ratio_at_once(std::uint32_t ratio);
  void finish();

  driver::Card& card_;
  const machine::Machine& machine_;
  MachinePosition& position_;
  std::optional<JogPath> path_;  // while a jog is in progress
  std::optional<driver::Stream> stream_;
  std::uint64_t line_ticks_ = 0;  // feed ticks of each line except the last
  std::uint64_t sent_ticks_ = 0;
  double ratio_ = 1;  // target ratio of the time base
  bool stopping_ = false;
  TimeBase before_{};
};

}  // namespace trammel::run
