#include "trammel/interpolation/arc_end.hpp"

namespace trammel::interpolation {

int quadrant(const Point& p) {
  if (p.y >= 0) return p.x >= 0 ? 0 : 1;
  return p.x >= 0 ? 3 : 2;
}

unsigned quadrant_changes(const Point& start, const Point& end, bool clockwise) {
  const int turn = clockwise ? -1 : 1;
  const int changes = (turn * (quadrant(end) - quadrant(start)) + 4) % 4;
  if (changes != 0) return static_cast<unsigned>(changes);
  if (start == end) return 4;
  // Both in one quadrant: the sign of the cross product tells which one comes first.
  const Deviation cross = static_cast<Deviation>(start.x) * end.y - static_cast<Deviation>(start.y) * end.x;
  return turn * cross < 0 ? 4 : 0;
}

}  // namespace trammel::interpolation
