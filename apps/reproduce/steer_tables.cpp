// Goldberg & Goldberg, Tables 1 to 3: the line, the 16 entries, the circle.
#include <fmt/format.h>

#include <cstdlib>
#include <string>

#include "chapters.hpp"
#include "trammel/interpolation/steer_program.hpp"

namespace trammel::app::reproduce {
namespace {

using namespace interpolation;

long long whole(Deviation value) { return static_cast<long long>(value); }

void table_one(Page& page) {
  page.heading("Table 1: the line from (0,0) to (3,-7)");
  // F and the axis of every row, as printed.
  constexpr std::array<int, 10> kF{-4, -1, 2, -5, -2, 1, -6, -3, 0, 3};
  const std::string axes = "yyxyyxyyyx";
  const Line line = make_line({0, 0}, {3, -7});
  SteerLine walk(line);
  Csv csv("step,f,x2,y2,axis,direction,x,y");
  chart::Series path = walk_series("STEER", {{0, 0}});
  unsigned equal = 0;
  bool zero_steps_y = false;
  for (std::size_t row = 0; !walk.done(); ++row) {
    const long long f = whole(walk.deviation());
    const Position before = walk.position();
    const Step step = walk.next();
    const bool in_x = step.direction[0] != 0;
    if (row < kF.size() && f == kF[row] && (in_x ? 'x' : 'y') == axes[row]) ++equal;
    if (f == 0) zero_steps_y = !in_x;
    csv.row("{},{},{},{},{},{},{},{}", row, f, std::abs(before[0]), std::abs(before[1]), in_x ? 'x' : 'y',
            in_x ? step.direction[0] : step.direction[1], walk.position()[0], walk.position()[1]);
    path.points.push_back({static_cast<double>(walk.position()[0]), static_cast<double>(walk.position()[1])});
  }
  page.pass("Table 1", "10 rows of F, x2, y2 and the step",
            fmt::format("{} of 10 rows equal; the line ends at (3,-7)", equal),
            equal == 10 && walk.time() == 10 && walk.position() == line.end);
  page.corrected("Line, step rule in the text", "y steps when F becomes negative",
                 "y also steps at F = 0 (row 8 of Table 1; the listing tests F > 0)", zero_steps_y);
  page.picture("steer-table-1", "Table 1 as a path",
               chart::grid_of({plane("(0,0) to (3,-7)", {ideal_series("line", {{0, 0}, {3, -7}}), path})}, 1, 320, 420),
               csv);
}

void table_two(Page& page) {
  page.heading("Table 2: the 16 entries");
  // As printed, rows D F DX DY from 0000 to 1111.
  constexpr std::array<std::array<int, 2>, 16> kPrinted{{{0, -1},
                                                         {-1, 0},
                                                         {1, 0},
                                                         {0, 1},
                                                         {1, 0},
                                                         {0, -1},
                                                         {0, 1},
                                                         {-1, 0},
                                                         {-1, 0},
                                                         {0, 1},
                                                         {0, -1},
                                                         {1, 0},
                                                         {0, 1},
                                                         {1, 0},
                                                         {-1, 0},
                                                         {0, -1}}};
  Csv csv("d,f,a,b,x_step,y_step,turns,side");
  unsigned equal = 0;
  unsigned counter_clockwise_at_zero = 0;
  unsigned sound = 0;
  for (unsigned row = 0; row < 16; ++row) {
    const bool d = (row & 8U) != 0;
    const bool outside = (row & 4U) != 0;
    const int sign_x = (row & 2U) != 0 ? 1 : -1;
    const int sign_y = (row & 1U) != 0 ? 1 : -1;
    const Step step = SteerTable::choose(ConicState<std::int64_t>{outside ? 0 : -1, sign_x, sign_y, 1, 1, d});
    const int x = step.direction[0];
    const int y = step.direction[1];
    if (x == kPrinted[row][0] && y == kPrinted[row][1]) ++equal;
    // The rotation of the radius (sign_x, sign_y) by the step: positive is counter-clockwise.
    const int turn = sign_x * y - sign_y * x;
    const bool outward = sign_x * x + sign_y * y > 0;
    if (!d && turn > 0) ++counter_clockwise_at_zero;
    if (turn == (d ? -1 : 1) && outward == !outside) ++sound;
    csv.row("{:d},{:d},{:d},{:d},{},{},{},{}", d, outside, sign_x > 0, sign_y > 0, x, y,
            turn > 0 ? "counter-clockwise" : "clockwise", outward ? "outward" : "inward");
  }
  page.pass("Table 2", "16 steps by D, F, DX, DY", fmt::format("{} of 16 entries equal", equal), equal == 16);
  page.pass(
      "Table 2, corrections", "the sign of F and the quadrant choose the correction",
      fmt::format(
          "{} of 16 steps go round the centre in the direction that D selects, inward for F >= 0 and outward for F < 0",
          sound),
      sound == 16);
  page.corrected("Direction D", "0 = clockwise, 1 = counter-clockwise (text)",
                 fmt::format("with x to the right and y up, {} of the 8 entries for D = 0 turn counter-clockwise",
                             counter_clockwise_at_zero),
                 counter_clockwise_at_zero == 8);
  page.data("steer-table-2", "All entries", csv);
}

// As printed.
constexpr std::array<const char*, 12> kTableThreeColumns{"x2", "y2", "radius", "fxy", "dx", "dy",
                                                         "f",  "a",  "b",      "d",   "xo", "yo"};
constexpr std::array<std::array<int, 12>, 26> kTableThree{
    {{25, 0, 25, 0, 50, 0, 1, 1, 1, 0, -1, 0},    {24, 0, 25, -49, 48, 0, 0, 1, 1, 0, 0, 1},
     {24, 1, 25, -48, 48, 2, 0, 1, 1, 0, 0, 1},   {24, 2, 25, -45, 48, 4, 0, 1, 1, 0, 0, 1},
     {24, 3, 25, -40, 48, 6, 0, 1, 1, 0, 0, 1},   {24, 4, 25, -33, 48, 8, 0, 1, 1, 0, 0, 1},
     {24, 5, 25, -24, 48, 10, 0, 1, 1, 0, 0, 1},  {24, 6, 25, -13, 48, 12, 0, 1, 1, 0, 0, 1},
     {24, 7, 25, 0, 48, 14, 1, 1, 1, 0, -1, 0},   {23, 7, 25, -47, 46, 14, 0, 1, 1, 0, 0, 1},
     {23, 8, 25, -32, 46, 16, 0, 1, 1, 0, 0, 1},  {23, 9, 25, -15, 46, 18, 0, 1, 1, 0, 0, 1},
     {23, 10, 25, 4, 46, 20, 1, 1, 1, 0, -1, 0},  {22, 10, 25, -41, 44, 20, 0, 1, 1, 0, 0, 1},
     {22, 11, 25, -20, 44, 22, 0, 1, 1, 0, 0, 1}, {22, 12, 25, 3, 44, 24, 1, 1, 1, 0, -1, 0},
     {21, 12, 25, -40, 42, 24, 0, 1, 1, 0, 0, 1}, {21, 13, 25, -15, 42, 26, 0, 1, 1, 0, 0, 1},
     {21, 14, 25, 12, 42, 28, 1, 1, 1, 0, -1, 0}, {20, 14, 25, -29, 40, 28, 0, 1, 1, 0, 0, 1},
     {20, 15, 25, 0, 40, 30, 1, 1, 1, 0, -1, 0},  {19, 15, 25, -39, 38, 30, 0, 1, 1, 0, 0, 1},
     {19, 16, 25, -8, 38, 32, 0, 1, 1, 0, 0, 1},  {19, 17, 25, 25, 38, 34, 1, 1, 1, 0, -1, 0},
     {18, 17, 25, -12, 36, 34, 0, 1, 1, 0, 0, 1}, {13, 18, 25, 23, 36, 36, 1, 1, 1, 0, -1, 0}}};

void table_three(Page& page) {
  page.heading("Table 3: the circle of radius 25");
  SteerProgram walk({25, 0}, 25, false);
  Csv csv("step,x,y,f,dx,dy,x_step,y_step");
  chart::Series path = walk_series("STEER");
  unsigned equal = 0;  // equal numbers among the 25 x 12 before the last row
  std::string differ;  // differing columns of the last row
  Point last;
  std::uint64_t steps = 0;
  do {
    const Point at = walk.position();
    const std::int64_t f = walk.deviation();
    const Step step = walk.next();
    const std::array<std::int64_t, 12> row{at.x,   at.y,      25,        f, 2 * at.x,          2 * at.y,
                                           f >= 0, at.x >= 0, at.y >= 0, 0, step.direction[0], step.direction[1]};
    for (std::size_t column = 0; column < row.size() && steps < kTableThree.size(); ++column) {
      const bool same = row[column] == kTableThree[steps][column];
      if (steps < 25) equal += same;
      if (steps == 25 && !same) differ += kTableThreeColumns[column];
    }
    if (steps == 25) last = at;
    csv.row("{},{},{},{},{},{},{},{}", steps, at.x, at.y, f, 2 * at.x, 2 * at.y, step.direction[0], step.direction[1]);
    path.points.push_back({static_cast<double>(at.x), static_cast<double>(at.y)});
    ++steps;
  } while (!walk.back() && steps < 1000);
  path.points.push_back(path.points.front());
  page.pass("Table 3, rows 0 to 24", "25 rows of 12 columns, x2 to yo", fmt::format("{} of 300 numbers equal", equal),
            equal == 300);
  page.corrected(
      "Table 3, last row", "x = 13 with y = 18, F = 23, DX = 36",
      fmt::format("x = {}, because F = 23 and DX = 36 fit only ({},{}); the other 11 columns of the row are correct",
                  last.x, last.x, last.y),
      differ == "x2" && last == Point{18, 18});
  page.pass("Table 3, full circle", "returns to (25,0)", fmt::format("returns after {} steps", steps), steps == 200);
  page.picture(
      "steer-table-3", "The full circle; Table 3 lists only its beginning",
      chart::grid_of({plane("Radius 25, D = 0", {ideal_series("circle", circle_points(25, 360)), path})}, 1, 480, 500),
      csv);
}

}  // namespace

void steer_tables(Page& page, const Progress& progress) {
  table_one(page);
  progress(0.3);
  table_two(page);
  progress(0.6);
  table_three(page);
}

}  // namespace trammel::app::reproduce
