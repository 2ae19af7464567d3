// Zeng, Zhang & Huang: the claim that the motor vibrates less, tested with a simulated two-phase stepper.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "trammel/measure/motor.hpp"

namespace trammel::app::reproduce {
namespace {

using namespace interpolation;
namespace measure = measure;

measure::Trace trace_of(Method method, const Line& line) {
  measure::Trace trace;
  trace.clear(2, line.start);
  auto walk = make_interpolator(method, line);
  walk.run([&](const Step& step, const auto& state) { trace.add(state.time(), step.direction); });
  trace.finish(walk.total_time());
  return trace;
}

}  // namespace

namespace {

struct Comparison {
  std::vector<double> speeds;
  std::vector<std::vector<measure::Vibration>> sweeps;  // point by point, one-shot
  double ripple(std::size_t method, std::size_t speed) const { return 100 * sweeps[method][speed].rms_ripple; }
  bool lost(std::size_t method, std::size_t speed) const { return sweeps[method][speed].lost_steps; }
};

constexpr std::array<const char*, 2> kNames{"point by point", "one-shot"};

// Ripple over speed; at speeds with lost steps, a cross at the bottom instead.
chart::Panel ripple_panel(const Comparison& found) {
  chart::Panel panel{"Rms speed ripple of the motors", {"pulses/s along the path", true}, {"% of the speed", true}, {}};
  panel.y.low = 0.1;
  panel.y.high = 1000;
  for (std::size_t m = 0; m < kNames.size(); ++m) {
    chart::Series ripple{kNames[m], chart::colour(1 - m), {}};
    chart::Series lost{std::string("steps lost, ") + kNames[m], chart::colour(1 - m), {}, chart::Mark::kCrosses, 3};
    const auto flush = [&] {
      if (!ripple.points.empty()) panel.series.push_back(ripple);
      ripple.points.clear();
      ripple.label.clear();
    };
    for (std::size_t s = 0; s < found.speeds.size(); ++s) {
      if (!found.lost(m, s)) {
        ripple.points.push_back({found.speeds[s], found.ripple(m, s)});
        continue;
      }
      flush();
      lost.points.push_back({found.speeds[s], m == 0 ? 0.17 : 0.13});
    }
    flush();
    if (!lost.points.empty()) panel.series.push_back(lost);
  }
  return panel;
}

std::string cell_of(const Comparison& found, std::size_t method, std::size_t speed) {
  return found.lost(method, speed) ? "steps lost" : fmt::format("{:.2g} %", found.ripple(method, speed));
}

void write_speeds(Page& page, const Comparison& found) {
  Csv csv("pulses_per_second,method,rms_ripple_percent,lost_steps");
  std::vector<std::vector<std::string>> rows{{"pulses/s", kNames[0], kNames[1]}};
  for (std::size_t s = 0; s < found.speeds.size(); ++s) {
    for (std::size_t m = 0; m < kNames.size(); ++m) {
      // The ripple of a run with lost steps is meaningless. Two digits do not depend on the mathematics library.
      csv.row("{:g},{},{},{:d}", found.speeds[s], m == 0 ? "point-by-point" : "one-shot",
              found.lost(m, s) ? "" : fmt::format("{:.2g}", found.ripple(m, s)), found.lost(m, s));
    }
    if (s % measure::kSpeedsAnOctave != 0) continue;
    rows.push_back({fmt::format("{:g}", found.speeds[s]), cell_of(found, 0, s), cell_of(found, 1, s)});
  }
  page.table(rows);
  page.picture("one-shot-motor",
               "Rms speed ripple over speed; a cross at the bottom marks a speed at which steps are lost",
               chart::grid_of({ripple_panel(found)}, 1, 760, 420), csv);
}

}  // namespace

void one_shot_motor(Page& page, const Progress& progress) {
  page.heading("Vibration of a motor");
  // Slopes with a small ratio repeat too soon to be typical.
  const Line line = make_line({0, 0}, {29, 17});
  const std::vector<measure::Trace> traces{trace_of(Method::kPointByPoint, line), trace_of(Method::kOneShot, line)};
  const auto curve = measure::IdealCurve::line(2, line.start, line.end);
  Comparison found{measure::sweep_speeds(), {}};
  found.sweeps = measure::sweep_motors(traces, curve, {}, found.speeds, 1, progress);
  page.text(
      "Rms speed ripple of one NEMA 17 motor per axis: full steps, line (0,0) to (29,17). The motors reach and leave "
      "each speed on ramps of 50 ms, so an abrupt start or stop is never the cause of lost steps. See [trammel "
      "compare](../user/compare.md) for definitions and all methods.");
  write_speeds(page, found);
  unsigned better = 0;  // among the speeds from 800 pulses/s on
  unsigned worse_below = 0;
  unsigned above = 0;
  unsigned below = 0;
  std::array<unsigned, 2> lost{};
  for (std::size_t s = 0; s < found.speeds.size(); ++s) {
    for (std::size_t m = 0; m < 2; ++m) lost[m] += found.lost(m, s);
    const bool less =
        found.lost(0, s) ? !found.lost(1, s) : !found.lost(1, s) && found.ripple(1, s) < found.ripple(0, s);
    if (found.speeds[s] >= 800) {
      if (found.lost(0, s) && found.lost(1, s)) continue;
      ++above;
      better += less;
    } else {
      ++below;
      worse_below += !less;
    }
  }
  page.corrected("Motor vibrates less", "argued from the waveforms, at any speed",
                 fmt::format("for this motor and load (no others were tried), one-shot is better at {} of {} speeds "
                             "from 800 pulses/s on, not counting speeds at which both methods lose steps. At lower "
                             "speeds, near the resonance, point by point is as good or better at {} of {}",
                             better, above, worse_below, below),
                 better == above && worse_below > 0);
  page.pass("Motor loses steps more easily",
            "pulse by pulse the motor starts and stops irregularly, and easily loses steps",
            fmt::format("point by point loses steps at {} of {} speeds, one-shot at {}", lost[0], found.speeds.size(),
                        lost[1]),
            lost[0] > lost[1]);
}

}  // namespace trammel::app::reproduce
