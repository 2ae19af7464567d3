// The default way to clock the parts of a composed block: every part in every clock. clock_parts() accepts another
// way, which must leave the same state and returns false if no output of the part changed. Plain data.
#pragma once

namespace trammel::model {

struct ClockEach {
  template <class Part>
  bool operator()(Part& part, const typename Part::Inputs& in) const {
    part.clock(in);
    return true;
  }
};

}  // namespace trammel::model
