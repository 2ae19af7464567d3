// A host for card tests: sends commands over the bus, waits, aborts.
#pragma once

#include <cstdint>
#include <vector>

#include "commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::test {

namespace reg = card_map::reg;
namespace field = card_map::field;

class Host {
 public:
  explicit Host(sim::Engine& engine) : card(engine) {}

  void send(const driver::Command& command) {
    std::vector<std::uint32_t> words;
    driver::encode(command, number_++, words);
    for (const std::uint32_t word : words) card.write(reg::kStream, word);
  }
  void abort() {
    card.write(reg::kControl, field::kControlAbort);
    number_ = 0;
  }
  std::uint32_t status() { return card.read(reg::kStatus); }
  // False if the card is still busy after `clocks`, or has a fault.
  bool wait_idle(std::uint64_t clocks) {
    const std::uint64_t begin = card.cycles();
    while ((status() & field::kStatusBusy) != 0) {
      if ((status() & field::kStatusFaulted) != 0 || card.cycles() - begin > clocks) return false;
      card.wait(50);
    }
    return true;
  }
  // The same step times for every axis, clocks.
  void set_times(unsigned axes, std::uint32_t length, std::uint32_t space, std::uint32_t setup, std::uint32_t hold) {
    for (unsigned n = 0; n < axes; ++n) {
      card.write(reg::step_length(n), length);
      card.write(reg::step_space(n), space);
      card.write(reg::dir_setup(n), setup);
      card.write(reg::dir_hold(n), hold);
    }
  }

  sim::Engine& card;

 private:
  std::uint8_t number_ = 0;
};

// A few random paths, their pieces and an END, executed to the end. Some cause faults, after which words are refused;
// the faults are cleared. `random(n)`: 0 .. n - 1.
template <class Random>
void random_section(Host& host, Random&& random, unsigned axes) {
  const double pace = 1.5 + static_cast<double>(random(40));
  std::uint64_t total = 0;
  std::vector<driver::Command> commands;
  for (std::uint64_t count = 1 + random(6); count != 0; --count) {
    commands.push_back(random_path(random, axes, pace, total));
  }
  while (total != 0) {
    const std::uint64_t ticks = 1 + random(total);
    commands.push_back(random_piece(random, ticks, pace));
    total -= ticks;
  }
  commands.push_back(driver::EndCommand{});
  bool taken = true;
  try {
    for (const driver::Command& command : commands) host.send(command);
  } catch (const driver::RefusedError&) {
    taken = false;
  }
  if (taken && host.wait_idle(1'000'000)) return;
  host.card.write(reg::kFault, 0xFFFF);
  host.abort();
}

}  // namespace trammel::test
