// Lines 1 to 8 and the line of Figure 4 on the Verilated card, in direct mode at 10 MHz: the behaviour of the hardware.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::app::reproduce {

using namespace interpolation;

driver::CardTiming paper_card() {
  driver::CardTiming timing;
  timing.clock_hz = 10'000'000;
  timing.axes = 2;
  // One clock of pulse and one of space.
  timing.pulse_period.fill(2);
  return timing;
}

namespace {

constexpr unsigned kFractionBits = 40;  // fraction bits of the card's frequencies

class Steps final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& step) override { pins.push_back(step); }
  void path_step(const driver::PathStep& step) override { path.push_back(step); }
  std::vector<driver::PinStep> pins;
  std::vector<driver::PathStep> path;
};

struct CardRun {
  Steps steps;
  driver::OneShotPart part;
  std::array<std::vector<std::uint64_t>, 2> falling;  // clocks of x's and y's falling edges at the pins
  std::vector<std::int64_t> counters;                 // the card's positions at the end
  std::uint64_t clocks = 0;                           // clocks in lockstep with the golden model
  std::uint64_t line_cycles = 0;                      // clocks from the start until the card was found idle
};

driver::Displacement displacement_of(const Line& line) {
  driver::Displacement displacement{};
  for (std::size_t a = 0; a < 2; ++a) displacement[a] = line.end[a] - line.start[a];
  return displacement;
}

// Waits clock by clock and records the falling edges of the STEP pins.
void watch_pins(sim::Engine& engine, std::uint64_t clocks, CardRun& run) {
  std::uint32_t before = engine.step_pins();
  for (std::uint64_t i = 0; i < clocks; ++i) {
    engine.wait(1);
    const std::uint32_t fell = before & ~engine.step_pins();
    for (unsigned a = 0; a < 2; ++a) {
      if ((fell >> a & 1U) != 0) run.falling[a].push_back(engine.cycles());
    }
    before = engine.step_pins();
  }
}

// Runs a line of 2,000 clocks; with `hold`, the time base ramps to a stop in the middle and up again. `step_lengths`:
// of x and y, clocks; by default the shortest.
CardRun run_on_card(const Line& line, bool hold, const std::array<double, 2>& step_lengths = {}) {
  sim::SimulationOptions options;
  options.kind = sim::EngineKind::kRtl;
  options.axes = 4;
  options.clock_hz = 10'000'000;
  const auto engine = sim::make_engine(options);
  driver::Card card = driver::Card::open(*engine);
  CardRun run;
  run.part = driver::plan_line_clocks(card.timing(), displacement_of(line), kPaperClocks).part(0);
  for (unsigned a = 0; a < 2; ++a) {
    driver::AxisSettings settings;
    settings.step_length = std::chrono::nanoseconds(static_cast<std::int64_t>(100 * step_lengths[a]));
    card.configure_axis(a, settings);
  }
  if (hold) card.set_slew_time(std::chrono::microseconds(100));
  engine->set_sink(&run.steps);
  const std::uint64_t before = engine->cycles();
  driver::start_line(card, run.part);
  if (hold) {
    engine->wait(300);
    card.set_hold(true);
    engine->wait(3000);
    card.set_hold(false);
  }
  // The last pulse, which lasts half of its interval, ends after the line.
  watch_pins(*engine, kPaperClocks + kPaperClocks / 4, run);
  card.wait_until_idle(std::chrono::milliseconds(10));
  run.line_cycles = engine->cycles() - before;
  engine->set_sink(nullptr);
  card.parts().registers.throw_if_faulted(card.read_status(), "line of the paper");
  run.counters = engine->positions();
  run.clocks = engine->lockstep_cycles().value_or(0);
  return run;
}

// The track from the path steps, in ticks of the path, which are enabled clocks.
Track track_of_card(const Line& line, const CardRun& run) {
  Track track{{0, line.start}};
  for (const driver::PathStep& step : run.steps.path) {
    TrackPoint next = track.back();
    if (step.tick != next.time) {
      next.time = step.tick;
      track.push_back(next);
    }
    track.back().position[step.axis] += step.direction;
  }
  return track;
}

// Clocks of the pulses at the pins of an axis.
std::vector<double> pin_times(const CardRun& run, unsigned axis) {
  std::vector<double> times;
  for (const driver::PinStep& step : run.steps.pins) {
    if (step.axis == axis) times.push_back(static_cast<double>(step.cycle));
  }
  return times;
}

