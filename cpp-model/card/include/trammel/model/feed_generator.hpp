// Golden model of the feed generator: rate, acceleration and jerk of one profile piece, and the phase whose carry is
// the tick.
//
// With the rate r, acceleration a and jerk j of a piece, all in 2^-64 ticks an enabled clock (a and j an update),
// enabled clocks 32k..32k+31 after its swap add clamp(R_k) to the phase, where
//   R_k = r + k * a + k * (k - 1) / 2 * j
// and clamp() keeps it between the floor and 1 - 2^-48; R_0 is taken as it is. The first R_k outside -2 .. 2 (ticks a
// clock) is that of all that follow in the piece: it stays at the floor, or at 1. The phase has 48 bits and goes on
// from piece to piece. A piece of k updates thus covers 32 * (k * r + k(k-1)/2 * a + k(k-1)(k-2)/6 * j) ticks: the host
// sends forward differences, centred on the update (r = v + a/2 for a constant acceleration a an update).
// Frozen, the slope in use stays.
// Acceleration and jerk come after the swap and have no shadow: they are added first at the 32nd enabled clock.
// Not thread-safe; no errors are reported: inputs outside their ranges are the caller's mistake.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"
#include "trammel/model/wide.hpp"

namespace trammel::model {

class FeedGenerator {
  static constexpr std::uint64_t kOne = std::uint64_t{1} << 48;

 public:
  struct Inputs {
    bool clear = false;   // phase and the ticks in flight become 0; wins over an enable in the same clock
    bool enable = false;  // one accumulation
    bool freeze = false;  // the slope stays, until the next swap at least
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
    if (in.freeze) freeze();
    const bool carry = in.enable && accumulate();
    if (in.swap) swap();
    if (in.load.valid) load(in.load);
    outputs_ = in_flight_[1];
    in_flight_[1] = in_flight_[0];
    in_flight_[0] = {carry, static_cast<std::uint32_t>(slope_ >> 16)};
    if (in.clear) clear();
  }

  const Outputs& outputs() const { return outputs_; }

  // No tick is visible or in flight, and the rate shown is the one in use: without inputs nothing changes.
  bool quiet() const {
    const auto rate = static_cast<std::uint32_t>(slope_ >> 16);
    return !(outputs_.tick || in_flight_[0].tick || in_flight_[1].tick) && outputs_.rate == rate &&
           in_flight_[0].rate == rate && in_flight_[1].rate == rate;
  }

  // The carry of the last clock(), and those of the two before.
  bool carried(unsigned clocks_ago) const { return clocks_ago == 2 ? outputs_.tick : in_flight_[clocks_ago].tick; }

  struct Advanced {
    std::uint64_t enables = 0;
    std::uint64_t carries = 0;
  };
  // Enabled clocks at once, up to the one that carries for the `carries`-th time, `limit` at most. Exact in all but
  // what is in flight: neither ticks nor rates appear before 3 more clocks of clock(). Without swap, load and clear.
  // Cost: a division at a constant rate, else about a nanosecond an update.
  Advanced advance(std::uint64_t limit, std::uint64_t carries);

  // Phase and slope in use, 2^-48 ticks (an enabled clock).
  std::uint64_t phase() const { return phase_; }
  std::uint64_t slope() const { return slope_; }

 private:
  static uint128 sign_extended(std::uint64_t value) {
    const std::uint64_t high = (value >> 63) != 0 ? ~std::uint64_t{0} : 0;
    return (uint128{high} << 64) | value;
  }

  // Within +-8: 4 bits above the point, the uppermost of them the sign.
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
    if (count_ == 0 && !frozen_) update();
    return carry;
  }

  void update() {
    if (!away_) {
      rate_ += acceleration_;
      acceleration_ += jerk_;
      const auto whole = static_cast<std::int64_t>(static_cast<std::uint64_t>(rate_ >> 64));
      away_ = whole < -2 || whole >= 2;
    }
    slope_ = clamped(rate_, floor_rate_);
    constant_ = away_ || (acceleration_ == 0 && jerk_ == 0);
  }

  void swap() {
    rate_ = next_rate_;
    floor_rate_ = next_floor_ << 32;
    slope_ = next_rate_ >> 16;
    count_ = 0;
    away_ = frozen_ = false;
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

  void judge_constant() {
    constant_ = frozen_ || (acceleration_ == 0 && jerk_ == 0 && slope_ == clamped(rate_, floor_rate_));
  }

  void freeze() { frozen_ = constant_ = true; }

  void clear() {
    phase_ = 0;
    outputs_.tick = in_flight_[0].tick = in_flight_[1].tick = false;
  }

  void advance_constant(Advanced& gone, std::uint64_t limit, std::uint64_t carries);
  void advance_varying(Advanced& gone, std::uint64_t limit, std::uint64_t carries);
  std::uint64_t whole_updates(std::uint64_t& sum, std::uint64_t target, std::uint64_t most);
  bool unclamped_for(std::uint64_t updates) const;

  std::uint64_t next_rate_ = 0;
  std::uint64_t next_floor_ = 0;  // 2^-32
  uint128 rate_ = 0;              // 2^-64
  uint128 acceleration_ = 0;
  uint128 jerk_ = 0;
  std::uint64_t floor_rate_ = 0;  // as the rate, 2^-64
  std::uint64_t slope_ = 0;       // 2^-48, below 1
  std::uint64_t phase_ = 0;       // 2^-48, below 1
  std::uint32_t count_ = 0;       // enabled clocks of this update
  bool away_ = false;             // the rate lies outside -2 .. 2
  bool frozen_ = false;
  bool constant_ = true;  // the slope stays to the end of the piece
  Outputs in_flight_[2];
  Outputs outputs_;
};

}  // namespace trammel::model
