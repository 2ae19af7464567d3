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

  // One rising edge.
  void clock(const Inputs& in) {
    if (in.period) {
      beyond_ = 0;
      allowed_ = uint128{stale_periods_} * length_;
    }
    beyond_ += in.stale_tick ? 1U : 0U;
    const bool arrives = (in.period || in.stale_tick) && beyond_ == allowed_;
    out_.missing = arrives && in.goes_on && !out_.lost && !in.cut;
    out_.lost = (out_.lost || out_.missing) && !in.cut;
    out_.ticks = static_cast<std::uint32_t>(beyond_);
    if (in.begin) length_ = in.ticks;
    if (settles(in)) out_.on = on_;
    inside_ = !in.cut && !in.whole && (inside_ || in.write);
    if (in.setting.set && in.setting.address == card_map::reg::kStreaming) set(in.setting.data);
  }

  const Outputs& outputs() const { return out_; }

  // With these inputs, and without a tick, clock() changes nothing.
  bool quiet(const Inputs& in) const {
    const bool events = in.cut || in.setting.set || in.write || in.whole || in.begin || in.period || in.stale_tick;
    return !events && !out_.missing && (out_.on == on_ || !settles(in));
  }

 private:
  bool settles(const Inputs& in) const { return in.rest && !inside_ && !in.write; }
  void set(std::uint32_t data) {
    namespace field = card_map::field;
    on_ = (data & field::kStreamingOn) != 0;
    stale_periods_ = data >> 8 & 0xFF;
  }

  bool on_ = false;  // as the register says
  std::uint32_t stale_periods_ = 0;
  bool inside_ = false;       // a command has come in part
  std::uint64_t length_ = 0;  // ticks of the path under way
  uint128 beyond_ = 0;
  uint128 allowed_ = 0;
  Outputs out_;
};

}  // namespace trammel::model
