// Geometry of G2 and G3. Internal to the reader.
#pragma once

#include <optional>

#include "problem.hpp"

namespace trammel::gcode {

struct PlanePoint {
  double x;
  double y;
};

// The words of an arc in mm, along the axes of its plane.
struct ArcWords {
  PlanePoint start;
  PlanePoint end;
  bool clockwise;
  std::optional<double> centre_x;  // from the start, or absolute (G90.1): see `centre_absolute`
  std::optional<double> centre_y;
  bool centre_absolute;
  std::optional<double> radius;  // negative: the arc is longer than half a turn
};

struct ArcCentre {
  PlanePoint centre;
  bool full_circle;
};

// False, with a problem, if the words describe no arc. Start and end radius may differ by 0.005 mm or by 0.1 %,
// whichever is more, but by 0.5 mm at most (Grbl's rule). Uses + - * / and square roots only, which are the same on
// every host.
bool find_centre(const ArcWords& words, ArcCentre& found, Problem& problem);

}  // namespace trammel::gcode
