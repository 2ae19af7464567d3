#include "trammel/skip/card.hpp"

#include <algorithm>
#include <type_traits>

#include "trammel/skip/axis.hpp"
#include "trammel/skip/card_inputs.hpp"
#include "trammel/skip/commands.hpp"
#include "trammel/skip/control.hpp"
#include "trammel/skip/jump.hpp"
#include "trammel/skip/path_engines.hpp"
#include "trammel/skip/sequencer.hpp"

namespace trammel::skip {

namespace {

// A part whose next clock changes no output advances by one clock instead. Parts whose clock costs no more than their
// horizon are always clocked.
struct ClockBusy {
  template <class Part>
  bool operator()(Part& part, const typename Part::Inputs& in) const {
    constexpr bool kJoined = std::is_same_v<Part, model::MotionCore> || std::is_same_v<Part, model::CoreModel>;
    constexpr bool kCheap = std::is_same_v<Part, model::TimeBase> || std::is_same_v<Part, model::FeedGenerator> ||
                            std::is_same_v<Part, model::WaitTimer> || std::is_same_v<Part, model::Watchdog> ||
                            std::is_same_v<Part, model::MachinePlace> || std::is_same_v<Part, model::UnderrunGuard> ||
                            std::is_same_v<Part, model::PulseGenerator> || std::is_same_v<Part, model::CardInputs> ||
                            std::is_same_v<Part, model::Captures> || std::is_same_v<Part, model::EmergencyStop> ||
                            std::is_same_v<Part, model::DriveEnable> || std::is_same_v<Part, model::CardHealth>;
    if constexpr (kJoined) {
      part.clock_parts(in, *this);
    } else if constexpr (kCheap) {
      part.clock(in);
    } else if constexpr (std::is_same_v<Part, model::Sequencer>) {
      if (!count(part, in)) part.clock(in);
    } else if (horizon(part, in) != 0) {
      advance(part, in, 1);
      return false;
    } else if constexpr (std::is_same_v<Part, model::Axis> || std::is_same_v<Part, model::PathEngines>) {
      part.clock_parts(in, *this);
    } else {
      part.clock(in);
    }
    return true;
  }
};

}  // namespace

void clock(model::CoreModel& core, const model::CoreModel::Inputs& in) { core.clock_parts(in, ClockBusy()); }
void clock(model::CardModel& card, const model::CardModel::Inputs& in) { card.clock_parts(in, ClockBusy()); }

std::uint64_t jump(model::CoreModel& core, std::uint64_t limit, const Pins& pins) {
  model::CoreModel::State& s = core.state();
  if (s.reset_due || horizon(s.checker, {}) == 0 || horizon(s.watermarks, core.watermark_inputs()) == 0) return 0;
  if (horizon(s.geometry_queue, {}) == 0 || horizon(s.feed_queue, {}) == 0) return 0;
  if (horizon(s.registers, s.shown) == 0) return 0;
  if (horizon(s.captures, core.capture_inputs()) == 0) return 0;
  const model::CardInputs::Inputs in = core.pin_inputs(pins.inputs);
  if (core.has_emergency_stop() && s.registers.filling())
    return 0;  // an active emergency stop takes effect only after that
  if (core.has_emergency_stop() && horizon(s.emergency_stop, core.emergency_inputs(pins.emergency_stop)) == 0) return 0;
  limit = std::min({limit, horizon(s.inputs, in), horizon(s.registers, s.shown)});
  if (limit == 0) return 0;
  const std::uint64_t gone = advance(s.motion, limit, core.motion_inputs(), s.cycles, s.record);
  if (gone == 0) return 0;
  s.cycles += gone;
  advance(s.registers, {}, gone);
  advance(s.inputs, in, gone);
  core.show();
  return gone;
}

void run(model::CoreModel& core, std::uint64_t clocks, const Pins& pins) {
  model::CoreModel::Inputs none;
  none.pins = pins.inputs;
  none.emergency_stop = pins.emergency_stop;
  while (clocks != 0) {
    const std::uint64_t gone = jump(core, clocks, pins);
    if (gone == 0) clock(core, none);
    clocks -= gone == 0 ? 1 : gone;
  }
}

void run(model::CardModel& card, std::uint64_t clocks, const Pins& pins) {
  model::CardModel::Inputs none;
  none.pins = pins.inputs;
  none.emergency_stop = pins.emergency_stop;
  model::CardModel::State& s = card.state();
  while (clocks != 0) {
    const bool still = !s.reset_due && !s.core.answer().ack && horizon(s.port, {}) != 0;
    const std::uint64_t gone = still ? jump(s.core, clocks, pins) : 0;
    if (gone == 0) clock(card, none);
    clocks -= gone == 0 ? 1 : gone;
  }
}

}  // namespace trammel::skip
