// The interface of the protocol to the machine: a card (card_machine.hpp) or a test double. Used by one thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trammel/gcode/line_source.hpp"
#include "trammel/gcode/motion.hpp"
#include "trammel/grbl/numbers.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/card_limits.hpp"

namespace trammel::grbl {

// The machine's part of a status report.
struct Live {
  gcode::Coordinates at{};  // machine coordinates, mm
  double speed = 0;         // mm/min, along X Y Z
  bool held = false;        // at rest in a hold
  std::size_t line = 0;     // line of the current section that has begun last; 0: none
  double seconds_left = 0;  // planned duration of the motion that the card has left, s
  bool any_sent = false;    // the card has commands of the current section
  bool probe = false;
  unsigned limits = 0;  // bit n: a limit switch of the machine's axis n is active
};

struct Probed {
  bool tripped = false;
  gcode::Coordinates at{};
};

// The state before a motion's first line.
struct Before {
  gcode::Coordinates place{};        // machine position
  std::map<int, double> parameters;  // as LinuxCNC numbers them
  int spindle = 5;                   // M3, M4 or M5; the outputs already have this state
  double speed = 0;                  // S
};

// The result of a motion. The machine is at rest.
struct End {
  bool stopped = false;  // stopped by stop()
  Alarm alarm = Alarm::kNone;
  std::string message;  // "": no message
  std::optional<Probed> probe;
};

class MachineSide {
 public:
  virtual ~MachineSide() = default;

  virtual const machine::Machine& machine() const = 0;  // with the soft limits now in force
  virtual planner::CardLimits limits() const = 0;
  // Only at rest.
  virtual void set_machine(const machine::Machine& machine) = 0;

  // The state, at most about 20 ms old in motion, and current at rest.
  virtual Live look() = 0;
  // Whether the probe touches now, from a fresh reading.
  virtual bool probe_touches() = 0;
  // Waits for a moment. wait(), run() and home() call set_meanwhile()'s function while they wait.
  virtual void wait() = 0;
  virtual void set_meanwhile(std::function<void()> meanwhile) = 0;

  // May be called at any time, also from within `meanwhile`; takes effect soon.
  virtual void hold(bool hold) = 0;
  virtual void stop() = 0;
  // In percent. Returns the override in force, which the machine file may limit.
  virtual double override_feed(double percent) = 0;
  virtual void override_rapids(double percent) = 0;

  // Plans and executes the lines as they arrive, up to their end.
  virtual End run(gcode::LineSource& lines, const Before& before) = 0;
  // Axes of the machine; empty: all axes that can home.
  virtual End home(const std::vector<std::size_t>& axes) = 0;
  virtual bool can_home() const = 0;
  virtual bool homed() = 0;
  virtual bool has_probe() const = 0;

  // The reason why a machine at rest may not move: a fault that has occurred, or an unknown position.
  virtual End trouble() = 0;
  // Clears the reason; returns the remaining one.
  virtual End unlock() = 0;
};

}  // namespace trammel::grbl
