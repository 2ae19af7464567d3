#include "trammel/report/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace trammel::report {

Surroundings::Surroundings(run::TextSink& sink, std::uint32_t clock_hz, const std::vector<double>& least,
                           std::uint64_t levels)
    : clocks_(std::max<std::uint64_t>(1, clock_hz / kBlocks)), inputs_(sink, "inputs"), levels_(levels) {
  for (const double pulses : least) {
    Apart axis;
    axis.stream = std::make_unique<PageStream>(sink, "apart-" + std::to_string(apart_.size()));
    axis.least = pulses;
    apart_.push_back(std::move(axis));
  }
}

void Surroundings::inputs(std::uint64_t cycle, std::uint64_t levels) {
  if (levels == levels_) return;
  inputs_.varint(cycle - cycle_);
  inputs_.varint(levels ^ levels_);
  cycle_ = cycle;
  levels_ = levels;
}

void Surroundings::apart(std::uint64_t cycle, std::size_t n, double pulses) {
  Apart& axis = apart_[n];
  if (cycle / clocks_ != axis.block) {
    keep(axis, axis.cycle, axis.largest);
    axis.block = cycle / clocks_;
    axis.largest = 0;
    axis.cycle = cycle;
  }
  if (std::abs(pulses) >= std::abs(axis.largest)) {
    axis.largest = pulses;
    axis.cycle = cycle;
  }
  axis.last = pulses;
  axis.last_cycle = cycle;
}

void Surroundings::keep(Apart& axis, std::uint64_t cycle, double pulses) {
  if (std::abs(pulses - static_cast<double>(axis.kept)) < axis.least) return;
  const std::int64_t rounded = std::llround(pulses);
  axis.stream->varint(cycle - axis.kept_cycle);
  axis.stream->zigzag(rounded - axis.kept);
  axis.kept_cycle = cycle;
  axis.kept = rounded;
}

// At the end everything is at rest, so the last difference is kept, not only the largest.
void Surroundings::finish() {
  inputs_.finish();
  for (Apart& axis : apart_) {
    keep(axis, axis.cycle, axis.largest);
    axis.least = std::min(axis.least, 1.0);
    keep(axis, std::max(axis.last_cycle, axis.kept_cycle), axis.last);
    axis.stream->finish();
  }
}

}  // namespace trammel::report
