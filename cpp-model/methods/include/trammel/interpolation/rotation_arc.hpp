// Circles and their arcs by rotation, in chords: X -= Y / 2^k, Y += X / 2^k, half a chord apart. Between two
// rotations each axis's pulse generator runs with a constant increment, so an arc is a line whose increments turn.
// The end is met exactly: the phases are preset to the circle's offset from whole pulses, and a constant closing
// increment spreads the remaining error over all ticks. Units: pulses; time in path ticks, at least 8 per pulse of
// path length. No errors are reported; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/interpolation/curve.hpp"

namespace trammel::interpolation {

class RotationArc {
 public:
  explicit RotationArc(const Arc& circle);

  bool done() const { return !pending_; }
  // Not to be called when done.
  Step next();
  const Position& position() const { return position_; }
  // Unit: ticks.
  std::uint64_t time() const { return time_; }
  std::uint64_t total_time() const { return ticks_; }

  static constexpr int kFraction = 32;  // fraction bits of X and Y: |X| < 2^31 pulses in 64 bits
  static constexpr int kPhase = 40;     // fraction bits of the pulse generators
  static constexpr int kSparse = 5;     // at least 2^5 ticks per chord: a rotation takes up to 20 clocks
  static constexpr int kDense = 8;      // ticks per pulse

 private:
  // Converts a chord's displacement from the rotation's fraction to the increment of one tick, with the phase's
  // fraction. The shift is exact, because a chord of at most 16 pulses takes at most 2^7 ticks, fewer than 2^(kPhase
  // - kFraction).
  std::int64_t increment(std::int64_t chord) const {
    return chord * (std::int64_t{1} << (kPhase - kFraction - chord_bits_));
  }
  // value / 2^k, rounded: truncation would shift the centre.
  std::int64_t turned(std::int64_t value) const;
  // To be called at the end of each half chord: rotates X and Y alternately.
  void rotate();
  // Advances to the next tick with a step; after the last one none is pending.
  void advance();

  Position position_;
  std::int64_t sign_;   // 1 counter-clockwise, -1 clockwise
  int shift_ = 0;       // k
  int chord_bits_ = 0;  // 2^chord_bits_ ticks per chord
  std::int64_t x_ = 0;  // X at whole chord times
  std::int64_t y_ = 0;  // Y at half chord times
  std::int64_t chord_x_ = 0;
  std::int64_t chord_y_ = 0;
  std::int64_t closing_x_ = 0;
  std::int64_t closing_y_ = 0;
  std::int64_t increment_x_ = 0;  // per tick, until the next rotation
  std::int64_t increment_y_ = 0;
  std::int64_t phase_x_ = 0;
  std::int64_t phase_y_ = 0;
  std::uint64_t corner_ = 0;  // the next rotation comes before this tick
  std::uint64_t tick_ = 0;    // ticks made
  std::uint64_t ticks_ = 0;
  std::uint64_t time_ = 0;
  bool pending_ = false;
  Step step_;
};

}  // namespace trammel::interpolation
