// Golden model of the feed generator: rate, acceleration and jerk of one profile piece, and the phase whose carry is
// the tick.
//
// A piece has the rate r, acceleration a and jerk j, in units of 2^-64 ticks per enabled clock (a and j: per update).
// Enabled clocks 32k..32k+31 after its swap add clamp(R_k) to the phase, where
//   R_k = r + k * a + k * (k - 1) / 2 * j
// clamp() limits R_k to the range from the floor to 1 - 2^-48; R_0 is not limited. The first R_k outside -2 .. 2
// ticks per clock stays in force for the rest of the piece: the slope stays at the floor, or at 1. The phase has 48
// bits and continues from piece to piece. A piece of k updates therefore covers
//   32 * (k * r + k(k-1)/2 * a + k(k-1)(k-2)/6 * j)
// ticks. The host sends forward differences, centred on the update (r = v + a/2 for a constant acceleration of a per
// update).
// A freeze keeps the slope in use.
// Acceleration and jerk come after the swap and have no shadow register: they are first added at the 32nd enabled
// clock. Not thread-safe; no errors are reported: the caller must keep the inputs within their ranges.
#pragma once

#include <array>
#include <cstdint>

#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

class FeedGenerator {
 public:
  static constexpr std::uint64_t kOne = std::uint64_t{1} << 48;  // 1 tick, in the unit of phase and slope

  struct Inputs {
    bool clear = false;   // clears the phase and the ticks in flight; wins over an enable in the same clock
    bool enable = false;  // one accumulation
    bool freeze = false;  // keeps the slope, at least until the next swap
    LoadWord load;      // feed load: rate (4 halfwords) and floor (2) before the swap, acceleration and jerk (4) after
    bool swap = false;  // takes rate and floor of the next piece; no load in this clock and the 2 after it
  };
  struct Outputs {
    bool tick = false;
    std::uint32_t rate = 0;  // slope in use, 2^-32 ticks per enabled clock
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint64_t next_rate = 0;
    std::uint64_t next_floor = 0;  // 2^-32
    uint128 rate = 0;              // 2^-64
    uint128 acceleration = 0;
    uint128 jerk = 0;
    std::uint64_t floor_rate = 0;  // 2^-64, as the rate
    std::uint64_t slope = 0;       // 2^-48, below 1
    std::uint64_t phase = 0;       // 2^-48, below 1
    std::uint32_t count = 0;       // enabled clocks of this update
    bool away = false;             // the rate lies outside -2 .. 2
    bool frozen = false;
    bool constant = true;  // the slope cannot change before the end of the piece
    std::array<Outputs, 2> in_flight{};
    Outputs outputs;
  };

  static constexpr std::uint32_t kUpdateClocks = 32;
  // Clocks from an enable to its tick, and from a swap to its rate at the outputs.
  static constexpr std::uint32_t kLatency = 3;

  // One rising edge.
  void clock(const Inputs& in) {
    if (in.freeze) freeze();
    const bool carry = in.enable && accumulate();
    if (in.swap) swap();
    if (in.load.valid) load(in.load);
    state_.outputs = state_.in_flight[1];
    state_.in_flight[1] = state_.in_flight[0];
    state_.in_flight[0] = {carry, static_cast<std::uint32_t>(state_.slope >> 16)};
    if (in.clear) clear();
  }

  const Outputs& outputs() const { return state_.outputs; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // The update after the last of 32 enabled clocks. It depends only on the state.
  void update() {
    if (!state_.away) {
      state_.rate += state_.acceleration;
      state_.acceleration += state_.jerk;
      const auto whole = static_cast<std::int64_t>(static_cast<std::uint64_t>(state_.rate >> 64));
      state_.away = whole < -2 || whole >= 2;
    }
    state_.slope = clamped(state_.rate, state_.floor_rate);
    state_.constant = state_.away || (state_.acceleration == 0 && state_.jerk == 0);
  }

  static uint128 sign_extended(std::uint64_t value) {
    const std::uint64_t high = (value >> 63) != 0 ? ~std::uint64_t{0} : 0;
    return (uint128{high} << 64) | value;
  }

 private:
  // The rate is within +-8: 4 bits above the binary point, of which the uppermost is the sign.
  static std::uint64_t clamped(uint128 rate, std::uint64_t floor_rate) {
    const auto whole = static_cast<std::uint64_t>(rate >> 64) & 0xF;
    const auto fraction = static_cast<std::uint64_t>(rate);
    if (whole == 0 && fraction >= floor_rate) return fraction >> 16;
    return whole == 0 || whole >= 8 ? floor_rate >> 16 : kOne - 1;
  }

  bool accumulate() {
    state_.phase += state_.slope;
    const bool carry = state_.phase >= kOne;
    if (carry) state_.phase -= kOne;
    state_.count = (state_.count + 1) % kUpdateClocks;
    if (state_.count == 0 && !state_.frozen) update();
    return carry;
  }

  void swap() {
    state_.rate = state_.next_rate;
    state_.floor_rate = state_.next_floor << 32;
    state_.slope = state_.next_rate >> 16;
    state_.count = 0;
    state_.away = state_.frozen = false;
    judge_constant();
  }

  void load(const LoadWord& load) {
    if (load.target == feed_target::kRate) shift_in<64>(state_.next_rate, load.word);
    if (load.target == feed_target::kFloor) shift_in<32>(state_.next_floor, load.word);
    if (load.target == feed_target::kAcceleration) load_signed(state_.acceleration, load.word);
    if (load.target == feed_target::kJerk) load_signed(state_.jerk, load.word);
  }

  void load_signed(uint128& value, std::uint16_t word) {
    auto chain = static_cast<std::uint64_t>(value);
    shift_in<64>(chain, word);
    value = sign_extended(chain);
    judge_constant();
  }

  void judge_constant() {
    state_.constant = state_.frozen || (state_.acceleration == 0 && state_.jerk == 0 &&
                                        state_.slope == clamped(state_.rate, state_.floor_rate));
  }

  void freeze() { state_.frozen = state_.constant = true; }

  void clear() {
    state_.phase = 0;
    state_.outputs.tick = state_.in_flight[0].tick = state_.in_flight[1].tick = false;
  }

  State state_;
};

}  // namespace trammel::model
