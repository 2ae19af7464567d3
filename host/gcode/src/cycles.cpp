#include "cycles.hpp"

#include <algorithm>
#include <cmath>

namespace trammel::gcode {
namespace {

// mm, as in LinuxCNC: distance above the last depth at which the rapid back into the hole ends, and by which G73 backs
// out.
constexpr double kPeckClearance = 0.254;
constexpr double kSameLevel = 1e-9;  // mm: more than the rounding errors of sums of decimal fractions

// The number of pecks before the last one.
double pecks_before_last(const CycleHoles& holes) {
  return std::max(0.0, std::ceil((holes.retract - holes.bottom - kSameLevel) / holes.peck) - 1);
}

void peck(const CycleHoles& holes, CycleSink& sink) {
  const auto count = static_cast<std::uint64_t>(pecks_before_last(holes));
  for (std::uint64_t i = 1; i <= count; ++i) {
    const double depth = holes.retract - static_cast<double>(i) * holes.peck;
    const double above = std::min(depth + kPeckClearance, holes.retract);
    sink.level(CycleStep::kFeed, depth);
    if (holes.code == 830) sink.level(CycleStep::kRapid, holes.retract);
    sink.level(CycleStep::kRapid, above);
  }
}

}  // namespace

std::size_t motions_of(const CycleHoles& holes) {
  constexpr double kAround = 6;  // position, level, feed, dwell, retract and one to spare
  const double one = kAround + (pecks(holes.code) ? 3 * pecks_before_last(holes) : 0);
  return static_cast<std::size_t>(std::min(one * holes.count + 1, 2.0 * kMaxCycleMotions));
}

void drill(const CycleHoles& holes, CycleSink& sink) {
  double level = holes.start;
  if (level < holes.retract) sink.level(CycleStep::kRapid, level = holes.retract);
  for (std::uint32_t hole = 0; hole < holes.count; ++hole) {
    sink.position({holes.first[0] + hole * holes.next[0], holes.first[1] + hole * holes.next[1]});
    if (level != holes.retract) sink.level(CycleStep::kRapid, holes.retract);
    if (pecks(holes.code)) peck(holes, sink);
    sink.level(CycleStep::kFeed, holes.bottom);
    if (dwells_below(holes.code)) sink.level(CycleStep::kDwell, holes.bottom);
    if (holes.code == 850) sink.level(CycleStep::kFeed, holes.retract);
    sink.level(holes.code == 890 ? CycleStep::kFeed : CycleStep::kRapid, holes.clear);
    level = holes.clear;
  }
}

}  // namespace trammel::gcode
