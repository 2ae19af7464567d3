// Golden model of pulse width modulation on two channels of outputs.
//
// A channel whose outputs PWM_OUTPUTS names has periods of PWM_PERIOD clocks; each period begins with a pulse. The
// channels compute their on-times in turns, and a channel's turn comes every 256 clocks. If its period ends within
// 511 clocks, the first clock of the turn samples the speed, and the on-time is ready 85 clocks later. A period uses
// the latest on-time. If the order, the period or the outputs change during the computation, its result is dropped.
//
//   u = floor(rate * ratio / 2^17)          2^-31 ticks per clock, 0 if nothing moves
//   w = min(u * 2^shift, 2^31 - 1)
//   d = duty; if it follows the speed: min(duty, floor(half_up(w * gain / 2^17) / 2^13))
//   on-time = half_up(period * D / 2^16), D = d below 32768, otherwise d + 1
//
// Not thread-safe; no errors are reported.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/io_pins.hpp"

namespace trammel::model {

class Pwm {
 public:
  static constexpr unsigned kChannels = 2;
  static constexpr std::uint32_t kFirst = 512;  // clocks to the first period of a channel that starts
  static constexpr unsigned kTurn = 128;        // clocks per turn of a channel
  static constexpr unsigned kDone = 85;         // clocks from the sampling of the speed to the on-time
  static constexpr unsigned kGap = 127;         // clocks for which motion still counts after the last clock with a path
  static constexpr std::uint64_t kForever = ~std::uint64_t{0};

  // The speed, and the conditions under which a path moves at it.
  struct Speed {
    bool runs = false;    // a path is under way
    bool gives = false;   // a piece is under way, and the drives do not hold its ticks back
    bool silent = false;  // the piece makes no steps
    std::uint32_t rate = 0;
    std::uint32_t ratio = 0x10000;
  };
  struct Inputs {
    Setting setting;
    LoadWord load;
    bool take = false;   // a PWM is taken; its last halfword is on the load bus
    bool apply = false;  // event: waiting orders take effect
    bool drop = false;   // event: waiting orders are dropped
    Speed speed;
  };
  // The parameters of a PWM command.
  struct Order {
    bool follows = false;
    std::uint8_t shift = 0;
    std::uint16_t duty = 0;
    std::uint16_t gain = 0;
  };
  struct Channel {
    std::uint32_t period = 0x2710;
    std::uint16_t outputs = 0;
    Order order;
    Order waiting;
    bool waits = false;
    std::uint32_t left = kFirst;  // clocks left of the period
    std::uint32_t on = 0;         // clocks left of the pulse
    std::uint32_t next = 0;       // the latest on-time
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::array<Channel, kChannels> channels;
    std::uint64_t words = 0;
    bool merges = false;
    unsigned gap = 0;
    unsigned phase = 0;
    bool busy = false;  // an on-time is being computed
    std::uint32_t coming = 0;
  };

  explicit Pwm(unsigned outputs = 16, std::uint16_t idle = 0)
      : present_(static_cast<std::uint16_t>(present_pins(outputs))),
        idle_(static_cast<std::uint16_t>(idle & present_)) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const unsigned of = state_.phase / kTurn;
    const unsigned turn = state_.phase % kTurn;
    const bool moves = moving(in.speed.silent);
    const bool due = state_.channels[of].left < kFirst;
    bool waits = false;
    for (const Channel& c : state_.channels) waits = waits || c.waits;
    const bool cancels = stops(of, in.setting) || (in.apply && waits);
    const std::uint32_t coming = turn == 0 && due ? on_time(state_.channels[of], moves ? in.speed : Speed{}) : 0;
    for (unsigned n = 0; n < kChannels; ++n) clock_channel(n, in.setting, state_.busy && turn == kDone && n == of);
    if (turn == 0 && due) {
      state_.busy = true;
      state_.coming = coming;
    }
    if (turn == kDone || cancels) state_.busy = false;
    state_.phase = (state_.phase + 1) % (kTurn * kChannels);
    clock_commands(in);
    clock_gap(in.speed);
    set(in.setting);
  }

  const State& state() const { return state_; }
  State& state() { return state_; }
  // Levels at the pins. `level`: outputs without pulses; `silent` and `at_rest`: the motion in this clock.
  std::uint16_t pins(std::uint16_t level, bool silent, bool at_rest) const {
    const bool still = !moving(silent) || at_rest;
    unsigned carry = 0;
    unsigned high = 0;
    for (const Channel& c : state_.channels) {
      carry |= c.outputs;
      if (c.on != 0 && !(c.order.follows && still)) high |= c.outputs;
    }
    const unsigned low = carry & ~high;
    return static_cast<std::uint16_t>((level & ~low) | (idle_ & low));
  }

