// Golden model of position streaming: its mode, the ticks beyond a period's end, and when the next period is missing.
//
// Periods are lines. A line whose N ticks are taken while nothing follows goes on; each tick beyond its end counts.
// With the tick that makes them stale_periods * N (with the period's own last tick where stale_periods is 0) the next
// period is missing: an event that shows at c+1, and from c+1 on nothing follows until a cut. The register STREAMING is
// in force from the first clock on in which the card is at rest and no command has come in part. Not thread-safe; no
// errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

class PositionStreaming {
 public:
  struct Inputs {
    bool cut = false;
    Setting setting;
    bool write = false;       // a halfword of a command comes in
    bool whole = false;       // it is whole, or dropped
    bool rest = false;        // nothing is queued or runs
    bool begin = false;       // a path begins
    std::uint64_t ticks = 0;  // with it: of how many
    bool period = false;      // a period's last tick is taken
    bool goes_on = false;     // nothing follows in this clock
    bool stale_tick = false;  // a tick beyond it is taken
  };
  struct Outputs {
    bool on = false;          // the mode
    bool missing = false;     // event
    bool lost = false;        // the next period was missing; until a cut
    std::uint32_t ticks = 0;  // beyond the end of the last period that ended
  };
  // All that the next clock() depends on beside its inputs.
  struct State {
    bool on = false;  // as the register says
    std::uint32_t stale_periods = 0;
    bool inside = false;       // a command has come in part
    std::uint64_t length = 0;  // ticks of the path under way
    uint128 beyond = 0;
    uint128 allowed = 0;
    Outputs out;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    if (in.period) {
      state_.beyond = 0;
      state_.allowed = uint128{state_.stale_periods} * state_.length;
    }
    state_.beyond += in.stale_tick ? 1U : 0U;
    const bool arrives = (in.period || in.stale_tick) && state_.beyond == state_.allowed;
    state_.out.missing = arrives && in.goes_on && !state_.out.lost && !in.cut;
    state_.out.lost = (state_.out.lost || state_.out.missing) && !in.cut;
    state_.out.ticks = static_cast<std::uint32_t>(state_.beyond);
    if (in.begin) state_.length = in.ticks;
    if (settles(in)) state_.out.on = state_.on;
    state_.inside = !in.cut && !in.whole && (state_.inside || in.write);
    if (in.setting.set && in.setting.address == card_map::reg::kStreaming) set(in.setting.data);
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  bool settles(const Inputs& in) const { return in.rest && !state_.inside && !in.write; }
  void set(std::uint32_t data) {
    namespace field = card_map::field;
    state_.on = (data & field::kStreamingOn) != 0;
    state_.stale_periods = data >> 8 & 0xFF;
  }

  State state_;
};

}  // namespace trammel::model
