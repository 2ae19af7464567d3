// What blocks have in common in their locksteps: buses as the RTL's ports carry them, the snapshot's slice, dice.
#pragma once

#include <cstdint>
#include <random>

#include "trammel/model/buses.hpp"
#include "trammel/model/underrun_guard.hpp"

namespace trammel::lockstep {

// {set, address[9:2], data}
inline std::uint64_t wire(const model::Setting& setting) {
  return std::uint64_t{setting.set} << 40 | std::uint64_t{setting.address >> 2 & 0xFF} << 32 | setting.data;
}

// {valid, target, halfword}; the feed load's targets have 3 bits, the load bus's 5.
inline std::uint32_t load_wire(const model::LoadWord& load) {
  return std::uint32_t{load.valid} << 21 | std::uint32_t{load.target} << 16 | load.word;
}
inline std::uint32_t feed_wire(const model::LoadWord& load) {
  return std::uint32_t{load.valid} << 19 | std::uint32_t{load.target} << 16 | load.word;
}

// {drop, geometry {commit, write}, feed {commit, write}, halfword}
inline std::uint32_t arrive_wire(const model::UnderrunGuard::Arrival& a) {
  return std::uint32_t{a.drop} << 20 | std::uint32_t{a.geometry_commit} << 19 | std::uint32_t{a.geometry_write} << 18 |
         std::uint32_t{a.feed_commit} << 17 | std::uint32_t{a.feed_write} << 16 | a.halfword;
}

inline model::LoadWord halfword(unsigned target, std::uint64_t value, unsigned index) {
  return {true, static_cast<std::uint8_t>(target), static_cast<std::uint16_t>(value >> (16 * index))};
}

// A word of the snapshot chain: takes its value at a strobe, what comes in at a shift. Unknown before either.
class SnapshotWord {
 public:
  void clock(std::uint32_t snapshot, std::uint32_t value, std::uint32_t chain, bool chain_known = true) {
    if (snapshot == 0) return;
    const bool strobe = (snapshot & 1) != 0;
    word_ = strobe ? value : chain;
    known_ = strobe || chain_known;
  }
  // The same behind another slice.
  void clock(std::uint32_t snapshot, std::uint32_t value, const SnapshotWord& before) {
    clock(snapshot, value, before.word_, before.known_);
  }
  bool known() const { return known_; }
  std::uint32_t word() const { return word_; }

 private:
  std::uint32_t word_ = 0;
  bool known_ = false;
};

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  std::uint64_t word() { return random_(); }
  std::uint32_t draw() { return static_cast<std::uint32_t>(random_() >> 32); }
  std::uint32_t below(std::uint32_t n) { return draw() % n; }
  bool chance(std::uint32_t one_in) { return below(one_in) == 0; }
  // Any number of bits up to `bits`, each as often as the others.
  std::uint64_t log_uniform(std::uint32_t bits) { return random_() >> (64 - bits) >> below(bits); }
  // Up to 4 below a power of two, at most 2^bits: a counter of so many bits that stands there soon carries or wraps.
  std::uint64_t before_carry(std::uint32_t bits) {
    const std::uint32_t bit = 3 + below(bits - 2);
    return (bit == 64 ? 0 : std::uint64_t{1} << bit) - 1 - below(4);
  }
  // {shift, strobe} of the snapshot chain, mostly none.
  std::uint8_t snapshot() { return static_cast<std::uint8_t>(chance(8) ? 1 + below(2) : 0); }

 private:
  std::mt19937_64 random_;
};

}  // namespace trammel::lockstep
