// What holds from one line of a program to the next, positions and offsets aside. Internal to the reader.
#pragma once

#include <optional>

#include "trammel/gcode/motion.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

inline constexpr double kMmPerInch = 25.4;

struct ModalState {
  // Modes of a line that has more than axis words, a motion word and F; the motion word aside.
  void set(const WordSet& words);
  // F and what F means.
  void set_feed(const WordSet& words);

  double mm_per_unit() const { return inches ? kMmPerInch : 1; }

  std::optional<int> motion;  // code in tenths; none under G80
  int plane = 170;
  bool inches = false;
  bool absolute = true;
  std::optional<bool> extruder_absolute;  // none until M82 or M83
  bool centre_absolute = false;
  bool inverse_time = false;
  std::optional<double> feed;  // as written, units or 1 a minute
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
