#include "trammel/run/interrupted.hpp"

namespace trammel::run {

RunBegin begin_of(const RunSettings& settings, const Plan& plan) {
  RunBegin begin;
  begin.place = settings.place.value_or(RunSettings::Place{{plan.skipped}, plan.start});
  begin.first = plan.skipped;
  begin.silent = plan.ticks_done != 0;
  return begin;
}

std::optional<RunSettings::Place> place_of(const RunBegin& begin, const driver::Rest& rest,
                                           const std::array<std::int32_t, card_map::kMaxAxes>& zero) {
  // During the silent piece the axes do not move, so the ticks describe the path and not the position of the axes.
  if (rest.geometry_begun == 0 || (begin.silent && rest.feed_begun <= 1)) return begin.place;
  if (!rest.exact()) return std::nullopt;
  RunSettings::Place place;
  place.path = {begin.first + rest.geometry_begun - 1, rest.ticks_left};
  for (std::size_t n = 0; n < zero.size(); ++n) place.position[n] = driver::pulses_between(zero[n], rest.position[n]);
  return place;
}

}  // namespace trammel::run