// Whether the track follows the card's formula, floor(1/2 + k * frequency / 2^40), in every clock k of the line,
// including those without a step.
bool follows_formula(const Line& line, const CardRun& run, const Track& track) {
  auto next = track.begin();
  Position at = line.start;
  for (std::uint64_t clock = 0; clock <= kPaperClocks; ++clock) {
    if (next != track.end() && next->time == clock) at = (next++)->position;
    for (std::size_t a = 0; a < 2; ++a) {
      const std::uint64_t half = std::uint64_t{1} << (kFractionBits - 1);
      // At most one pulse in each of 2,000 clocks: below 2^52.
      const std::uint64_t made = (half + clock * run.part.frequency[a]) >> kFractionBits;
      if (static_cast<std::uint64_t>(std::abs(at[a] - line.start[a])) != made) return false;
    }
  }
  return next == track.end();
}

// The largest difference between the clocks of the same pulse on the card and in exact arithmetic.
double largest_lag(const Track& card, const Track& exact) {
  double lag = 0;
  for (std::size_t a = 0; a < 2; ++a) {
    const std::vector<double> one = pulse_times(card, a, 1);
    const std::vector<double> other = pulse_times(exact, a, 1);
    if (one.size() != other.size()) return static_cast<double>(kPaperClocks);
    for (std::size_t i = 0; i < one.size(); ++i) lag = std::max(lag, std::fabs(one[i] - other[i]));
  }
  return lag;
}

bool ends_exactly(const Line& line, const CardRun& run) {
  std::array<std::int64_t, 2> at_pins{};
  for (const driver::PinStep& step : run.steps.pins) at_pins[step.axis] += step.direction;
  for (std::size_t a = 0; a < 2; ++a) {
    const std::int64_t p = line.end[a] - line.start[a];
    if (run.counters[a] != p || at_pins[a] != p) return false;
  }
  return true;
}

struct Totals {
  unsigned ends = 0;
  unsigned formula = 0;
  unsigned bound = 0;
  unsigned equal = 0;  // lines whose errors equal those of exact arithmetic to three decimals
  double lag = 0;
  double interval_difference = 0;  // at the pins, without each axis's first interval
  double forward_first = 0;        // by how much an axis's first interval is shorter than the next ones
  double backward_first = 0;       // the same if the axis starts in the negative direction
  std::uint64_t clocks = 0;
};

// Totals over the lines.
struct LinesOnCard {
  Totals totals;
  Csv track{"line,tick,x,y,distance"};
  Csv pins{"line,axis,direction,clock"};
  std::vector<chart::Panel> panels;
  std::vector<std::vector<std::string>> rows{
      {"line", "pulses x, y", "error on the card, pulses", "error in exact arithmetic, pulses"}};
};

void run_line_of_paper(std::size_t i, LinesOnCard& sums) {
  const Line line = kPaperLines[i].line();
  const CardRun run = run_on_card(line, false);
  const Track track = track_of_card(line, run);
  const Track exact = track_of(Method::kOneShot, line);
  const double largest = largest_distance(line, track);
  sums.totals.ends += ends_exactly(line, run) && track.back().position == line.end && track.back().time <= kPaperClocks;
  sums.totals.formula += follows_formula(line, run, track);
  sums.totals.bound += largest <= std::sqrt(2.0) * (0.5 + std::ldexp(static_cast<double>(kPaperClocks), -41));
  sums.totals.equal += std::fabs(largest - largest_distance(line, exact)) < 0.0005;
  sums.totals.lag = std::max(sums.totals.lag, largest_lag(track, exact));
  sums.totals.clocks += run.clocks;
  for (unsigned a = 0; a < 2; ++a) {
    const std::vector<double> times = pin_times(run, a);
    if (times.size() < 3) continue;
    const Spread spread = spread_of({times.begin() + 1, times.end()});
    sums.totals.interval_difference = std::max(sums.totals.interval_difference, spread.largest - spread.least);
    double& first = line.end[a] < line.start[a] ? sums.totals.backward_first : sums.totals.forward_first;
    first = std::max(first, spread.largest - (times[1] - times[0]));
  }
  for (const TrackPoint& p : track) {
    sums.track.row("{},{},{},{},{:.4f}", i + 1, p.time, p.position[0], p.position[1], distance(line, p.position));
  }
  const std::uint64_t first = run.steps.pins.front().cycle;
  for (const driver::PinStep& step : run.steps.pins) {
    sums.pins.row("{},{},{},{}", i + 1, step.axis == 0 ? 'x' : 'y', step.direction, step.cycle - first);
  }
  sums.rows.push_back({std::to_string(i + 1), fmt::format("{}, {}", run.part.count[0], run.part.count[1]),
                       fmt::format("{:.3f}", largest), fmt::format("{:.3f}", largest_distance(line, exact))});
  sums.panels.push_back(line_panel(i, track, "card"));
}

