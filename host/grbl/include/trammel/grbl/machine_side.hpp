// What the protocol needs of the machine: the card (card_machine.hpp), or a test's. One thread.
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

// What a status report shows of the machine.
struct Live {
  gcode::Coordinates at{};  // machine coordinates, mm
  double speed = 0;         // mm/min, along X Y Z
  bool held = false;        // stands in a hold
  std::size_t line = 0;     // of the section under way, that has begun last; 0: none
  double seconds_left = 0;  // of motion that the card has, as planned
  bool any_sent = false;    // of the section
  bool probe = false;
  unsigned limits = 0;  // bit n: the switch of the machine's axis n
};

struct Probed {
  bool tripped = false;
  gcode::Coordinates at{};
};

// What holds before a motion's first line.
struct Before {
  gcode::Coordinates place{};        // where the machine stands
  std::map<int, double> parameters;  // as LinuxCNC numbers them
  int spindle = 5;                   // M3, M4 or M5; the outputs are so already
  double speed = 0;                  // S
};

// How a motion has ended; the machine stands.
struct End {
  bool stopped = false;  // by stop()
  Alarm alarm = Alarm::kNone;
  std::string message;  // "": nothing to tell
  std::optional<Probed> probe;
};

class MachineSide {
 public:
  virtual ~MachineSide() = default;

  virtual const machine::Machine& machine() const = 0;  // with the soft limits that hold now
  virtual planner::CardLimits limits() const = 0;
  // Only while it stands.
  virtual void set_machine(const machine::Machine& machine) = 0;

  // As it was some 20 ms ago at the most; where the machine stands, as it is.
  virtual Live look() = 0;
  // Whether the probe touches now.
  virtual bool probe_touches() = 0;
  // Waits for a moment; calls set_meanwhile()'s function, as run() and home() do while they wait.
  virtual void wait() = 0;
  virtual void set_meanwhile(std::function<void()> meanwhile) = 0;

  // At any time, also from within `meanwhile`; in force soon.
  virtual void hold(bool hold) = 0;
  virtual void stop() = 0;
  // Percent. Gives back what is in force: the machine file may not allow as much.
  virtual double override_feed(double percent) = 0;
  virtual void override_rapids(double percent) = 0;

  // Plans and moves along the lines as they come, up to their end.
  virtual End run(gcode::LineSource& lines, const Before& before) = 0;
  // Axes of the machine; none: all that can.
  virtual End home(const std::vector<std::size_t>& axes) = 0;
  virtual bool can_home() const = 0;
  virtual bool homed() = 0;
  virtual bool has_probe() const = 0;

  // What keeps the machine from moving while it stands: a fault that has come since, or a place that is not known.
  virtual End trouble() = 0;
  // Clears it; gives back what stays.
  virtual End unlock() = 0;
};

}  // namespace trammel::grbl
