// The arc that rounds a corner of two lines or arcs in a plane, tangent to both. Internal to the planner; pure.
#pragma once

#include <optional>

namespace trammel::planner {

// A motion at the corner, which is the origin of the plane's coordinates.
struct Side {
  double x = 0;  // unit vector, the way that it goes there
  double y = 0;
  double curvature = 0;  // 1/mm; 0: a line, below 0: it turns to the right
  double most = 0;       // mm along it that may be taken
};

struct Fillet {
  double radius = 0;
  double distance = 0;  // of the corner from it: how far both paths are from each other
  double centre_x = 0;
  double centre_y = 0;
  double before = 0;  // mm along the motions that it takes the place of
  double behind = 0;
  double sweep = 0;  // radians
  bool clockwise = false;
};

// The largest one within `tolerance`; none where the arcs leave no room. `sine`: of half the angle between the sides'
// directions, above 0 and below 1.
std::optional<Fillet> fillet(const Side& from, const Side& to, double sine, double tolerance);

}  // namespace trammel::planner
