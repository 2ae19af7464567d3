// Jogging: axes moved by hand, one or several at once, for as long as somebody asks for it or by a distance. Every jog
// is one path that ends at rest before the first soft limit, so nothing the host does or leaves undone leads beyond it.
// Its feed is sent at once, its geometry in short lines, a little more than a stop ahead: where no more come, since the
// host has died, the card's under-run hold ramps to a stop on the path. On a card without it the path is sent whole.
//
// The time base makes what the operator asks for on the way: another speed is another ratio, a stop is a hold; each is
// one write to the card, in force some clocks later, and ramped with half of each axis's acceleration at most. While a
// jog is under way the card's ratio, slew and hold are the jog's; then they are as before. Not thread-safe.
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
  // The card is configured for the machine, and `position` is where it stands. All must outlive the jog; nobody else
  // moves the card meanwhile.
  Jog(driver::Card& card, const machine::Machine& machine, MachinePosition& position);

  // Begin at once; the card must be in position (driver::StateError). Velocities and distances by axis, mm/s and mm,
  // machine directions; `speed` along the path of all axes, mm/s. Limits slow a jog down. Throw driver::ArgumentError
  // for no motion, and where an axis stands at the soft limit that it would go to.
  //
  // Up to a soft limit; the speed may be raised up to what the axes allow, unless the path is too short for that.
  void start(const gcode::Coordinates& velocity);
  // By a distance, or to the first soft limit on the way; the speed may be lowered, and raised again up to `speed`.
  void start(const gcode::Coordinates& distance, double speed);

  // How long the card goes on at the speed that it has when nobody calls moving(), before it begins to stop.
  static constexpr double kAheadSeconds = 0.1;

  // Of the jog under way, along its path, mm/s; gives back what it will be, within its limits. Not once it stops.
  double set_speed(double speed);
  // Ramps to a stop.
  void stop();

  // Whether it is under way still; sends what is to come next, so it must be called several times in kAheadSeconds.
  // When it is over the position is known. Throws driver::FaultError, what driver::Stream::put() throws, and, at rest
  // with the position known, driver::StoppedError where somebody has asked the card for a stop.
  bool moving();
  // Until it is over.
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
  std::optional<JogPath> path_;  // while one is under way
  std::optional<driver::Stream> stream_;
  std::uint64_t line_ticks_ = 0;  // of each line but the last
  std::uint64_t sent_ticks_ = 0;
  double ratio_ = 1;  // that the time base goes to
  bool stopping_ = false;
  TimeBase before_{};
};

}  // namespace trammel::run
