// Geometry of G2 and G3. Internal to the reader.
#pragma once

#include <optional>

#include "problem.hpp"

namespace trammel::gcode {

struct PlanePoint {
  double x;
  double y;
};

// An arc's words in mm, in the axes of its plane.
struct ArcWords {
  PlanePoint start;
  PlanePoint end;
  bool clockwise;
  std::optional<double> centre_x;  // from the start, or absolute (G90.1): see `centre_absolute`
  std::optional<double> centre_y;
  bool centre_absolute;
  std::optional<double> radius;  // negative: the arc of more than half a turn
};

struct ArcCentre {
  PlanePoint centre;
  bool full_circle;
};

// False, with a problem, when the words describe no arc. Start and end radius may differ by 0.005 mm or by 0.1 %,
// whichever is more, and by 0.5 mm at most (Grbl's rule). Nothing but + - * / and square roots, which are the same on
// every machine.
bool find_centre(const ArcWords& words, ArcCentre& found, Problem& problem);

}  // namespace trammel::gcode
