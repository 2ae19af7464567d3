// Golden model of the feed generator: rate, acceleration and jerk of one profile piece, and the phase whose carry is
// the tick.
//
// With the rate r, acceleration a and jerk j of a piece, all in 2^-64 ticks an enabled clock (a and j an update),
// enabled clocks 32k..32k+31 after its swap add clamp(R_k) to the phase, where
//   R_k = r + k * a + k * (k - 1) / 2 * j   (mod 2^68, signed)
// and clamp() keeps it between the floor and 1 - 2^-48; R_0 is taken as it is. The phase has 48 bits and goes on from
// piece to piece. A piece of k updates thus covers 32 * (k * r + k(k-1)/2 * a + k(k-1)(k-2)/6 * j) ticks: the host
// sends forward differences, centred on the update (r = v + a/2 for a constant acceleration a an update).
// Acceleration and jerk come after the swap and have no shadow: they are added first at the 32nd enabled clock.
// Not thread-safe; no errors are reported: inputs outside their ranges are the caller's mistake.
#pragma once

#include <algorithm>
#include <cstdint>

#include "trammel/model/buses.hpp"

namespace trammel::model {

class FeedGenerator {
  __extension__ typedef unsigned __int128 uint128;
  static constexpr std::uint64_t kOne = std::uint64_t{1} << 48;

 public:
  struct Inputs {
    bool clear = false;   // phase and the ticks in flight become 0; wins over an enable in the same clock
    bool enable = false;  // one accumulation
    LoadWord load;      // feed load: rate (4 halfwords) and floor (2) before the swap, acceleration and jerk (4) after
    bool swap = false;  // the next piece's rate and floor are taken; no load in this clock or the 2 after it
  };
  struct Outputs {
    bool tick = false;
    std::uint32_t rate = 0;  // slope in use, 2^-32 ticks an enabled clock
  };

  static constexpr std::uint32_t kUpdateClocks = 32;
  // An enable at clock c shows its tick at c + kLatency, a swap at c its rate at c + kLatency.
  static constexpr std::uint32_t kLatency = 3;

  // One rising edge.
  void clock(const Inputs& in) {
    const bool carry = in.enable && accumulate();
    if (in.swap) swap();
    if (in.load.valid) load(in.load);
    outputs_ = in_flight_[1];
    in_flight_[1] = in_flight_[0];
    in_flight_[0] = {carry, static_cast<std::uint32_t>(slope_ >> 16)};
    if (in.clear) clear();
  }

  const Outputs& outputs() const { return outputs_; }

  // No tick is visible or in flight: what skip() needs.
  bool quiet() const { return !(outputs_.tick || in_flight_[0].tick || in_flight_[1].tick); }

  // Goes over the enabled clocks that do not carry, `limit` at most, and returns how many those were; so when it
  // returns less than `limit`, the next enabled clock gives a tick. The clocks that are not enabled change nothing and
  // may lie anywhere between. Only while quiet(), and without swap, load and clear. The tick is exact at once; the rate
  // shown is exact from the second clock() behind it on, since it lags by two clocks that need not be enabled ones.
  // Cost: one division at a constant rate, about a nanosecond an update otherwise.
  std::uint64_t skip(std::uint64_t limit) {
    std::uint64_t gone = 0;
    if (constant_) {
      gone = glide(limit);
    } else {
      gone = glide(std::min<std::uint64_t>(limit, kUpdateClocks - count_));
      // At count 0 an update was just reached; inside of one, a carry or the limit is what ended the way.
      if (count_ == 0) gone += whole_updates(limit - gone);
      if (count_ == 0) gone += glide(std::min<std::uint64_t>(limit - gone, kUpdateClocks));
    }
    const auto rate = static_cast<std::uint32_t>(slope_ >> 16);
    outputs_.rate = in_flight_[0].rate = in_flight_[1].rate = rate;
    return gone;
  }

  // The enabled clock that carries, behind a skip() that ended in front of it: its tick is the caller's to count and
  // does not appear. The rate shown lags as after skip().
  void carry_silently() { accumulate(); }

  // The rate stays what it is for the rest of the piece: ticks can be counted in closed form.
  bool constant() const { return constant_ && slope_ != 0; }
  // Ticks that the next `enables` enabled clocks give, and the enabled clocks until `ticks` more are given, the last
  // one included; only while constant(). Results are below 2^64: enables < 2^64, ticks < 2^60 * rate.
  std::uint64_t ticks_in(std::uint64_t enables) const {
    return static_cast<std::uint64_t>((phase_ + uint128{enables} * slope_) >> 48);
  }
  std::uint64_t enables_for(std::uint64_t ticks) const {
    return static_cast<std::uint64_t>(((uint128{ticks} << 48) - phase_ + slope_ - 1) / slope_);
  }
  // `enables` enabled clocks whose ticks are the caller's to count and do not appear; only while quiet() and
  // constant().
  void leap(std::uint64_t enables) {
    phase_ = static_cast<std::uint64_t>((phase_ + uint128{enables} * slope_) & (kOne - 1));
    count_ = static_cast<std::uint32_t>((count_ + enables) % kUpdateClocks);
    outputs_.rate = in_flight_[0].rate = in_flight_[1].rate = static_cast<std::uint32_t>(slope_ >> 16);
  }

