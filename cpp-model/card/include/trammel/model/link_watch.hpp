// Golden model of the watch over the link to the writing session: the session whose stream word, or whose write of
// LINK_TIMEOUT, was accepted last. Each accepted access of that session restarts the time. The link is lost after
// LINK_TIMEOUT units, plus up to one more, without such an access; it stays lost until LINK_TIMEOUT is written. When
// a later session begins at the same port, the writing session is gone, but its time continues. Not thread-safe; no
// errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class LinkWatch {
 public:
  // A unit of LINK_TIMEOUT is 2^kUnitBits clocks.
  static constexpr unsigned kUnitBits = 16;

  struct Inputs {
    bool ack = false;  // event: an access was answered
    bool error = false;
    bool write = false;
    std::uint32_t address = 0;  // bytes
    std::uint8_t port = 0;
    bool of_session = true;    // a session of the port made the access, not the port itself
    bool new_session = false;  // it is the first access of a session
    Setting setting;           // LINK_TIMEOUT, in the clock of its answer
    bool unit = false;         // event: a unit of time has passed
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    bool written = false;     // there is, or was, a writing session
    std::uint8_t writer = 0;  // its port
    bool gone = false;
    std::uint32_t timeout = 0;  // units
    std::uint32_t left = 0;     // units that must pass before the last one
    bool lost = false;
  };

  // One rising edge.
  void clock(const Inputs& in) {
    const bool sets = in.setting.set && in.setting.address == card_map::reg::kLinkTimeout;
    const bool accepted = in.ack && !in.error;
    const bool claims = sets || (accepted && in.write && in.address == card_map::reg::kStream);
    const bool at_port = in.of_session && state_.written && in.port == state_.writer;
    if (in.ack && at_port && in.new_session) state_.gone = true;
    const bool feeds = claims || (accepted && at_port && !state_.gone);
    if (claims) {
      state_.written = true;
      state_.writer = in.port;
      state_.gone = false;
    }
    if (sets) {
      state_.timeout = in.setting.data;
      state_.lost = false;
    }
    if (feeds)
      state_.left = state_.timeout;
    else if (in.unit && watches() && state_.left-- == 0)
      state_.lost = true;
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool gone() const { return state_.gone; }
  bool lost() const { return state_.lost; }
  // True while time is counted.
  bool watches() const { return state_.timeout != 0 && !state_.lost; }

 private:
  State state_;
};

}  // namespace trammel::model
