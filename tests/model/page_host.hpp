// A host that uses only the bus of the golden model of the whole card, for the tests of the reference pages; and the
// simplest commands.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "one_pulse.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/model/card_model.hpp"

namespace trammel::testing {

// A step of the path or a step at the pins; for a step at the pins `tick` is the clock.
struct PathStep {
  std::uint64_t tick;
  unsigned axis;
  int direction;
};

class PageHost : public model::CardSteps {
 public:
  explicit PageHost(unsigned axes = 4, std::uint32_t engines = model::RegisterFile::kDefaultEngines)
      : card(config_of(axes, engines)) {
    card.set_steps(this);
  }

  static model::CardModel::Config config_of(unsigned axes, std::uint32_t engines) {
    model::CardModel::Config config;
    config.axes = axes;
    config.engines = engines;
    return config;
  }

  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override {
    pins.push_back({cycle, axis, direction});
  }
  void path_step(std::uint64_t, std::uint64_t, std::uint64_t tick, unsigned axis, int direction) override {
    path.push_back({tick, axis, direction});
  }

  bool write(std::uint32_t address, std::uint32_t value, std::uint8_t strobes = 0xF) {
    model::CardModel::Inputs in;
    in.awvalid = in.wvalid = true;
    in.awaddr = address;
    in.wdata = value;
    in.wstrb = strobes;
    while (!card.bus().awready) card.clock(in);
    card.clock(in);
    in = model::CardModel::Inputs{};
    in.bready = true;
    while (!card.bus().bvalid) card.clock(in);
    const bool good = card.bus().bresp == 0;
    card.clock(in);
    return good;
  }
  std::uint32_t read(std::uint32_t address) {
    model::CardModel::Inputs in;
    in.arvalid = true;
    in.araddr = address;
    while (!card.bus().arready) card.clock(in);
    card.clock(in);
    in = model::CardModel::Inputs{};
    in.rready = true;
    while (!card.bus().rvalid) card.clock(in);
    const std::uint32_t value = card.bus().rdata;
    card.clock(in);
    return value;
  }
  bool send(const driver::Command& command) { return send_as(command, number++); }
  bool send_as(const driver::Command& command, std::uint8_t as) {
    std::vector<std::uint32_t> words;
    driver::encode(command, as, words);
    bool good = true;
    for (const std::uint32_t word : words) good = write(card_map::reg::kStream, word) && good;
    return good;
  }
  std::uint32_t refusal() {
    const std::uint32_t value = read(card_map::reg::kRefusal);
    write(card_map::reg::kRefusal, 1);
    return value;
  }
  card_map::Reason reason() { return static_cast<card_map::Reason>(refusal() & card_map::field::kRefusalReason); }
  void clocks(std::uint64_t count) {
    for (; count != 0; --count) card.clock({});
  }
  void idle(std::uint64_t most = 100000) {
    clocks(20);
    while ((read(card_map::reg::kStatus) & card_map::field::kStatusBusy) != 0 && most-- > 0) clocks(8);
    EXPECT_EQ(read(card_map::reg::kStatus) & card_map::field::kStatusBusy, 0U);
  }
  std::int32_t position(unsigned axis) { return static_cast<std::int32_t>(card.position(axis)); }

  // Registers of a one-shot move of axis 0, and of axis 1 in the opposite direction.
  void direct(std::uint64_t frequency, std::uint32_t count, std::uint64_t length) {
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
      write(card_map::reg::frequency_lo(axis), static_cast<std::uint32_t>(frequency));
      write(card_map::reg::frequency_hi(axis), static_cast<std::uint32_t>(frequency >> 32));
      write(card_map::reg::count(axis), count);
      write(card_map::reg::direction(axis), axis);
    }
    write(card_map::reg::kLengthLo, static_cast<std::uint32_t>(length));
    write(card_map::reg::kLengthHi, static_cast<std::uint32_t>(length >> 32));
  }

  model::CardModel card;
  std::vector<PathStep> pins;
  std::vector<PathStep> path;
  std::uint8_t number = 0;
};

inline driver::LineCommand line(std::uint64_t ticks, std::int64_t increment) {
  driver::LineCommand result;
  result.ticks = ticks;
  result.mask = 1;
  result.increment[0] = increment;
  return result;
}

inline driver::FeedCommand feed(std::uint64_t ticks, unsigned clocks_a_tick = 1) {
  driver::FeedCommand result;
  result.ticks = ticks;
  result.rate = clocks_a_tick == 1 ? ~std::uint64_t{0} : (std::uint64_t{1} << 63) / clocks_a_tick * 2;
  return result;
}

}  // namespace trammel::testing