void judge_lines(Page& page, const LinesOnCard& sums) {
  const Totals& totals = sums.totals;
  page.pass("Figure 3 on the card, end points", "the error of the end point is zero",
            fmt::format("{} of 8 lines end exactly, at the pins and in the counters", totals.ends), totals.ends == 8);
  page.pass("Position formula (9), (10) on the card", "x = round(v t / f)",
            fmt::format("{} of 8 lines are at floor(1/2 + k F / 2^40) in each of {} clocks k, where F is the FREQUENCY "
                        "of the axis. Each step is within {:g} clock of exact arithmetic",
                        totals.formula, kPaperClocks + 1, totals.lag),
            totals.formula == 8 && totals.lag <= 1);
  page.table(sums.rows);
  page.pass("Error on the card", "below 1 pulse",
            fmt::format("{} of 8 perpendicular errors are within sqrt(2) (1/2 + L / 2^41), where L is the number of "
                        "clocks, and {} of 8 equal those of exact arithmetic to three decimals",
                        totals.bound, totals.equal),
            totals.bound == 8 && totals.equal == 8);
  // After reset DIR is forward, and the shaper reverses it before an axis's first backward pulse. This takes a few
  // clocks and is visible only at the pin.
  page.corrected(
      "Velocities on the card", "both velocities stay the same",
      fmt::format("after the first interval of an axis, the intervals at its pin differ by at most {:g} clock. The "
                  "first interval can be shorter: by {:g} clocks on an axis that starts backward, because its first "
                  "pulse waits for DIR, and by {:g} on an axis that starts forward",
                  totals.interval_difference, totals.backward_first, totals.forward_first),
      totals.interval_difference <= 1 && totals.forward_first <= 1 && totals.backward_first <= 8);
  page.pass("Lockstep", "(no simulation of hardware)",
            fmt::format("{} clocks compared with the golden model without a mismatch", totals.clocks),
            totals.clocks > 16'000);
}

// Figure 2 (b) on a card: a line above v_max reaches neither bus nor pins; entered again with a smaller v it runs.
bool refuses_then_runs() {
  sim::SimulationOptions options;
  options.kind = sim::EngineKind::kRtl;
  options.clock_hz = 10'000'000;
  const auto engine = sim::make_engine(options);
  driver::Card card = driver::Card::open(*engine);
  driver::LineLimits limits;
  limits.max_velocity[1] = 100'000;
  const std::uint64_t before = engine->cycles();
  bool refused = false;
  try {
    driver::start_line(card, {20, 40}, std::chrono::microseconds(200), limits);
  } catch (const driver::ArgumentError&) {
    refused = true;
  }
  if (!refused || engine->cycles() != before) return false;
  driver::start_line(card, {20, 40}, std::chrono::microseconds(400), limits);
  engine->wait(2 * kPaperClocks);
  card.wait_until_idle(std::chrono::milliseconds(10));
  const std::vector<std::int64_t> reached = engine->positions();
  return reached[0] == 20 && reached[1] == 40;
}

void figure_two(Page& page, const LinesOnCard& sums) {
  page.pass("Figure 2 (a)", "a CPU sends the frequency and number of pulses to one pulse generator per axis",
            fmt::format("one transfer of frequencies and counts starts the card's two pulse generators, and {} of 8 "
                        "lines end exactly. The run includes no motor drivers and no motors",
                        sums.totals.ends),
            sums.totals.ends == 8);
  page.pass(
      "Figure 2 (b)",
      "v is compared with v_max and must be entered again if it is above; otherwise the line is computed and sent",
      "Line 1 with y above its limit is refused before the first bus access; with half of v it is accepted and runs to "
      "its end",
      refuses_then_runs());
}

void lines_on_card(Page& page, const Progress& progress) {
  page.heading("Lines 1 to 8 on the card");
  page.text(
      "The Verilated card runs in lockstep with its golden model: direct mode, 10 MHz, 2,000 clocks per line. Its "
      "frequencies are rounded to 2^-40 pulses per clock. If the exact position of an axis lies halfway between two "
      "pulses at a clock, the step therefore comes at this clock or one clock later.");
  LinesOnCard sums;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    run_line_of_paper(i, sums);
    progress(0.8 * static_cast<double>(i + 1) / 8);
  }
  judge_lines(page, sums);
  figure_two(page, sums);
  page.picture("one-shot-figure-3-card", "Lines 1 to 8 as the card ran them",
               chart::grid_of(sums.panels, 2, kLinePanelWidth, kLinePanelHeight), sums.track);
  page.data("one-shot-card-pins", "Leading edges at the STEP pins, in clocks after the first edge of each line",
            sums.pins);
}

// Clocks of 100 ns: half of the intervals of x and y on the line of Figure 4, used as step lengths.
constexpr std::array<double, 2> kHalfIntervals{100, 50};

