// The modes that stay in force from one line to the next, without positions and offsets. Internal to the reader.
#pragma once

#include <optional>

#include "trammel/gcode/motion.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

inline constexpr double kMmPerInch = 25.4;

struct ModalState {
  // Sets the modes of a line that has more than axis words, a motion word and F. The motion word is not set here.
  void set(const WordSet& words);
  // Sets F and the meaning of F.
  void set_feed(const WordSet& words);

  double mm_per_unit() const { return inches ? kMmPerInch : 1; }

  std::optional<int> motion;  // code in tenths; empty under G80
  int plane = 170;
  bool inches = false;
  bool absolute = true;
  std::optional<bool> extruder_absolute;  // empty until M82 or M83
  bool centre_absolute = false;
  bool inverse_time = false;
  std::optional<double> feed;  // as written: units per minute, or 1/minute under G93
  bool feed_in_inches = false;
  bool feed_later = false;  // depends on a probe that has not run yet
  PathControl path_control = PathControl::kContinuous;
  double tolerance = 0;           // mm
  bool retract_to_start = false;  // G98
  double spindle_speed = 0;       // S
  int spindle = 50;               // M3, M4 or M5, in tenths

 private:
  void set_path_control(const WordSet& words);
};

}  // namespace trammel::gcode
