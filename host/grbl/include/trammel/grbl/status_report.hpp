// The answer to '?': "<Idle|MPos:0.000,0.000,0.000|FS:0,0>", with WCO and Ov in Grbl's cadence. Not thread-safe.
#pragma once

#include <string>

#include "trammel/gcode/motion.hpp"

namespace trammel::grbl {

struct Report {
  std::string state = "Idle";  // with its sub-state, "Hold:0"
  bool busy = false;           // Run, Jog, Home, Hold, Door: WCO and Ov come more seldom
  std::string position;        // "0.000,0.000,0.000", of the machine
  std::string work_position;
  std::string offset;  // WCO
  unsigned blocks_free = 0;
  std::size_t bytes_free = 0;
  int line = 0;
  double feed = 0;   // in the report's units
  double speed = 0;  // S
  std::string pins;  // "XP"
  int feed_override = 100;
  int rapid_override = 100;
  int spindle_override = 100;
  std::string accessories;  // "SFM"
};

class StatusReport {
 public:
  // `mask`: $10; 1: MPos in place of WPos, 2: Bf.
  std::string text(const Report& report, unsigned mask);
  // They come with the next report, Ov with the one after WCO.
  void offsets_changed() { offset_in_ = 0; }
  void overrides_changed() { overrides_in_ = 0; }

 private:
  unsigned offset_in_ = 0;
  unsigned overrides_in_ = 0;
};

}  // namespace trammel::grbl