// Durations of an axis's pulses: from each rising edge to the next falling edge.
Spread high_times(const std::vector<double>& rising, const std::vector<double>& falling) {
  if (rising.empty() || rising.size() != falling.size()) return {};
  Spread high{falling[0] - rising[0], 0};
  for (std::size_t i = 0; i < rising.size(); ++i) {
    high.least = std::min(high.least, falling[i] - rising[i]);
    high.largest = std::max(high.largest, falling[i] - rising[i]);
  }
  return high;
}

// One number if all are equal.
std::string range_of(const Spread& spread) {
  if (spread.least == spread.largest) return fmt::format("{:g}", spread.least);
  return fmt::format("{:g} to {:g}", spread.least, spread.largest);
}

void judge_duty_ratio(Page& page, const std::array<Spread, 2>& intervals, const std::array<Spread, 2>& high) {
  bool half = true;
  for (std::size_t a = 0; a < 2; ++a) {
    half = half && high[a].least == high[a].largest && 2 * high[a].least == intervals[a].least &&
           intervals[a].least == intervals[a].largest;
  }
  page.pass(
      "Duty ratio on the card", "kept at 50 %",
      fmt::format("at the pins, x is high for {} of {} clocks and y for {} of {}, with step lengths set to half of the "
                  "intervals. When the frequency changes, the card keeps the step length, not the duty ratio",
                  range_of(high[0]), range_of(intervals[0]), range_of(high[1]), range_of(intervals[1])),
      half);
}

void wave_on_card(Page& page) {
  page.heading("Figure 4 (a) on the card");
  const CardRun run = run_on_card(make_line({0, 0}, {10, 20}), false, kHalfIntervals);
  Csv csv("axis,pulse,rising_clock,falling_clock");
  const auto first = static_cast<double>(run.steps.pins.front().cycle);
  std::array<Spread, 2> spread;
  std::array<Spread, 2> high;
  std::array<std::vector<double>, 2> rising;
  std::array<std::vector<double>, 2> falling;
  double end = 0;
  for (unsigned a = 0; a < 2; ++a) {
    rising[a] = pin_times(run, a);
    falling[a].assign(run.falling[a].begin(), run.falling[a].end());
    spread[a] = spread_of(rising[a]);
    high[a] = high_times(rising[a], falling[a]);
    for (std::size_t i = 0; i < std::min(rising[a].size(), falling[a].size()); ++i) {
      rising[a][i] -= first;
      falling[a][i] -= first;
      end = std::max(end, falling[a][i]);
      csv.row("{},{},{:g},{:g}", a == 0 ? 'x' : 'y', i + 1, rising[a][i], falling[a][i]);
    }
  }
  chart::Panel panel = wave_panel("STEP pins", end);
  for (unsigned a = 0; a < 2; ++a) panel.series.push_back(wave(a, rising[a], falling[a], end));
  page.pass("Figure 4 (a) on the card", "the frequency of both axes stays the same",
            fmt::format("the pulses of x are {} clocks apart, those of y {}", range_of(spread[0]), range_of(spread[1])),
            spread[0].least >= 199 && spread[0].largest <= 201 && spread[1].least >= 99 && spread[1].largest <= 101);
  judge_duty_ratio(page, spread, high);
  page.picture("one-shot-figure-4-card", "Both edges of the STEP pins on the line (0,0) to (10,20)",
               chart::grid_of({panel}, 1, 900, 190), csv);
}

void standstill(Page& page) {
  page.heading("From a standstill");
  unsigned same = 0;
  std::uint64_t longest = 0;
  for (std::size_t i = 0; i < kPaperLines.size(); ++i) {
    const Line line = kPaperLines[i].line();
    const CardRun held = run_on_card(line, true);
    const Track straight = track_of_card(line, run_on_card(line, false));
    const Track ramped = track_of_card(line, held);
    const auto equal = [](const TrackPoint& a, const TrackPoint& b) {
      return a.time == b.time && a.position == b.position;
    };
    same +=
        std::equal(straight.begin(), straight.end(), ramped.begin(), ramped.end(), equal) && ends_exactly(line, held);
    longest = std::max(longest, held.line_cycles);
  }
  page.corrected(
      "Constant velocity from a standstill", "full velocity from the first pulse to the last",
      fmt::format(
          "no motor can do this. The card's time base ramps both axes together: it stopped each line in the middle and "
          "restarted it (longest run: {} clocks), and {} of 8 lines kept their path tick by tick",
          longest, same),
      same == 8 && longest > 2 * kPaperClocks);
}

}  // namespace

void one_shot_card(Page& page, const Progress& progress) {
  lines_on_card(page, progress);
  wave_on_card(page);
  progress(0.9);
  standstill(page);
}

}  // namespace trammel::app::reproduce
