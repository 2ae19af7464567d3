// The two papers: a function for each group of tables, figures and claims, in the order of the pages; and functions
// shared by the chapters. Units: pulses.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "page.hpp"
#include "paper_lines.hpp"
#include "trammel/chart/chart.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::app::reproduce {

// Reports the completed fraction of a chapter, 0 .. 1.
using Progress = std::function<void(double)>;

// Goldberg & Goldberg, "XY Interpolation Algorithms".
void steer_tables(Page& page, const Progress& progress);
void steer_circles(Page& page, const Progress& progress);
void steer_program(Page& page, const Progress& progress);
void steer_text(Page& page, const Progress& progress);
// Zeng, Zhang & Huang, "A New Linear Interpolation Algorithm".
void one_shot_lines(Page& page, const Progress& progress);
void one_shot_text(Page& page, const Progress& progress);
void one_shot_waves(Page& page, const Progress& progress);
void one_shot_motor(Page& page, const Progress& progress);
void one_shot_bound(Page& page, const Progress& progress);
void one_shot_card(Page& page, const Progress& progress);

// Perpendicular distance from a line of length > 0.
inline double distance(const interpolation::Line& line, const interpolation::Position& p) {
  const auto dx = static_cast<double>(line.end[0] - line.start[0]);
  const auto dy = static_cast<double>(line.end[1] - line.start[1]);
  const auto x = static_cast<double>(p[0] - line.start[0]);
  const auto y = static_cast<double>(p[1] - line.start[1]);
  return std::fabs(dx * y - dy * x) / std::hypot(dx, dy);
}

// The position on a path after all steps of a clock (or, for methods without clocks, after a step).
struct TrackPoint {
  std::uint64_t time;
  interpolation::Position position;
};
using Track = std::vector<TrackPoint>;

// The track from the start on; one-shot methods run at 10 MHz and 5,000 lines per second.
Track track_of(interpolation::Method method, const interpolation::Line& line);
double largest_distance(const interpolation::Line& line, const Track& track);
// A panel of Figure 3: the line, the band of one pulse and the track.
chart::Panel line_panel(std::size_t index, const Track& track, const std::string& label);
// Pixels: wide enough for at least three numbers on either axis.
inline constexpr double kLinePanelWidth = 490;
inline constexpr double kLinePanelHeight = 330;

// The times of an axis's pulses, in clocks; `period`: clocks per unit of the track's time.
std::vector<double> pulse_times(const Track& track, std::size_t axis, double period);
// Shortest and longest interval between two pulses.
struct Spread {
  double least = 0;
  double largest = 0;
};
Spread spread_of(const std::vector<double>& times);

// Series for pictures: a walk, and the ideal curve to which it is compared; and a panel of a plane in pulses, with the
// same scale on both axes.
chart::Series walk_series(const std::string& label, std::vector<chart::Point> points = {});
chart::Series ideal_series(const std::string& label, std::vector<chart::Point> points = {});
chart::Panel plane(const std::string& title, std::vector<chart::Series> series);
// Two waveforms over clocks 0 .. end, x above y.
chart::Panel wave_panel(const std::string& title, double end);
// The waveform of an axis: high from each rising edge to its falling edge; both lists ascend.
chart::Series wave(std::size_t axis, const std::vector<double>& rising, const std::vector<double>& falling, double end);
// An arc about the origin, from angle 0, in steps of two degrees.
std::vector<chart::Point> circle_points(double radius, int degrees);

// The timing of a card at 10 MHz, with which the papers' lines are planned.
driver::CardTiming paper_card();

// Uniform from low to high; the same with every standard library. The modulo's bias is below 2^-40 for the ranges used
// here.
inline std::int64_t uniform(std::mt19937_64& random, std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
}

}  // namespace trammel::app::reproduce
