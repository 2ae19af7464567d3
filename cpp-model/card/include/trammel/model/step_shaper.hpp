// Golden model of the step shaper: makes pulses with the drive's times at the pins, and counts the position that the
// pins show.
//
// Rules: the phases pulse, space, hold and setup last their time + 3 clocks. The pin is high for max(1, length)
// clocks, from the third clock of the pulse phase on. After the space comes the next pulse phase, or else the
// direction hold (a waiting step in DIR's direction ends it early). After the hold DIR may turn; then the setup
// follows, and then the pulse for which DIR turned. The pins are one clock later than all this. Not thread-safe;
// faults are reported by outputs().fault.
#pragma once

#include <cstdint>

namespace trammel::model {

class StepShaper {
 public:
  static constexpr unsigned kPlaces = 4;  // steps that can wait

  struct Inputs {
    bool step = false;
    bool dir = false;               // 1 = negative
    std::uint16_t step_length = 0;  // clocks
    std::uint16_t step_space = 0;   // clocks
    std::uint16_t dir_setup = 0;    // clocks
    std::uint16_t dir_hold = 0;     // clocks
    std::uint8_t mode = 0;          // [1:0] 0 step/dir, 1 up/down, 2 or 3 quadrature; [2] inverts step, [3] dir
    bool wait_tick = false;         // a tick every HOLD_LIMIT clocks
  };
  struct Outputs {
    bool step = false;           // pin
    bool dir = false;            // pin
    std::uint32_t position = 0;  // pulses, two's complement, wraps
    bool busy = false;           // steps wait, or a pulse or one of its times is under way
    bool fault = false;          // event: a step was lost, or waited from one wait tick to the next
  };
  enum class Phase : std::uint8_t { kRest, kSetup, kHigh, kSpace };
  // All that the next clock() depends on besides its inputs.
  struct State {
    Phase phase = Phase::kRest;
    std::uint32_t left = 0;    // clocks left of the phase after this clock
    bool back = false;         // level of DIR: negative
    unsigned lead = 0;         // 3 as a pulse phase begins, 1 in the first clock of the pulse
    bool seen_same = false;    // one clock ago the oldest waiting step had DIR's direction
    bool seen_other = false;   // one clock ago it had the other direction
    bool waited = false;       // it was waiting at the last wait tick
    bool pulse = false;        // at the pin
    std::uint8_t waiting = 0;  // number of waiting steps
    std::uint8_t backs = 0;    // their directions, the youngest in bit 0
    std::uint8_t mode = 0;
    Outputs out;

    // A pulse begins: the position includes it in the next clock.
    bool begins() const { return lead == 1; }
  };

  StepShaper() = default;
  // `idle_level`: strap, {second pin, first pin}; its bits are the initial inversions of MODE.
  explicit StepShaper(unsigned idle_level) {
    state_.mode = static_cast<std::uint8_t>((idle_level & 3) << 2);
    state_.out.step = (idle_level & 1) != 0;
    state_.out.dir = (idle_level & 2) != 0;
  }

  // One rising edge.
  void clock(const Inputs& in) {
    const bool expired = state_.left == 0;
    show(in);
    if (state_.lead != 0) --state_.lead;
    const bool go = state_.seen_same && (state_.phase == Phase::kRest || (state_.phase == Phase::kSpace && expired));
    const bool head_same = state_.waiting != 0 && head_back() == state_.back;
    const bool head_other = state_.waiting != 0 && !head_same;
    bool served = false;
    if (go || (state_.phase == Phase::kSetup && expired)) {
      enter(Phase::kHigh, in.step_length);
      state_.lead = 3;
      served = true;
    } else if (state_.phase == Phase::kRest && state_.seen_other && expired) {
      enter(Phase::kSetup, in.dir_setup);
      state_.back = !state_.back;
    } else if (state_.phase == Phase::kHigh && expired) {
      enter(Phase::kSpace, in.step_space);
    } else if (state_.phase == Phase::kSpace && expired) {
      enter(Phase::kRest, in.dir_hold);
    } else if (state_.left != 0) {
      --state_.left;
    }
    state_.seen_same = head_same;
    state_.seen_other = head_other;
    judge(in, served);
    queue(in, served);
  }

  const Outputs& outputs() const { return state_.out; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  // A phase with time t lasts t + 3 clocks.
  void enter(Phase phase, std::uint16_t time) {
    state_.phase = phase;
    state_.left = std::uint32_t{time} + 2;
  }

  bool head_back() const { return (state_.backs >> (state_.waiting - 1) & 1) != 0; }

  void judge(const Inputs& in, bool served) {
    const bool lost = in.step && state_.waiting == kPlaces && !served;
    const bool late = in.wait_tick && state_.waited && !served;
    state_.out.fault = lost || late;
    if (served)
      state_.waited = false;
    else if (in.wait_tick)
      state_.waited = state_.waiting != 0;
  }

  // Stores the direction of a step that must wait.
  void queue(const Inputs& in, bool served) {
    if (served) --state_.waiting;
    if (!in.step || state_.waiting == kPlaces) return;
    state_.backs = static_cast<std::uint8_t>(state_.backs << 1 | (in.dir ? 1 : 0));
    ++state_.waiting;
  }

  // Pins, position and busy follow the state from before this edge.
  void show(const Inputs& in) {
    const bool begins = state_.begins();
    if (begins) state_.out.position += state_.back ? ~std::uint32_t{0} : 1U;
    // The pin is still low in the first two clocks of the pulse phase, and low again in the last one.
    const bool pulse = state_.phase == Phase::kHigh && (begins || (state_.lead == 0 && state_.left != 0));
    state_.pulse = pulse;
    bool first = pulse;
    bool second = state_.back;
    if ((in.mode & 3) == 1) {
      first = pulse && !state_.back;
      second = pulse && state_.back;
    } else if ((in.mode & 3) >= 2) {
      first = ((state_.out.position + 1) & 2) != 0;
      second = (state_.out.position & 2) != 0;
    }
    state_.out.step = first != ((in.mode & 4) != 0);
    state_.out.dir = second != ((in.mode & 8) != 0);
    state_.out.busy = in.step || state_.waiting != 0 || state_.phase != Phase::kRest || state_.left != 0;
    state_.mode = in.mode;
  }

  State state_;
};

}  // namespace trammel::model
