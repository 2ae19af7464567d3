// Goldberg & Goldberg: the delay and its ramp, and the effect of a zero gradient on lines.
#include "trammel/interpolation/steer_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "chapters.hpp"
#include "trammel/interpolation/steer_delay.hpp"

namespace trammel::app::reproduce {
namespace {

using namespace interpolation;

// The number of comparisons in the listing's loop `while (++i != (feedrate + drag) / 30)`, where i is an int of 16 bits
// that starts at 0, and drag is 0.
unsigned loop_passes(int feedrate) {
  unsigned passes = 0;
  std::uint16_t i = 0;  // the paper's compiler wraps an int; signed overflow is undefined today
  do {
    ++i;
    ++passes;
  } while (i != feedrate / 30);
  return passes;
}

void delay_list(Page& page) {
  page.heading("The delay and its ramp");
  const std::vector<std::int32_t> expected{100, 99, 99, 98, 94, 85, 69, 44, 8, 0};
  SteerDelay delay(300);
  delay.arm();
  std::vector<std::int32_t> drags;
  chart::Series passes{"", chart::colour(1), {}, chart::Mark::kDots, 2.5};
  Csv csv("step,drag,passes");
  for (int step = 0; step < 20; ++step) {
    const std::int32_t drag = delay.drag();
    if (drags.size() < expected.size()) drags.push_back(drag);
    const std::int32_t taken = delay.delay().value_or(-1);
    csv.row("{},{},{}", step, drag, taken);
    passes.points.push_back({static_cast<double>(step), static_cast<double>(taken)});
  }
  page.pass("Delay list", "(feedrate + drag) / 30 passes of a loop; drag falls from 100",
            fmt::format("drag is {}", fmt::join(drags, " ")), drags == expected);
  page.corrected("Delay list, its shape", "falls off exponentially (comment)",
                 "it falls by 1, 0, 1, 4, 9, 16, 25, 36. These are squares, so their sum is a cubic",
                 drags == expected);
  chart::Panel panel{"Delay before each step", {"step of the line"}, {"passes of the loop"}, {passes}};
  panel.y.low = 0;
  panel.y.high = 15;
  page.picture("steer-delay", "Loop passes before each step of a line, feedrate 300",
               chart::grid_of({panel}, 1, 520, 280), csv);
  const std::int32_t slow = SteerDelay(600).delay().value_or(0);
  const std::int32_t fast = SteerDelay(300).delay().value_or(0);
  page.corrected("Feedrate", "the speed, about steps per minute",
                 fmt::format("a larger number makes the delay longer: {} passes at 600, {} at 300", slow, fast),
                 slow > fast);
  page.added(
      "Feedrate + drag below 30", "not mentioned",
      fmt::format("with the 16-bit int of its compiler, the listing's loop makes {} passes at 29, where 0 are "
                  "intended, and {} at 30",
                  loop_passes(29), loop_passes(30)),
      loop_passes(29) == 65'536 && loop_passes(30) == 1 && !SteerDelay(29).delay() && SteerDelay(30).delay() == 1);
  SteerDelay circle(300);
  const std::int32_t first = circle.delay().value_or(0);
  const std::int32_t second = circle.delay().value_or(0);
  page.added("Ramp of a circle", "a ramp is useful where inertia matters (mentioned only for lines)",
             fmt::format("only the line routine starts the ramp, and the program runs one command. A circle therefore "
                         "begins at full speed: {} and {} passes before its first two steps at feedrate 300",
                         first, second),
             first == 10 && second == 10);
}

// Whether Table 2 reaches the end of a line, with F = -dy x + dx y and the gradient (-dy, dx), clockwise: the walk
// follows (dx, dy).
bool table_two_meets(std::int64_t dx, std::int64_t dy) {
  Point at{0, 0};
  for (std::int64_t step = 0; step < 4 * (std::abs(dx) + std::abs(dy)); ++step) {
    const std::int64_t f = dx * at.y - dy * at.x;
    const Step next = SteerTable::choose(ConicState<std::int64_t>{f, -dy, dx, 0, 0, true});
    at.x += next.direction[0];
    at.y += next.direction[1];
    if (at == Point{dx, dy}) return true;
  }
  return false;
}

void zero_gradient(Page& page) {
  page.heading("A gradient of zero");
  constexpr std::array<std::array<std::int64_t, 2>, 4> kParallel{{{10, 0}, {0, 10}, {-10, 0}, {0, -10}}};
  unsigned by_table = 0;
  unsigned by_line_routine = 0;
  Csv csv("dx,dy,met_by_table_2,met_with_direction_bits");
  for (const auto& [dx, dy] : kParallel) {
    const bool met = table_two_meets(dx, dy);
    SteerLine walk(make_line({0, 0}, {dx, dy}));
    bool straight = true;
    while (!walk.done()) {
      walk.next();
      const Position p = walk.position();
      straight = straight && p[0] * dy == p[1] * dx;
    }
    const bool direct = straight && walk.position() == Position{dx, dy, 0, 0};
    by_table += met;
    by_line_routine += direct;
    csv.row("{},{},{:d},{:d}", dx, dy, met, direct);
  }
  page.added(
      "Lines by Table 2", "the table is given for circles",
      fmt::format(
          "zero counts as positive in the table. Of the 4 lines along an axis, {} reach their end if the signs of the "
          "gradient choose the direction, and {} if the signs of the displacement do, as in the line routine",
          by_table, by_line_routine),
      by_table < 4 && by_line_routine == 4);
  page.data("steer-zero-gradient", "The four lines", csv);
}

}  // namespace

void steer_program(Page& page, const Progress& progress) {
  delay_list(page);
  progress(0.5);
  zero_gradient(page);
}

}  // namespace trammel::app::reproduce