  // The number of clocks for which these inputs change no pin and sample no speed.
  std::uint64_t quiet_clocks(const Inputs& in) const {
    if (in.take || in.apply || in.drop || in.setting.set || state_.merges) return 0;
    if (in.load.to(load_target::kCommand)) return 0;
    const bool raw = in.speed.runs && in.speed.gives;
    std::uint64_t clocks = kForever;
    if (in.speed.silent ? state_.gap != 0 : raw ? state_.gap == 0 : false) return 0;
    if (!raw && state_.gap != 0) clocks = state_.gap - 1;
    for (unsigned n = 0; n < kChannels; ++n) clocks = std::min(clocks, quiet_clocks(n));
    return clocks;
  }
  // Passes `clocks` clocks, at most quiet_clocks(in).
  void pass(const Inputs& in, std::uint64_t clocks) {
    if (clocks == 0) return;
    const unsigned turn = state_.phase % kTurn;
    const std::uint64_t done = turn <= kDone ? kDone - turn : kForever;
    if (clocks > done) {
      if (state_.busy) state_.channels[state_.phase / kTurn].next = state_.coming;
      state_.busy = false;
    }
    for (Channel& c : state_.channels) {
      if (c.outputs == 0) continue;
      c.left -= static_cast<std::uint32_t>(clocks);
      c.on -= c.on == 0 ? 0 : static_cast<std::uint32_t>(clocks);
    }
    state_.phase = static_cast<unsigned>((state_.phase + clocks) % (kTurn * kChannels));
    if (in.speed.runs && in.speed.gives && !in.speed.silent)
      state_.gap = kGap;
    else
      state_.gap -= static_cast<unsigned>(std::min<std::uint64_t>(state_.gap, clocks));
  }

 private:
  static std::uint64_t product(std::uint64_t a, std::uint64_t b) { return (a * b + 0x10000) >> 17; }

  static std::uint32_t on_time(const Channel& c, const Speed& speed) {
    std::uint32_t duty = c.order.duty;
    if (c.order.follows) {
      const std::uint64_t most = (std::uint64_t{1} << 31) - 1;
      const std::uint64_t u = (std::uint64_t{speed.rate} * speed.ratio) >> 17;
      const std::uint64_t w = std::min(u << c.order.shift, most);
      duty = std::min(duty, static_cast<std::uint32_t>(product(w, c.order.gain) >> 13));
    }
    duty += duty >> 15;
    return static_cast<std::uint32_t>(product(2 * std::uint64_t{c.period}, duty));
  }

  bool moving(bool silent) const { return state_.gap != 0 && !silent; }

  bool stops(unsigned n, const Setting& setting) const {
    const std::uint32_t period = n == 0 ? card_map::reg::kPwmPeriod0 : card_map::reg::kPwmPeriod1;
    return (setting.set && setting.address == period) || state_.channels[n].outputs == 0;
  }

  void clock_channel(unsigned n, const Setting& setting, bool done) {
    Channel& c = state_.channels[n];
    if (c.left == 1) {
      c.left = c.period;
      c.on = c.next;
    } else {
      --c.left;
      if (c.on != 0) --c.on;
    }
    if (done) c.next = state_.coming;
    if (!stops(n, setting)) return;
    c.left = kFirst;
    c.on = c.next = 0;
  }

  void clock_commands(const Inputs& in) {
    if (in.apply) {
      for (Channel& c : state_.channels) {
        if (c.waits) c.order = c.waiting;
        c.waits = false;
      }
    }
    if (state_.merges) {
      Channel& c = state_.channels[state_.words & 1];
      c.waiting = {(state_.words >> 4 & 1) != 0, static_cast<std::uint8_t>(state_.words >> 8 & 0x1F),
                   static_cast<std::uint16_t>(state_.words >> 16), static_cast<std::uint16_t>(state_.words >> 32)};
      c.waits = true;
    }
    state_.merges = in.take;
    if (in.load.to(load_target::kCommand)) shift_in<48>(state_.words, in.load.word);
    if (!in.drop) return;
    state_.merges = false;
    for (Channel& c : state_.channels) c.waits = false;
  }

  void clock_gap(const Speed& speed) {
    if (speed.silent)
      state_.gap = 0;
    else if (speed.runs && speed.gives)
      state_.gap = kGap;
    else if (state_.gap != 0)
      --state_.gap;
  }

  void set(const Setting& setting) {
    if (!setting.set) return;
    if (setting.address == card_map::reg::kPwmPeriod0) state_.channels[0].period = setting.data;
    if (setting.address == card_map::reg::kPwmPeriod1) state_.channels[1].period = setting.data;
    if (setting.address != card_map::reg::kPwmOutputs) return;
    state_.channels[0].outputs = static_cast<std::uint16_t>(setting.data & present_);
    state_.channels[1].outputs = static_cast<std::uint16_t>(setting.data >> 16 & present_);
  }

  // Clocks before the one in which the channel's next turn begins.
  std::uint64_t to_turn(unsigned n) const {
    return (n * kTurn + kTurn * kChannels - state_.phase) % (kTurn * kChannels);
  }

  std::uint64_t quiet_clocks(unsigned n) const {
    const Channel& c = state_.channels[n];
    if (c.outputs == 0) {
      const bool stands = c.left == kFirst && c.on == 0 && c.next == 0;
      const bool at_work = state_.busy && state_.phase / kTurn == n;
      return stands && !at_work ? kForever : 0;
    }
    std::uint64_t clocks = c.left - 1;
    if (c.on != 0) clocks = std::min<std::uint64_t>(clocks, c.on - 1);
    // The first turn that finds the end of the period near.
    constexpr std::uint64_t kRound = kTurn * kChannels;
    const std::uint64_t turn = to_turn(n);
    const std::uint64_t rounds = c.left < turn + kFirst ? 0 : (c.left - turn - kFirst) / kRound + 1;
    return std::min(clocks, turn + rounds * kRound);
  }

  std::uint16_t present_;
  std::uint16_t idle_;
  State state_;
};

}  // namespace trammel::model
