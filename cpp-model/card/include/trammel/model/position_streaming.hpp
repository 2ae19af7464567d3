// Golden model of position streaming: its mode, the ticks beyond the end of a period, and the detection of a missing
// period.
//
// Periods are lines. A line whose N ticks are taken while no path follows continues; each tick beyond its end is
// counted. The next period is missing with the tick that makes the count stale_periods * N (if stale_periods is 0:
// with the period's last tick). This event shows at c+1, and from c+1 on no path follows until a cut. The register
// STREAMING takes effect in the first clock in which the card is at rest and no command has arrived in part. Not
// thread-safe; no errors are reported.
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
    bool write = false;       // a halfword of a command arrives
    bool whole = false;       // the command is complete, or dropped
    bool rest = false;        // nothing is queued, and nothing runs
    bool begin = false;       // a path begins
    std::uint64_t ticks = 0;  // with begin: number of ticks of the path
    bool period = false;      // the last tick of a period is taken
    bool goes_on = false;     // no path follows in this clock
    bool stale_tick = false;  // a tick beyond the end of the period is taken
  };
  struct Outputs {
    bool on = false;          // the mode is in force
    bool missing = false;     // event
    bool lost = false;        // the next period was missing; until a cut
    std::uint32_t ticks = 0;  // ticks beyond the end of the last period that ended
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    bool on = false;  // mode written to STREAMING, in force from the next rest on
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
