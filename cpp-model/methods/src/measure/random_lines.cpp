#include <algorithm>
#include <cmath>
#include <cstdint>

#include "for_each_index.hpp"
#include "trammel/measure/comparison.hpp"

namespace trammel::measure {
namespace {

using interpolation::Line;

// Lines per block. Sums are made within blocks and then over blocks in order, so that rounding does not depend on the
// threads.
constexpr std::uint64_t kBlock = 512;

// SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom number generators"): gives any index directly.
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31);
}

// A number in -largest .. largest; the bias of the modulus is below largest / 2^62.
std::int64_t uniform(std::uint64_t random, std::int64_t largest) {
  return static_cast<std::int64_t>(random % static_cast<std::uint64_t>(2 * largest + 1)) - largest;
}

void add_line(RandomMeasures& sums, const Line& line, const Trace& trace, const IdealCurve& curve) {
  TracePosition end = trace.start();
  for (const Event& event : trace.events()) {
    end[0] += event.direction[0];
    end[1] += event.direction[1];
  }
  if (end != line.end) ++sums.wrong_ends;
  const Distances distances = measure_distances(trace, curve);
  if (distances.perpendicular.largest > sums.largest_perpendicular) {
    sums.largest_perpendicular = distances.perpendicular.largest;
    sums.worst_line = line;
  }
  sums.mean_perpendicular += distances.perpendicular.mean;
  if (distances.horizontal) {
    sums.largest_horizontal = std::max(sums.largest_horizontal, distances.horizontal->largest);
  }
  double deviation = 0;
  double rms = 0;
  for (std::size_t a = 0; a < 2; ++a) {
    sums.largest_axis = std::max(sums.largest_axis, distances.axis[a].largest);
    const Evenness evenness = measure_evenness(trace, curve, a);
    deviation = std::max(deviation, evenness.largest);
    rms = std::max(rms, evenness.rms);
  }
  sums.largest_interval_deviation = std::max(sums.largest_interval_deviation, deviation);
  sums.mean_interval_deviation += deviation;
  sums.mean_rms_interval += rms;
  const Ripple ripple = measure_speed_ripple(trace, curve);
  sums.largest_ripple = std::max(sums.largest_ripple, ripple.largest);
  sums.mean_rms_ripple += ripple.rms;
  sums.mean_steps += static_cast<double>(trace.events().size());
  sums.mean_operations += static_cast<double>(cost_of(sums.method, trace, true).operations);
}

void add_block(RandomMeasures& total, const RandomMeasures& block) {
  if (block.largest_perpendicular > total.largest_perpendicular) {
    total.largest_perpendicular = block.largest_perpendicular;
    total.worst_line = block.worst_line;
  }
  total.mean_perpendicular += block.mean_perpendicular;
  total.largest_horizontal = std::max(total.largest_horizontal, block.largest_horizontal);
  total.largest_axis = std::max(total.largest_axis, block.largest_axis);
  total.largest_interval_deviation = std::max(total.largest_interval_deviation, block.largest_interval_deviation);
  total.mean_interval_deviation += block.mean_interval_deviation;
  total.mean_rms_interval += block.mean_rms_interval;
  total.largest_ripple = std::max(total.largest_ripple, block.largest_ripple);
  total.mean_rms_ripple += block.mean_rms_ripple;
  total.mean_steps += block.mean_steps;
  total.mean_operations += block.mean_operations;
  total.wrong_ends += block.wrong_ends;
}

void divide(RandomMeasures& sums, std::uint64_t lines) {
  const auto count = static_cast<double>(std::max<std::uint64_t>(lines, 1));
  for (double* sum : {&sums.mean_perpendicular, &sums.mean_interval_deviation, &sums.mean_rms_interval,
                      &sums.mean_rms_ripple, &sums.mean_steps, &sums.mean_operations}) {
    *sum /= count;
  }
}

std::vector<RandomMeasures> empty_measures() {
  std::vector<RandomMeasures> result;
  for (const interpolation::Method method : methods_for(Line{})) {
    result.emplace_back();
    result.back().method = method;
  }
  return result;
}

std::vector<RandomMeasures> measure_block(const RandomLines& lines, std::uint64_t block, Trace& trace) {
  std::vector<RandomMeasures> sums = empty_measures();
  const std::uint64_t end = std::min(lines.count, (block + 1) * kBlock);
  for (std::uint64_t index = block * kBlock; index < end; ++index) {
    const Line line = random_line(lines, index);
    const IdealCurve curve = ideal_of(line);
    for (RandomMeasures& measures : sums) {
      record(measures.method, line, lines.options, trace);
      add_line(measures, line, trace, curve);
    }
  }
  return sums;
}

}  // namespace

Line random_line(const RandomLines& lines, std::uint64_t index) {
  std::uint64_t state = mixed(mixed(lines.seed) ^ index);
  Line line;
  do {
    for (std::size_t a = 0; a < 2; ++a) {
      state = mixed(state);
      line.end[a] = uniform(state, lines.largest);
    }
  } while (line.end[0] == 0 && line.end[1] == 0);
  return line;
}

std::vector<RandomMeasures> measure_random_lines(const RandomLines& lines,
                                                 const std::function<void(double)>& progress) {
  std::vector<RandomMeasures> total = empty_measures();
  // If the longest line is refused, throw here, before the threads start.
  const Line longest = interpolation::make_line({0, 0}, {lines.largest, lines.largest});
  for (const RandomMeasures& measures : total) {
    interpolation::make_interpolator(measures.method, longest, lines.options);
  }
  const std::uint64_t blocks = (lines.count + kBlock - 1) / kBlock;
  std::vector<std::vector<RandomMeasures>> results(blocks);
  for_each_index(
      blocks, lines.threads,
      [&](std::uint64_t block) {
        Trace trace;
        results[block] = measure_block(lines, block, trace);
      },
      progress);
  for (const std::vector<RandomMeasures>& block : results) {
    for (std::size_t i = 0; i < total.size(); ++i) add_block(total[i], block[i]);
  }
  for (RandomMeasures& measures : total) divide(measures, lines.count);
  return total;
}

}  // namespace trammel::measure
