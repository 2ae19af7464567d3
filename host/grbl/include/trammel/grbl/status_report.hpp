// The answer to '?': "<Idle|MPos:0.000,0.000,0.000|FS:0,0>", with WCO and Ov at Grbl's intervals. Not thread-safe.
#pragma once

#include <string>

#include "trammel/gcode/motion.hpp"

namespace trammel::grbl {

struct Report {
  std::string state = "Idle";  // with its sub-state, "Hold:0"
  bool busy = false;           // Run, Jog, Home, Hold or Door: longer intervals between WCO and between Ov
  std::string position;        // machine position, "0.000,0.000,0.000"
  std::string work_position;
  std::string offset;  // WCO
  unsigned blocks_free = 0;
  std::size_t bytes_free = 0;
  int line = 0;
  double feed = 0;   // in the units of the report
  double speed = 0;  // S
  std::string pins;  // "XP"
  int feed_override = 100;
  int rapid_override = 100;
  int spindle_override = 100;
  std::string accessories;  // "SFM"
};

class StatusReport {
 public:
  // `mask`: $10; bit value 1: MPos in place of WPos, 2: Bf.
  std::string text(const Report& report, unsigned mask);
  // The next report contains WCO, or Ov; if both are due, Ov is in the report after WCO.
  void offsets_changed() { offset_in_ = 0; }
  void overrides_changed() { overrides_in_ = 0; }

 private:
  unsigned offset_in_ = 0;
  unsigned overrides_in_ = 0;
};

}  // namespace trammel::grbl
