// The arc that rounds a corner of two lines or arcs in a plane, tangent to both. Internal to the planner; pure.
#pragma once

#include <optional>

namespace trammel::planner {

// A motion at the corner, which is the origin of the plane's coordinates.
struct Side {
  double x = 0;  // unit vector: its direction at the corner
  double y = 0;
  double curvature = 0;  // 1/mm; 0: a line; negative: it turns right
  double most = 0;       // mm of the motion that the arc may replace
};

struct Fillet {
  double radius = 0;
  double distance = 0;  // mm from the corner to the arc: the largest distance between the two paths
  double centre_x = 0;
  double centre_y = 0;
  double before = 0;  // mm that the arc replaces, before the corner
  double behind = 0;  // mm that the arc replaces, after the corner
  double sweep = 0;   // radians
  bool clockwise = false;
};

// The largest arc within `tolerance`; empty if the motions leave no room. `sine`: of half the angle between the sides'
// directions, above 0 and below 1.
std::optional<Fillet> fillet(const Side& from, const Side& to, double sine, double tolerance);

}  // namespace trammel::planner
