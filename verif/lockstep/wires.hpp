// Shared by the locksteps of blocks: buses as the RTL's ports carry them, a slice of the snapshot, random numbers.
#pragma once

#include <cstdint>
#include <random>

#include "rtl_buses.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/underrun_guard.hpp"
#include "trammel/model/wishbone_port.hpp"

namespace trammel::lockstep {

inline std::uint64_t wire(const model::Setting& setting) {
  using namespace bus::setting_bus;
  return in_place(kSet, setting.set) | in_place(kWord, setting.address >> 2) | in_place(kData, setting.data);
}

inline std::uint32_t roles_wire(const model::InputRoles& roles) {
  using namespace bus::input_roles;
  return static_cast<std::uint32_t>(in_place(kLimitMinus, roles.limit_minus) | in_place(kLimitPlus, roles.limit_plus) |
                                    in_place(kDriveFault, roles.drive_fault) | in_place(kFeedHold, roles.feed_hold) |
                                    in_place(kCycleStart, roles.cycle_start) |
                                    in_place(kToolSetter, roles.tool_setter) | in_place(kProbe, roles.probe));
}

// Puts the bundle of the inputs' levels on a block's port.
template <class Port>
void put_inputs(Port& port, std::uint32_t levels, std::uint32_t raw, std::uint32_t quiet) {
  using namespace bus::input_levels;
  put(port, kLevels, levels);
  put(port, kRaw, raw);
  put(port, kQuiet, quiet);
}

inline std::uint8_t causes_wire(const model::StopCauses& causes) {
  using namespace bus::stop_causes;
  return static_cast<std::uint8_t>(in_place(kLimit, causes.limit) | in_place(kBeyond, causes.beyond) |
                                   in_place(kDriveFault, causes.drive_fault) | in_place(kProbe, causes.probe) |
                                   in_place(kToolSetter, causes.tool_setter));
}

// The model's targets are {unit, target}.
inline std::uint32_t load_wire(const model::LoadWord& load) {
  using namespace bus::load_bus;
  constexpr bus::Field kPlace{kTarget.offset, kTarget.bits + kUnit.bits};
  return static_cast<std::uint32_t>(in_place(kValid, load.valid) | in_place(kPlace, load.target) |
                                    in_place(kWord, load.word));
}
inline std::uint32_t feed_wire(const model::LoadWord& load) {
  using namespace bus::feed_load;
  return static_cast<std::uint32_t>(in_place(kValid, load.valid) | in_place(kTarget, load.target) |
                                    in_place(kWord, load.word));
}

inline std::uint64_t wishbone_wire(const model::WishbonePort::Inputs& master) {
  using namespace bus::wishbone_request;
  return in_place(kCyc, master.cyc) | in_place(kStb, master.stb) | in_place(kWe, master.we) |
         in_place(kSel, master.sel) | in_place(kAdr, master.adr) | in_place(kDat, master.dat);
}

inline std::uint32_t arrival_wire(const model::UnderrunGuard::Arrival& a, bool full) {
  using namespace bus::arrival;
  return static_cast<std::uint32_t>(in_place(kFull, full) | in_place(kDrop, a.drop) |
                                    in_place(kGeometryCommit, a.geometry_commit) |
                                    in_place(kGeometryWrite, a.geometry_write) | in_place(kFeedCommit, a.feed_commit) |
                                    in_place(kFeedWrite, a.feed_write) | in_place(kHalfword, a.halfword));
}

inline model::LoadWord halfword(unsigned target, std::uint64_t value, unsigned index) {
  return {true, static_cast<std::uint16_t>(target), static_cast<std::uint16_t>(value >> (16 * index))};
}

// A word of the snapshot chain: takes its value at a strobe, and the incoming word at a shift. Unknown before either.
class SnapshotWord {
 public:
  // `snapshot`: the incoming chain.
  void clock(std::uint64_t snapshot, std::uint32_t value) {
    clock(snapshot, value, static_cast<std::uint32_t>(get(snapshot, bus::snapshot::kWord)), true);
  }
  // The same, behind another slice.
  void clock(std::uint64_t snapshot, std::uint32_t value, const SnapshotWord& before) {
    clock(snapshot, value, before.word_, before.known_);
  }
  bool known() const { return known_; }
  std::uint32_t word() const { return word_; }

 private:
  void clock(std::uint64_t snapshot, std::uint32_t value, std::uint32_t chain, bool chain_known) {
    const bool strobe = get(snapshot, bus::snapshot::kStrobe) != 0;
    if (!strobe && get(snapshot, bus::snapshot::kShift) == 0) return;
    word_ = strobe ? value : chain;
    known_ = strobe || chain_known;
  }

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
  // A number of at most `bits` bits; all lengths are equally likely.
  std::uint64_t log_uniform(std::uint32_t bits) { return random_() >> (64 - bits) >> below(bits); }
  // At most 4 below a power of two that is at most 2^bits: a counter of that width soon carries or wraps.
  std::uint64_t before_carry(std::uint32_t bits) {
    const std::uint32_t bit = 3 + below(bits - 2);
    return (bit == 64 ? 0 : std::uint64_t{1} << bit) - 1 - below(4);
  }
  // A random input of the snapshot chain: any word, mostly with neither shift nor strobe.
  std::uint64_t snapshot() {
    const bool event = chance(8);
    const bool strobe = event && chance(2);
    return in_place(bus::snapshot::kStrobe, strobe) | in_place(bus::snapshot::kShift, event && !strobe) |
           in_place(bus::snapshot::kRest, chance(2)) | in_place(bus::snapshot::kWord, draw());
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace trammel::lockstep
