// Claims of both papers in words only: about notation, other methods, and numbers that a formula gives.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/interpolation/steer_program.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::app::reproduce {
namespace {

using namespace interpolation;

// A program as read by the host's reader.
struct GcodeText {
  unsigned lines = 0;  // number of line motions
  unsigned arcs = 0;
  bool refused = false;
  gcode::Coordinates end{};
};

GcodeText read_gcode(const std::string& text) {
  gcode::TextLines source(text, "paper.ngc");
  const machine::Machine machine = machine::default_machine();
  gcode::Reader reader(source, machine);
  GcodeText result;
  for (gcode::Motion motion; reader.next(motion);) {
    result.lines += motion.kind == gcode::MotionKind::kLine;
    result.arcs += motion.kind == gcode::MotionKind::kArc;
    if (motion.kind != gcode::MotionKind::kEnd) result.end = motion.target;
  }
  result.refused = reader.error().has_value();
  return result;
}

void notation(Page& page) {
  const GcodeText paper = read_gcode("G21 G90 F100\nG01 (0,0,10,20) 100\n");
  const GcodeText words = read_gcode("G21 G90\nG01 X10 Y20 F100\n");
  page.corrected(
      "EIA notation", "G01 (X1, Y1, X3, Y3) f is what the EIA recommends",
      "the notation is the program's own. RS274/NGC, which the host reads, has a letter before each number and no "
      "starting point. The host refuses the paper's line, and reads G01 X10 Y20 F100 as one line to (10,20)",
      paper.refused && !words.refused && words.lines == 1 && words.end[0] == 10 && words.end[1] == 20);
  const GcodeText line = read_gcode("G21 G90\nG1 X10 Y20 F100\n");
  const GcodeText clockwise = read_gcode("G21 G90\nG2 X10 Y0 I5 J0 F100\n");
  const GcodeText unknown = read_gcode("G21 G90\nG99.5 X10 Y0 I5 J0 F100\n");
  page.corrected("Listing, lines 36 and 37", "G01 is a line, every other code a circle",
                 "these two lines draw the circle of G03 for G02, G00 and any misprint, because the direction is a "
                 "separate number. The host reads G1 as a line and G2 as an arc, and refuses an unknown code",
                 line.lines == 1 && line.arcs == 0 && clockwise.arcs == 1 && clockwise.lines == 0 && unknown.refused &&
                     unknown.lines + unknown.arcs == 0);
}

// "The average velocities of point by point comparison method were hard to control."
void average_velocity(Page& page) {
  double least = 1;  // pulses along the line per step
  double largest = 0;
  double off = 0;  // deviation of one-shot lines from the requested path speed, clocks
  constexpr std::uint64_t kSpeed = 200'000;
  for (const PaperLine& each : kPaperLines) {
    const Line line = each.line();
    const driver::Displacement p{line.end[0] - line.start[0], line.end[1] - line.start[1]};
    const double length = std::hypot(static_cast<double>(p[0]), static_cast<double>(p[1]));
    const double by_point = length / static_cast<double>(track_of(Method::kPointByPoint, line).size() - 1);
    least = std::min(least, by_point);
    largest = std::max(largest, by_point);
    const std::uint64_t clocks = driver::plan_line(paper_card(), p, driver::PathSpeed{kSpeed, 1}).clocks();
    off = std::max(off, std::fabs(static_cast<double>(clocks) - length * 10'000'000 / kSpeed));
  }
  page.pass("Average velocity", "the average velocity of point by point is hard to control (conclusion)",
            fmt::format("at a constant step rate the velocity depends on the direction: {:.3f} to {:.3f} pulses per "
                        "step over Lines 1 to 8. One-shot lines planned for a speed along the path last as long as "
                        "this speed requires, to within one clock per line",
                        least, largest),
            least < 0.72 && largest == 1 && off < 1);
}

// "There were no errors in the calculation": true for the products. The generators get a quotient.
void no_errors(Page& page) {
  unsigned axes = 0;
  unsigned frequencies = 0;  // frequencies that are not an integer number of 2^-40 pulses per clock
  unsigned periods = 0;      // periods that are not an integer number of clocks
  bool rounded = true;
  for (const PaperLine& each : kPaperLines) {
    const Line line = each.line();
    const driver::Displacement p{line.end[0] - line.start[0], line.end[1] - line.start[1]};
    const driver::OneShotPart part = driver::plan_line_clocks(paper_card(), p, kPaperClocks).part(0);
    for (std::size_t a = 0; a < 2; ++a) {
      if (p[a] == 0) continue;
      ++axes;
      const auto pulses = static_cast<std::uint64_t>(std::abs(p[a]));
      const std::uint64_t wanted = pulses << 40U;  // required frequency times clocks
      const std::uint64_t given = part.frequency[a] * kPaperClocks;
      frequencies += given != wanted;
      rounded = rounded && 2 * (given > wanted ? given - wanted : wanted - given) <= kPaperClocks;
      periods += kPaperClocks % pulses != 0;
    }
  }
  page.corrected(
      "No errors in the calculation", "v_x, v_y, p_x and p_y are integers, so there are no errors",
      fmt::format("true only of these products. Of the {} moving axes of Lines 1 to 8, {} have a frequency "
                  "that the card rounds to 2^-40 pulses per clock. For {} axes the period f / v is not a whole "
                  "number of clocks, which a timer needs",
                  axes, frequencies, periods),
      axes == 15 && frequencies == 15 && periods > 0 && rounded);
}

void references(Page& page) {
  page.open("Method in polar coordinates [9]", "its error is high and its operation complex",
            "the paper gives neither the rule of this method nor a figure");
  const Line line = kPaperLines[0].line();
  const Track four = track_of(Method::kPointByPoint, line);
  const Track eight = track_of(Method::kMinDeviation8, line);
  page.pass("Method in 8 directions [10]", "high precision and speed, compared with point by point in 4 directions",
            fmt::format(
                "the paper does not give the rule of [10]. On Line 1 minimum deviation in 8 directions takes {} steps "
                "with an error of {:.3f} pulses, point by point {} steps with {:.3f} pulses",
                eight.size() - 1, largest_distance(line, eight), four.size() - 1, largest_distance(line, four)),
            eight.size() < four.size() && largest_distance(line, eight) < largest_distance(line, four));
}

// (13) to (20) at every clock of Line 1, in pulses: round() compared with the exact displacements. (15) and (16) are
// (13) and (14) with y = k x inserted; (17) and (18) are those divided by k.
void numbering(Page& page) {
  const Line line = kPaperLines[0].line();
  const Track track = track_of(Method::kOneShot, line);
  const auto px = static_cast<double>(line.end[0]);
  const auto py = static_cast<double>(line.end[1]);
  const double k = py / px;
  std::size_t next = 0;
  Position at = line.start;
  unsigned hold = 0;
  for (std::uint64_t clock = 0; clock <= kPaperClocks; ++clock) {
    if (next < track.size() && track[next].time == clock) at = track[next++].position;
    const double x = px * static_cast<double>(clock) / static_cast<double>(kPaperClocks);
    const double y = py * static_cast<double>(clock) / static_cast<double>(kPaperClocks);
    const auto within = [](double exact, double rounded, double half) {
      return exact < rounded + half && exact >= rounded - half;
    };
    const double on_line = static_cast<double>(at[1]) / k;  // x_t' of (12)
    hold += within(y, static_cast<double>(at[1]), 0.5) && within(k * x, k * on_line, 0.5) &&
            within(x, on_line, 0.5 / k) && within(x, static_cast<double>(at[0]), 0.5) &&
            std::fabs(static_cast<double>(at[0]) - on_line) < 0.5 + 0.5 / k;
  }
  page.corrected(
      "Numbers of formulas", "(13) and (14) give (13) and (14), which give (17) and (18); -1 < x_i - x_i < 1",
      fmt::format("(13) and (14) give (15) and (16), which give (17) and (18), and the last difference is x_t - x_t'. "
                  "With these corrections, (13) to (24) hold in {} of {} clocks of Line 1",
                  hold, kPaperClocks + 1),
      hold == kPaperClocks + 1);
}

void coarse_stage(Page& page) {
  const GcodeText cubic = read_gcode("G21 G90 F100\nG5 X30 Y0 I10 J10 P-10 Q10\n");
  const GcodeText quadratic = read_gcode("G21 G90 F100\nG5.1 X30 Y0 I15 J15\n");
  const GcodeText arc = read_gcode("G21 G90 F100\nG3 X-20 Y0 I-10 J0\n");
  page.corrected(
      "Coarse stage", "most interpolation of arcs, splines and NURBS makes short lines first",
      fmt::format("true of the host's splines: a G5 becomes {} lines, a G5.1 {}. An arc stays one command ({} "
                  "lines), because the card has generators for arcs. The host has no B-splines or NURBS",
                  cubic.lines, quadratic.lines, arc.lines),
      cubic.lines > 10 && quadratic.lines > 10 && arc.lines == 0 && arc.arcs == 1 && !cubic.refused &&
          !quadratic.refused && !arc.refused);
}

}  // namespace

void steer_text(Page& page, const Progress& /*progress*/) {
  page.heading("Claims without a table or figure");
  notation(page);
  page.open("Speed of the program", "both algorithms are fast enough for real-time applications",
            "the paper names neither a processor nor a rate, so there is nothing to compare with");
}

void one_shot_text(Page& page, const Progress& /*progress*/) {
  page.heading("Claims without a table or figure");
  average_velocity(page);
  no_errors(page);
  references(page);
  coarse_stage(page);
  numbering(page);
}

}  // namespace trammel::app::reproduce
