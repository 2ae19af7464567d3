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

  StepShaper() = default;
  // `idle_level`: strap, {second pin, first pin}; MODE begins with these bits as its inversions.
  explicit StepShaper(unsigned idle_level) : mode_(static_cast<std::uint8_t>((idle_level & 3) << 2)) {
    out_.step = (idle_level & 1) != 0;
    out_.dir = (idle_level & 2) != 0;
  }

  // One rising edge.
  void clock(const Inputs& in) {
    if (!quiet_ || in.step || in.mode != mode_) clock_always(in);
  }

  // The same without a look at whether anything can change.
  void clock_always(const Inputs& in) {
    const bool expired = left_ == 0;
    show(in);
    if (lead_ != 0) --lead_;
    const bool go = seen_same_ && (phase_ == Phase::kRest || (phase_ == Phase::kSpace && expired));
    const bool head_same = waiting_ != 0 && head_back() == back_;
    const bool head_other = waiting_ != 0 && !head_same;
    bool served = false;
    if (go || (phase_ == Phase::kSetup && expired)) {
      enter(Phase::kHigh, in.step_length);
      lead_ = 3;
      served = true;
    } else if (phase_ == Phase::kRest && seen_other_ && expired) {
      enter(Phase::kSetup, in.dir_setup);
      back_ = !back_;
    } else if (phase_ == Phase::kHigh && expired) {
      enter(Phase::kSpace, in.step_space);
    } else if (phase_ == Phase::kSpace && expired) {
      enter(Phase::kRest, in.dir_hold);
    } else if (left_ != 0) {
      --left_;
    }
    seen_same_ = head_same;
    seen_other_ = head_other;
    judge(in, served);
    queue(in, served);
    quiet_ = !out_.busy;
  }

  const Outputs& outputs() const { return out_; }

  // MODE as the pins show it.
  std::uint8_t mode() const { return mode_; }
  // Steps wait: the only state in which wait_tick means anything.
  bool waiting() const { return waiting_ != 0; }
  // Nothing changes any more without a step or a new mode.
  bool quiet() const { return quiet_; }

  // The number of clocks, without step and with the other inputs as they are, for which no output changes (wait_tick
  // may come in them unless waiting()). A lower bound; 2^63 when quiet().
  std::uint64_t idle_clocks() const {
    if (quiet_) return std::uint64_t{1} << 63;
    if (out_.fault || lead_ != 0 || waiting_ != 0 || phase_ == Phase::kSetup || left_ < 4) return 0;
    if (pulse_ != (phase_ == Phase::kHigh)) return 0;  // a pulse of length 0 shows in the first clock of its space
    return left_ - 3;
  }

  // n clocks at once, n <= idle_clocks().
  void advance(std::uint64_t n) {
    if (!quiet_) left_ -= static_cast<std::uint32_t>(n);
  }

  // Nothing waits and no pulse is about to begin: without a step the position stays and no fault can come.
  bool calm() const { return waiting_ == 0 && lead_ == 0 && !waited_ && !out_.fault; }

  // n clocks without step and wait tick, while calm().
  void pass(const Inputs& times, std::uint64_t n) {
    while (n != 0) {
      const std::uint64_t idle = idle_clocks();
      const std::uint64_t some = idle < n ? idle : n;
      if (some != 0) {
        advance(some);
        n -= some;
      } else {
        clock_always(times);
        --n;
      }
    }
  }

 private:
  enum class Phase : std::uint8_t { kRest, kSetup, kHigh, kSpace };

  // A phase of t takes t + 3 clocks.
  void enter(Phase phase, std::uint16_t time) {
    phase_ = phase;
    left_ = std::uint32_t{time} + 2;
  }

  bool head_back() const { return (backs_ >> (waiting_ - 1) & 1) != 0; }

  void judge(const Inputs& in, bool served) {
    const bool lost = in.step && waiting_ == kPlaces && !served;
    const bool late = in.wait_tick && waited_ && !served;
    out_.fault = lost || late;
    if (served)
      waited_ = false;
    else if (in.wait_tick)
      waited_ = waiting_ != 0;
  }

  // The directions that wait, the youngest in bit 0.
  void queue(const Inputs& in, bool served) {
    if (served) --waiting_;
    if (!in.step || waiting_ == kPlaces) return;
    backs_ = static_cast<std::uint8_t>(backs_ << 1 | (in.dir ? 1 : 0));
    ++waiting_;
  }

  // Pins, position and busy follow the state before this clock.
  void show(const Inputs& in) {
    const bool begins = lead_ == 1;
    if (begins) out_.position += back_ ? ~std::uint32_t{0} : 1U;
    // The first two clocks of the pulse's phase are low still, the last is low already.
    const bool pulse = phase_ == Phase::kHigh && (begins || (lead_ == 0 && left_ != 0));
    pulse_ = pulse;
    bool first = pulse;
    bool second = back_;
    if ((in.mode & 3) == 1) {
      first = pulse && !back_;
      second = pulse && back_;
    } else if ((in.mode & 3) >= 2) {
      first = ((out_.position + 1) & 2) != 0;
      second = (out_.position & 2) != 0;
    }
    out_.step = first != ((in.mode & 4) != 0);
    out_.dir = second != ((in.mode & 8) != 0);
    out_.busy = in.step || waiting_ != 0 || phase_ != Phase::kRest || left_ != 0;
    mode_ = in.mode;
  }

  Phase phase_ = Phase::kRest;
  std::uint32_t left_ = 0;  // clocks of the phase after this one
  bool back_ = false;       // DIR
  unsigned lead_ = 0;       // 3 as a pulse's phase begins, 1 in the pulse's first clock
  bool seen_same_ = false;  // what was waiting a clock ago
  bool seen_other_ = false;
  bool waited_ = false;
  bool pulse_ = false;  // at the pin
  bool quiet_ = true;
  std::uint8_t waiting_ = 0;
  std::uint8_t backs_ = 0;
  std::uint8_t mode_ = 0;
  Outputs out_;
};

}  // namespace trammel::model
