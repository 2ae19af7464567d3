// A bus without a card. A test sets the values of the registers; all accesses are logged; faults are injected on
// demand. It is for behaviour that no working card shows. The model engine (trammel/sim/engine.hpp) is for the
// behaviour of a card.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::test {

// An access that was made: {true, address, data} for a write, {false, address, 0} for a read.
using Made = std::tuple<bool, std::uint32_t, std::uint32_t>;
inline Made wrote(std::uint32_t address, std::uint32_t data) { return {true, address, data}; }
inline Made was_read(std::uint32_t address) { return {false, address, 0}; }

class RegisterStub : public driver::Bus {
 public:
  // An idle card of `axes` axes with lines, accumulator, jerk and direct mode.
  explicit RegisterStub(unsigned axes = 4, std::uint32_t clock_hz = 1'000'000) {
    namespace reg = card_map::reg;
    values[reg::kMagic] = card_map::kMagicValue;
    values[reg::kMapVersion] = card_map::kMapVersionValue;
    values[reg::kCommandsVersion] = card_map::kCommandsVersionValue;
    values[reg::kAxes] = axes;
    values[reg::kClockHz] = clock_hz;
    set_engines(card_map::engines::kLines | card_map::engines::kAccumulator | card_map::engines::kJerk |
                card_map::engines::kDirectMode);
    values[reg::kGeometryDepth] = 4096;
    values[reg::kFeedDepth] = 2560;
    values[reg::kRatioFeed] = 0x10000;
    values[reg::kSlew] = 0xFFFFFFF;
  }

  // Sets the unit descriptors of a card that is built with these engines and with the number of axes in AXES.
  void set_engines(std::uint32_t engines) {
    engines_ = engines;
    const card_map::CardShape shape{engines, values[card_map::reg::kAxes], 1, 4, 4, 4};
    card_map::put_descriptors(shape, [&](std::uint32_t address, std::uint32_t word) { values[address] = word; });
  }
  void add_engines(std::uint32_t engines) { set_engines(engines_ | engines); }

  // Values of the registers; 0 if not set. A write changes a setting, and clears bits of a register for which the map
  // says so (ClearOnes). Other writes (orders) are only logged.
  std::map<std::uint32_t, std::uint32_t> values;
  // Results of the next reads of a register; further reads return its entry in `values`.
  std::map<std::uint32_t, std::deque<std::uint32_t>> next;
  // Called before each access. False: the card refuses the access. May set `values` to change the result of a read; may
  // throw.
  std::function<bool(const driver::Access&)> on_access;
  bool posted = false;  // refusals are not reported

  std::vector<Made> log;
  std::vector<std::size_t> transfers;  // number of accesses of each transfer
  std::vector<std::chrono::nanoseconds> sleeps;
  std::chrono::nanoseconds slept{0};

  void forget() {
    log.clear();
    transfers.clear();
    sleeps.clear();
    slept = std::chrono::nanoseconds(0);
  }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    transfers.push_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      const bool taken = !on_access || on_access(accesses[i]);
      if (!taken && !posted) return i;
      if (taken) make(accesses[i]);
    }
    return count;
  }
  void sleep(std::chrono::nanoseconds time) override {
    sleeps.push_back(time);
    slept += time;
  }
  bool reports_refusals() const override { return !posted; }

 private:
  std::uint32_t engines_ = 0;

  void make(driver::Access& access) {
    log.push_back(access.write ? wrote(access.address, access.data) : was_read(access.address));
    if (!access.write) {
      std::deque<std::uint32_t>& waiting = next[access.address];
      access.data = values[access.address];
      if (waiting.empty()) return;
      access.data = waiting.front();
      waiting.pop_front();
      return;
    }
    const card_map::Register& entry = *card_map::find_register(access.address).entry;
    if (entry.access == card_map::Access::ClearOnes) {
      values[access.address] &= ~access.data;
    } else if (entry.access == card_map::Access::Setting) {
      values[access.address] = access.data;
    }
  }
};

}  // namespace trammel::test
