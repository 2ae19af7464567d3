// Zeng, Zhang & Huang: the claim that the motor vibrates less, put to a simulated two-phase stepper.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "picture.hpp"
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

void one_shot_motor(Page& page, const Progress& progress) {
  page.heading("Vibration of a motor");
  // Slopes with a small ratio repeat too soon to be typical.
  const Line line = make_line({0, 0}, {29, 17});
  const std::vector<double> speeds{200, 800, 1600};
  const std::vector<measure::Trace> traces{trace_of(Method::kPointByPoint, line), trace_of(Method::kOneShot, line)};
  const auto curve = measure::IdealCurve::line(2, line.start, line.end);
  const auto sweeps = measure::sweep_motors(traces, curve, {}, speeds, 1, progress);
  Csv csv("pulses_per_second,method,rms_ripple_percent,lost_steps");
  std::vector<std::vector<std::string>> rows{{"pulses/s", "point by point", "one-shot"}};
  std::vector<Series> series{{"point by point", "#c03", {}, 1.5, false, false},
                             {"one-shot", "#06c", {}, 1.5, false, false}};
  const auto ripple = [&](std::size_t method, std::size_t speed) { return 100 * sweeps[method][speed].rms_ripple; };
  for (std::size_t s = 0; s < speeds.size(); ++s) {
    std::vector<std::string> row{fmt::format("{:g}", speeds[s])};
    for (std::size_t m = 0; m < traces.size(); ++m) {
      const bool lost = sweeps[m][s].lost_steps;
      // What is left of a lost run says nothing; whole percents do not depend on the mathematics library.
      csv.row("{:g},{},{},{:d}", speeds[s], m == 0 ? "point-by-point" : "one-shot",
              lost ? "" : fmt::format("{:.0f}", ripple(m, s)), lost);
      row.push_back(lost ? "steps lost" : fmt::format("{:.0f} %", ripple(m, s)));
      if (!lost) series[m].points.push_back({speeds[s], std::round(ripple(m, s))});
    }
    rows.push_back(row);
  }
  page.text(
      "Rms speed ripple of a NEMA 17 motor an axis, full steps, line (0,0) to (29,17); definitions and all methods "
      "in [trammel compare](../user/compare.md).");
  page.table(rows);
  const bool less_above = ripple(1, 1) < ripple(0, 1) && ripple(1, 2) < ripple(0, 2) && !sweeps[1][2].lost_steps;
  page.corrected("Motor vibrates less", "argued from the waveforms, at any speed",
                 fmt::format("above the motor's resonance: {:.0f} % against {:.0f} % at 800 pulses/s; near it an even "
                             "train excites it more: {:.0f} % against {:.0f} % at 200",
                             ripple(1, 1), ripple(0, 1), ripple(1, 0), ripple(0, 0)),
                 less_above && ripple(1, 0) > ripple(0, 0));
  page.picture("one-shot-motor", "Rms speed ripple in % over pulses/s (no point where steps are lost)",
               draw({{"rms speed ripple in % over pulses/s", series, false}}, {1, 480, 300}), csv);
}

}  // namespace trammel::app::reproduce