  // Phase and slope in use, 2^-48 ticks (an enabled clock).
  std::uint64_t phase() const { return phase_; }
  std::uint64_t slope() const { return slope_; }

 private:
  static uint128 sign_extended(std::uint64_t value) {
    const std::uint64_t high = (value >> 63) != 0 ? ~std::uint64_t{0} : 0;
    return (uint128{high} << 64) | value;
  }

  // R counts modulo 2^68: 4 bits above the point, the uppermost of them the sign. The bits above are not looked at.
  static std::uint64_t clamped(uint128 rate, std::uint64_t floor_rate) {
    const auto whole = static_cast<std::uint64_t>(rate >> 64) & 0xF;
    const auto fraction = static_cast<std::uint64_t>(rate);
    if (whole == 0 && fraction >= floor_rate) return fraction >> 16;
    return whole == 0 || whole >= 8 ? floor_rate >> 16 : kOne - 1;
  }

  bool accumulate() {
    phase_ += slope_;
    const bool carry = phase_ >= kOne;
    if (carry) phase_ -= kOne;
    count_ = (count_ + 1) % kUpdateClocks;
    if (count_ == 0) update();
    return carry;
  }

  void update() {
    rate_ += acceleration_;
    acceleration_ += jerk_;
    slope_ = clamped(rate_, floor_rate_);
  }

  void swap() {
    rate_ = next_rate_;
    floor_rate_ = next_floor_ << 32;
    slope_ = next_rate_ >> 16;
    count_ = 0;
    judge_constant();
  }

  void load(const LoadWord& load) {
    if (load.target == feed_target::kRate) shift_in<64>(next_rate_, load.word);
    if (load.target == feed_target::kFloor) shift_in<32>(next_floor_, load.word);
    if (load.target == feed_target::kAcceleration) load_signed(acceleration_, load.word);
    if (load.target == feed_target::kJerk) load_signed(jerk_, load.word);
  }

  void load_signed(uint128& value, std::uint16_t word) {
    auto chain = static_cast<std::uint64_t>(value);
    shift_in<64>(chain, word);
    value = sign_extended(chain);
    judge_constant();
  }

  void judge_constant() { constant_ = acceleration_ == 0 && jerk_ == 0 && rate_ >= floor_rate_ && rate_ >> 64 == 0; }

  void clear() {
    phase_ = 0;
    outputs_.tick = in_flight_[0].tick = in_flight_[1].tick = false;
  }

  // Enabled clocks with the present slope, `limit` at most, up to just before the carry. The caller sees to it that no
  // update lies inside; the one at the end is made.
  std::uint64_t glide(std::uint64_t limit) {
    const std::uint64_t room = kOne - 1 - phase_;
    // Within one update the product tells without a division; beyond it could exceed 64 bits.
    const bool all = slope_ == 0 || (limit <= kUpdateClocks && limit * slope_ <= room);
    const std::uint64_t most = all ? limit : std::min(limit, room / slope_);
    phase_ += most * slope_;
    const std::uint64_t count = count_ + most;
    count_ = static_cast<std::uint32_t>(count % kUpdateClocks);
    if (!constant_ && count == kUpdateClocks) update();
    return most;
  }

  // Whole updates without a carry, from a count of 0. The hot loop of the skipping engine.
  std::uint64_t whole_updates(std::uint64_t limit) {
    const uint128 jerk = jerk_;
    const std::uint64_t floor_rate = floor_rate_;
    uint128 rate = rate_;
    uint128 acceleration = acceleration_;
    std::uint64_t slope = slope_;
    std::uint64_t phase = phase_;
    std::uint64_t gone = 0;
    for (; limit - gone >= kUpdateClocks; gone += kUpdateClocks) {
      const std::uint64_t sum = phase + slope * kUpdateClocks;  // below 2^48 + 2^53
      if (sum >= kOne) break;
      phase = sum;
      rate += acceleration;
      acceleration += jerk;
      slope = clamped(rate, floor_rate);
    }
    rate_ = rate;
    acceleration_ = acceleration;
    slope_ = slope;
    phase_ = phase;
    return gone;
  }

  std::uint64_t next_rate_ = 0;
  std::uint64_t next_floor_ = 0;  // 2^-32
  uint128 rate_ = 0;              // 2^-64
  uint128 acceleration_ = 0;
  uint128 jerk_ = 0;
  std::uint64_t floor_rate_ = 0;  // as the rate, 2^-64
  std::uint64_t slope_ = 0;       // 2^-48, below 1
  std::uint64_t phase_ = 0;       // 2^-48, below 1
  std::uint32_t count_ = 0;       // enabled clocks of this update
  bool constant_ = true;          // the slope is the rate for ever
  Outputs in_flight_[2];
  Outputs outputs_;
};

}  // namespace trammel::model
