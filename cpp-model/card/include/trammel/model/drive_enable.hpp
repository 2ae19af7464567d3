// Golden model of the drives' enable and their brake: one sequence for all axes that ENABLE_AXES names. Motion that
// waits at the gate, or the host's order, starts the sequence; each stage lasts its delay plus one clock. The drives
// stay ready until the card has been at rest for ENABLE_IDLE, the order ends, or a fault forbids them; then the
// reverse sequence follows. The emergency stop disables at once. Inputs of clock c take effect at c + 1. Not
// thread-safe; no errors are reported.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class DriveEnable {
 public:
  // Units are powers of 2 clocks: 2^kDelayBits for the delays, 2^kIdleBits for ENABLE_IDLE.
  static constexpr unsigned kDelayBits = 12;
  static constexpr unsigned kIdleBits = 20;
  static constexpr std::uint64_t kForever = ~std::uint64_t{0};

  struct Inputs {
    Setting setting;
    bool moves = false;      // a path or a direct move takes ticks
    bool busy = false;       // something runs or is queued, or a pulse is under way
    bool emergency = false;  // level: the emergency stop
    std::uint32_t fault = 0;
  };
  enum class Stage : std::uint8_t { Off, Torque, Settle, Ready, Last, Brake };
  // All that the next clock() depends on besides its inputs.
  struct State {
    Stage stage = Stage::Off;
    std::uint64_t left = 0;  // clocks left of the stage after this one; in Ready: of the idle time
    std::uint8_t named = 0;  // ENABLE_AXES
    std::uint8_t axes = 0;   // axes that the sequence controls; taken from ENABLE_AXES at rest
    bool on = false;
    bool manual = false;
    std::uint32_t enable_delay = 0;
    std::uint32_t release_delay = 0;
    std::uint32_t stop_delay = 0;
    std::uint32_t set_delay = 0;
    std::uint32_t idle = 0;
    std::uint32_t causes = 0;
  };

  // `delay_bits`, `idle_bits`: exponents of the units; tests use smaller ones.
  explicit DriveEnable(unsigned axes = card_map::kMaxAxes, unsigned delay_bits = kDelayBits,
                       unsigned idle_bits = kIdleBits)
      : present_(static_cast<std::uint8_t>((1U << axes) - 1)), delay_bits_(delay_bits), idle_bits_(idle_bits) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const State next = next_state(in);
    state_ = next;
    if (in.setting.set) set(in.setting);
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool enabled() const { return state_.stage != Stage::Off; }
  bool released() const {
    return state_.stage == Stage::Settle || state_.stage == Stage::Ready || state_.stage == Stage::Last;
  }
  // True while no tick may be taken.
  bool waits() const { return state_.axes != 0 && state_.stage != Stage::Ready; }
  // The axes whose drives are disabled in this clock.
  std::uint8_t disables(const Inputs& in) const {
    return enabled() && next_state(in).stage == Stage::Off ? state_.axes : std::uint8_t{0};
  }
  // The number of clocks for which these inputs change nothing but `left`.
  std::uint64_t quiet_clocks(const Inputs& in) const {
    const State next = next_state(in);
    if (in.setting.set || next.stage != state_.stage || next.axes != state_.axes) return 0;
    if (next.left == state_.left) return kForever;
    return counts(in) ? state_.left : 0;
  }
  void pass(const Inputs& in, std::uint64_t clocks) {
    if (counts(in)) state_.left -= clocks;
  }

 private:
  std::uint64_t delay(std::uint32_t units) const { return std::uint64_t{units} << delay_bits_; }
  std::uint64_t idle() const { return std::uint64_t{state_.idle} << idle_bits_; }
  bool barred(const Inputs& in) const { return in.emergency || (in.fault & state_.causes) != 0; }
  static bool rests(const Inputs& in) { return !in.moves && !in.busy; }
  bool wanted(const Inputs& in) const {
    return state_.axes != 0 && !barred(in) && (state_.on || (in.moves && !state_.manual));
  }
  bool leaves(const Inputs& in) const {
    const bool idle_over = state_.idle != 0 && state_.left == 0;
    return rests(in) && (barred(in) || state_.axes == 0 || (!state_.on && (state_.manual || idle_over)));
  }
  // The timer of the stage runs.
  bool counts(const Inputs& in) const {
    return state_.left != 0 && state_.stage != Stage::Off && (state_.stage != Stage::Ready || rests(in));
  }

  State next_state(const Inputs& in) const {
    State s = state_;
    if (rests(in)) s.axes = state_.named;
    if (counts(in)) --s.left;
    const auto go = [&s](Stage stage, std::uint64_t clocks) {
      s.stage = stage;
      s.left = clocks;
    };
    const bool over = state_.left == 0;
    switch (state_.stage) {
      case Stage::Off:
        s.left = 0;
        if (wanted(in)) go(Stage::Torque, delay(state_.release_delay));
        break;
      case Stage::Torque:
      case Stage::Settle:
        if (barred(in))
          go(Stage::Brake, delay(state_.set_delay));
        else if (over && state_.stage == Stage::Torque)
          go(Stage::Settle, delay(state_.enable_delay));
        else if (over)
          go(Stage::Ready, idle());
        break;
      case Stage::Ready:
        if (!rests(in)) s.left = idle();
        if (leaves(in)) go(Stage::Last, delay(state_.stop_delay));
        break;
      case Stage::Last:
        if (over) go(Stage::Brake, delay(state_.set_delay));
        break;
      case Stage::Brake:
        if (over) go(Stage::Off, 0);
        break;
    }
    if (in.emergency) go(Stage::Off, 0);
    return s;
  }

  void set(const Setting& setting) {
    namespace reg = card_map::reg;
    namespace field = card_map::field;
    switch (setting.address) {
      case reg::kEnable:
        state_.on = (setting.data & field::kEnableOn) != 0;
        state_.manual = (setting.data & field::kEnableManual) != 0;
        break;
      case reg::kEnableAxes:
        state_.named = static_cast<std::uint8_t>(setting.data & present_);
        break;
      case reg::kEnableDelay:
        state_.enable_delay = setting.data;
        break;
      case reg::kBrakeReleaseDelay:
        state_.release_delay = setting.data;
        break;
      case reg::kStopDelay:
        state_.stop_delay = setting.data;
        break;
      case reg::kBrakeSetDelay:
        state_.set_delay = setting.data;
        break;
      case reg::kEnableIdle:
        state_.idle = setting.data;
        break;
      case reg::kDisableCauses:
        state_.causes = setting.data;
        break;
      default:
        break;
    }
  }

  std::uint8_t present_;
  unsigned delay_bits_;
  unsigned idle_bits_;
  State state_;
};

}  // namespace trammel::model
