// How a joined block clocks its parts: each of them in every clock. clock_parts() takes another way of doing so, which
// must leave the state that this one leaves. Plain data.
#pragma once

namespace trammel::model {

struct ClockEach {
  template <class Part>
  void operator()(Part& part, const typename Part::Inputs& in) const {
    part.clock(in);
  }
};

}  // namespace trammel::model
