// Golden model of the step shaper: pulses with the drive's times at the pins, and the position that the pins show.
//
// Rules: the phases pulse, space, hold and setup last their time + 3 clocks. The pin is high for max(1, length) of
// them, from the third clock of the pulse's phase on. After the space the next pulse's phase begins, or else the
// direction's hold (a waiting step in DIR's direction cuts it short). After the hold DIR may turn, and the setup
// begins, then the pulse it turned for. Pins are one clock after all that. Not thread-safe; faults are reported by
// outputs().fault.
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
    bool wait_tick = false;         // one clock in HOLD_LIMIT
  };
  struct Outputs {
    bool step = false;           // pin
    bool dir = false;            // pin
    std::uint32_t position = 0;  // pulses, two's complement, wraps
    bool busy = false;           // steps wait, or a pulse or one of its times is under way
    bool fault = false;          // event: a step was lost, or waited from one wait tick to the next
  };
  enum class Phase : std::uint8_t { kRest, kSetup, kHigh, kSpace };
  // All that the next clock() depends on beside its inputs.
  struct State {
    Phase phase = Phase::kRest;
    std::uint32_t left = 0;  // clocks of the phase after this one
    bool back = false;       // DIR
    unsigned lead = 0;       // 3 as a pulse's phase begins, 1 in the pulse's first clock
    bool seen_same = false;  // what was waiting a clock ago
    bool seen_other = false;
    bool waited = false;
    bool pulse = false;  // at the pin
    std::uint8_t waiting = 0;
    std::uint8_t backs = 0;
    std::uint8_t mode = 0;
    Outputs out;

    // A pulse begins: the position has it in the next clock.
    bool begins() const { return lead == 1; }
  };

  StepShaper() = default;
  // `idle_level`: strap, {second pin, first pin}; MODE begins with these bits as its inversions.
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
  // A phase of t takes t + 3 clocks.
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

  // The directions that wait, the youngest in bit 0.
  void queue(const Inputs& in, bool served) {
    if (served) --state_.waiting;
    if (!in.step || state_.waiting == kPlaces) return;
    state_.backs = static_cast<std::uint8_t>(state_.backs << 1 | (in.dir ? 1 : 0));
    ++state_.waiting;
  }

  // Pins, position and busy follow the state before this clock.
  void show(const Inputs& in) {
    const bool begins = state_.begins();
    if (begins) state_.out.position += state_.back ? ~std::uint32_t{0} : 1U;
    // The first two clocks of the pulse's phase are low still, the last is low already.
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
