// Golden model of the commands that take effect at a point of the path, in addition to motion: OUTPUT, PWM and MARK.
//
// They take effect kToStep clocks after the end of the path that ran when they were decoded shows, that is with the
// step of its last tick. If no path runs, they take effect the same number of clocks after they are taken. A command
// that is taken while others are on their way takes effect with them (outputs, PWM) or after them (marks). Not
// thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"
#include "trammel/model/io_pins.hpp"
#include "trammel/model/pwm.hpp"

namespace trammel::model {

class PathCommands {
 public:
  struct Config {
    unsigned outputs = 4;           // 1 .. 16
    std::uint16_t output_idle = 0;  // strap: levels in reset
  };
  struct Inputs {
    bool cut = false;
    bool caused = false;  // a cause of a stop comes, a stop is under way, or the card is stopped
    bool halt = false;    // waiting commands are dropped, but the outputs keep their levels
    bool output = false;  // an OUTPUT is taken; its last halfword is on the load bus
    bool mark = false;    // a MARK is taken
    bool pwm = false;     // a PWM is taken; its last halfword is on the load bus
    bool over = false;    // event: a path has ended
    bool runs = false;    // a path is under way
    LoadWord load;
    Setting setting;
    Pwm::Speed speed;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    OutputPins outputs;
    OutputRoles roles;
    Pwm pwm;
    std::uint64_t masks = 0;  // masks of the last OUTPUT: {clear, set}
    std::uint16_t set = 0;
    std::uint16_t clear = 0;
    bool merges = false;        // the masks are complete and join `set` and `clear`
    bool output_waits = false;  // an OUTPUT or a PWM waits
    bool mark_waits = false;
    bool mark_goes = false;
    bool mark = false;
    unsigned left = 0;  // clocks until the commands on their way have taken effect
    std::uint32_t marks_taken = 0;
    std::uint32_t marks = 0;
  };

  // Clocks from the one in which a path's end shows, or a command could take effect, to the one in which it has.
  static constexpr unsigned kToStep = 7;

  // `pwm`: the card has pulse width modulation.
  explicit PathCommands(const Config& config, bool pwm = false)
      : has_pwm_(pwm),
        state_{OutputPins(config.outputs, config.output_idle), OutputRoles(config.outputs, config.output_idle),
               Pwm(config.outputs, config.output_idle)} {}

  // One rising edge.
  void clock(const Inputs& in) {
    const bool due = this->due(in);
    state_.outputs.clock(in.cut, in.caused, due ? state_.set : std::uint16_t{0}, due ? state_.clear : std::uint16_t{0},
                         in.setting);
    state_.roles.clock(in.setting);
    if (has_pwm_) state_.pwm.clock(pwm_inputs(in));
    state_.mark = due && state_.mark_goes;
    if (state_.mark) state_.marks = state_.marks_taken;
    if (due) state_.set = state_.clear = 0;
    const bool goes = state_.left == 0 && (state_.output_waits || state_.mark_waits) && (in.over || !in.runs);
    if (state_.left != 0) --state_.left;
    if (goes) {
      state_.left = kToStep - 1;
      state_.mark_goes = state_.mark_waits;
      state_.output_waits = state_.mark_waits = false;
    }
    take(in);
    if (in.cut || in.halt) drop();
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  bool has_pwm() const { return has_pwm_; }
  // True if commands take effect in this clock.
  bool due(const Inputs& in) const { return state_.left == 1 && !in.cut && !in.halt; }
  Pwm::Inputs pwm_inputs(const Inputs& in) const {
    return {in.setting, in.load, in.pwm, due(in), in.cut || in.halt, in.speed};
  }
  // Levels without PWM pulses; `latched`: the emergency stop's latch is set.
  std::uint16_t outputs(bool latched, const OutputRoleLevels& roles) const {
    return state_.roles.pins(state_.outputs.level(latched), roles, latched);
  }
  // Levels at the pins: `level` with PWM pulses; `at_rest`: the ratio is 0.
  std::uint16_t pins(std::uint16_t level, bool silent, bool at_rest) const {
    return has_pwm_ ? state_.pwm.pins(level, silent, at_rest) : level;
  }
  std::uint32_t marks() const { return state_.marks; }
  bool mark() const { return state_.mark; }  // event: a snapshot is wanted

 private:
  // The masks of an OUTPUT are complete one clock after it is taken. The later of two OUTPUTs wins.
  void take(const Inputs& in) {
    if (state_.merges) {
      const auto set = static_cast<std::uint16_t>(state_.masks);
      const auto clear = static_cast<std::uint16_t>(state_.masks >> 16);
      state_.set = static_cast<std::uint16_t>((state_.set & ~clear) | set);
      state_.clear = static_cast<std::uint16_t>((state_.clear & ~set) | clear);
    }
    state_.merges = in.output;
    state_.output_waits = state_.output_waits || in.output || in.pwm;
    state_.mark_waits = state_.mark_waits || in.mark;
    state_.marks_taken += in.mark ? 1 : 0;
    if (in.load.to(load_target::kCommand)) shift_in<32>(state_.masks, in.load.word);
  }

  void drop() {
    state_.left = 0;
    state_.set = state_.clear = 0;
    state_.merges = state_.output_waits = state_.mark_waits = false;
    state_.marks_taken = state_.marks;
  }

  bool has_pwm_;
  State state_;
};

}  // namespace trammel::model
