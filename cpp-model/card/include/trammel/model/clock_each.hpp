// How a joined block clocks its parts: each of them in every clock. clock_parts() takes another way of doing so, which
// must leave the state that this one leaves, and returns false where no output of the part changed. Plain data.
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
