// hostmot2's registers in front of the model card, in simulated time, with the test's own driver.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "random.hpp"
#include "steps.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/hm2/board.hpp"
#include "trammel/hm2/hostmot2.hpp"
#include "trammel/hm2/register_map.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::hm2 {

namespace map_at = trammel::hm2::map;

inline constexpr std::uint32_t kClock = 10'000'000;
inline constexpr double kPulseFraction = 65536;
inline constexpr std::uint32_t kPet = 0x5A000000;

inline std::unique_ptr<sim::Engine> bench_engine(unsigned axes) {
  sim::ModelOptions options;
  options.axes = axes;
  options.clock_hz = kClock;
  return sim::make_model_engine(options);
}

struct Bench {
  explicit Bench(unsigned axes = 4)
      : engine(bench_engine(axes)),
        card(driver::Card::open(*engine)),
        time(*engine),
        hostmot2(card, time, [this](const std::string& text) { notes.push_back(text); }),
        board(hostmot2, {2, 0x52, 0x41, 0x54, 0, 1}, kClock) {
    engine->set_sink(&steps);
  }

  Bytes send(const Bytes& datagram) { return board.answer(datagram.data(), datagram.size()); }
  std::uint32_t read(std::uint16_t address) {
    Bytes datagram;
    append_read(datagram, Space::kHostmot2, 4, address, 1);
    const Bytes answer = send(datagram);
    return answer.size() == 4 ? word_of(answer.data()) : 0xDEAD;
  }
  void write(std::uint16_t address, const std::vector<std::uint32_t>& words) {
    Bytes datagram;
    append_write(datagram, address, words);
    send(datagram);
  }
  void set_rate(unsigned axis, std::int64_t rate) {
    write(static_cast<std::uint16_t>(map_at::kStepRate + 4 * axis), {static_cast<std::uint32_t>(rate)});
  }
  // Runs the card for some time, as a server does between two datagrams.
  void run(double seconds) { hostmot2.run_to(engine->cycles() + static_cast<std::uint64_t>(seconds * kClock)); }
  void pet() { write(map_at::kWatchdogReset, {kPet}); }

  // Number of pulses at the pins.
  std::int64_t pins(unsigned axis) const { return steps.position(axis); }
  std::int64_t counter(unsigned axis) { return card.read_snapshot().position[axis]; }
  // The step generator's accumulator, in pulses.
  double place(unsigned axis) {
    return static_cast<std::int32_t>(read(static_cast<std::uint16_t>(map_at::kAccumulator + 4 * axis))) /
           kPulseFraction;
  }

  std::vector<std::string> notes;
  std::unique_ptr<sim::Engine> engine;
  driver::Card card;
  EngineTime time;
  Hostmot2 hostmot2;
  Board board;
  test::Steps steps;
};

// A rate in pulses per second, in the unit of hostmot2's register.
inline std::int64_t rate_of(double pulses_per_second) {
  return static_cast<std::int64_t>(pulses_per_second * (4294967296.0 / kClock));
}

}  // namespace trammel::hm2
