// The effect of a stop on the card's outputs, seen at their pins, and on the machine's place, seen in PLACE: the
// effect that docs/reference/behaviour.md requires, and a description of errors.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "stop_causes.hpp"

namespace trammel::test {

struct StopCase {
  const Cause& cause;
  Reaction reaction;
  const State& state;
  const Program& program;
  unsigned clock;  // clock of the window

  std::string name() const {
    return std::string(cause.name) + ", " + name_of(reaction) + ", " + state.name + ", clock " + std::to_string(clock);
  }
};

// In clocks of the watch.
struct StopTimes {
  std::uint64_t struck = 0;
  std::uint64_t stop = 0;
  std::uint64_t rest = 0;
  bool second = false;  // a drive's fault came after the first cause
};

// Maximum clocks from the tick to the leading edge of its pulse.
inline constexpr std::uint64_t kPulseBehindTick = 80;
// More if steps wait for a space that is too long: up to five of them, and one under way.
inline constexpr std::uint64_t kWaitingSteps = 6 * (kLateSpace + 10);
// STOP is taken one clock after FAULT shows the cause; pins are seen one clock later than registers.
inline constexpr std::uint64_t kOutputSlack = 3;

// The first clock from `from` on in which the output is off.
inline std::optional<std::uint64_t> fell(const PinWatch& watch, std::uint32_t output, std::uint64_t from) {
  for (const OutputChange& change : watch.output_changes) {
    if (change.clock >= from && (change.levels & output) == 0) return change.clock;
  }
  return std::nullopt;
}

inline std::string changed_outputs(const PinWatch& watch, std::uint64_t since) {
  const bool changed = !watch.output_changes.empty() && watch.output_changes.back().clock >= since;
  return changed ? "an output changes without a stop" : "";
}

// Describes an error of an output that must have fallen and must stay off.
inline std::string wrong_fall(const PinWatch& watch, std::uint32_t output, const char* name, std::uint64_t since,
                              std::uint64_t soonest, std::uint64_t latest) {
  const std::optional<std::uint64_t> clock = fell(watch, output, since);
  if (!clock) return std::string("the output that is safe ") + name + " stays on";
  if (*clock < soonest || *clock > latest)
    return std::string("the output that is safe ") + name + " changes in clock " + std::to_string(*clock) +
           ", not in " + std::to_string(soonest) + " to " + std::to_string(latest);
  if ((watch.output_changes.back().levels & output) != 0)
    return std::string("the output that is safe ") + name + " is on again";
  return fell(watch, kOutputKept, since) ? "an output without a safe level changes" : "";
}

inline std::string wrong_outputs_of_a_stop(const PinWatch& watch, const StopTimes& times, const StopCase& of) {
  // The emergency stop's latch acts without a clock.
  const bool latched = of.cause.fault == field::kFaultEmergencyStop;
  const std::uint64_t begin = latched ? times.struck : times.stop - kOutputSlack;
  std::string wrong = wrong_fall(watch, kOutputSafeAtCause, "at the cause", of.cause.of_program() ? 0 : times.struck,
                                 begin, times.stop + kOutputSlack);
  if (!wrong.empty()) return wrong;
  const std::uint64_t last = watch.pulses.empty() ? 0 : watch.pulses.back().clock;
  const std::uint64_t behind = kPulseBehindTick + (of.cause.loses_steps ? kWaitingSteps : 0);
  const std::uint64_t soonest = std::max(times.stop, std::max(last, behind) - behind) - kOutputSlack;
  return wrong_fall(watch, kOutputSafeAtRest, "at rest", of.cause.of_program() ? 0 : times.struck, soonest,
                    times.rest + kOutputSlack);
}

inline std::string wrong_outputs_of_a_cut(const PinWatch& watch, std::uint64_t struck, std::uint64_t latest) {
  std::string wrong = wrong_fall(watch, kOutputSafeAtCause, "at the cause", struck, struck, latest);
  return wrong.empty() ? wrong_fall(watch, kOutputSafeAtRest, "at rest", struck, struck, latest) : wrong;
}

// The axes that must have, and those that may have, lost their place, a bit each.
struct LostPlaces {
  std::uint32_t must = 0;
  std::uint32_t may = 0;
};

// An immediate stop takes the place of each axis that moves: one that has stepped since a piece or a direct move
// began.
inline LostPlaces lost_at_once(const PinWatch& watch, const StopTimes& times, const StopCase& of) {
  LostPlaces lost;
  // Causes that need a step stop the axes when the hold is over.
  if (of.state.at_rest && (watch.pulses.empty() || watch.pulses.back().clock < times.struck)) return lost;
  for (const Pulse& pulse : watch.pulses) {
    lost.may |= 1U << pulse.axis;
    if (of.state.moves && !of.cause.of_program() && pulse.clock + kPulseBehindTick < times.stop)
      lost.must |= 1U << pulse.axis;
  }
  return lost;
}

inline std::string wrong_place(std::uint32_t place, const PinWatch& watch, const StopTimes& times, const StopCase& of) {
  LostPlaces lost;
  if (of.reaction == Reaction::kAtOnce || of.cause.fault == 0) lost = lost_at_once(watch, times, of);
  if (of.reaction == Reaction::kShortRamp) lost.may = (1U << kWatchedAxes) - 1;
  if (of.cause.fault == field::kFaultDriveFault || times.second) lost.must |= 1U << kDriveAxis;
  lost.may |= lost.must;
  const std::uint32_t valid = place & field::kPlacePositionValid;
  const std::uint32_t homed = (place & field::kPlaceHomed) >> field::kPlaceHomedShift;
  if (valid != homed)
    return "PLACE has axes that are homed, " + std::to_string(homed) + ", and valid ones, " + std::to_string(valid);
  const std::uint32_t all = (1U << kWatchedAxes) - 1;
  if ((valid & lost.must) != 0) return "PLACE still has axes that lose it: " + std::to_string(valid & lost.must);
  if ((~valid & all & ~lost.may) != 0)
    return "PLACE has lost axes that keep it: " + std::to_string(~valid & all & ~lost.may);
  return "";
}

}  // namespace trammel::test
