// A host at the inner register port of the golden core; its stream commands come from the layout table alone.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "one_pulse.hpp"
#include "trammel/card_map.hpp"
#include "trammel/model/core_model.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing {

// Seed of random tests.
inline std::uint64_t seed() {
  const char* given = std::getenv("TRAMMEL_SEED");
  return given != nullptr ? std::stoull(given) : 1;
}

__extension__ typedef __int128 int128;

// A command as it is sent. Fields are given by name; missing ones are 0. `increments` are those of the mask's axes.
using Field = std::pair<std::string_view, int128>;

inline void put_halfwords(std::vector<std::uint16_t>& to, std::size_t at, std::size_t count, int128 value) {
  for (std::size_t i = 0; i < count; ++i) to[at + i] = static_cast<std::uint16_t>(value >> (16 * i));
}

inline std::vector<std::uint32_t> command_words(card_map::Opcode opcode, std::uint8_t mask, std::uint8_t number,
                                                std::uint64_t count, const std::vector<Field>& fields,
                                                const std::vector<std::int64_t>& increments = {}) {
  constexpr std::size_t kPayload = 5;
  const card_map::Command& layout = *card_map::find_command(static_cast<std::uint8_t>(opcode));
  std::vector<std::uint16_t> halfwords(card_map::halfwords(layout, mask) + 1, 0);
  halfwords[0] = static_cast<std::uint16_t>(static_cast<unsigned>(opcode) | unsigned{mask} << 8);
  halfwords[1] = static_cast<std::uint16_t>(card_map::words(layout, mask) | unsigned{number} << 8);
  put_halfwords(halfwords, 2, 3, static_cast<int128>(count));
  for (std::size_t i = 0; i < layout.field_count; ++i) {
    const card_map::Field& field = layout.fields[i];
    for (const Field& given : fields) {
      if (given.first == field.name) put_halfwords(halfwords, kPayload + field.offset, field.halfwords, given.second);
    }
    if (field.name != "increment") continue;
    for (std::size_t n = 0; n < increments.size(); ++n)
      put_halfwords(halfwords, kPayload + field.offset + 3 * n, 3, increments[n]);
  }
  std::vector<std::uint32_t> words;
  for (std::size_t i = 0; i < card_map::words(layout, mask); ++i)
    words.push_back(halfwords[2 * i] | std::uint32_t{halfwords[2 * i + 1]} << 16);
  return words;
}

class StepRecorder : public model::CardSteps {
 public:
  using Pin = std::tuple<std::uint64_t, unsigned, int>;
  using Path = std::tuple<std::uint64_t, std::uint64_t, unsigned, int, std::uint64_t>;
  void pin_step(std::uint64_t cycle, unsigned axis, int direction) override {
    pins.emplace_back(cycle, axis, direction);
  }
  void path_step(std::uint64_t cycle, std::uint64_t command, std::uint64_t tick, unsigned axis,
                 int direction) override {
    path.emplace_back(command, tick, axis, direction, cycle);
  }
  std::vector<Pin> pins;
  std::vector<Path> path;
};

class CoreBench {
 public:
  // All visible state after a clock.
  struct Shown {
    model::CoreModel::Outputs outputs;
    model::CoreModel::Answer answer;
    std::array<std::uint32_t, card_map::kMaxAxes> position;

    bool operator==(const Shown& o) const {
      return outputs == o.outputs && answer.ack == o.answer.ack && answer.error == o.answer.error &&
             answer.data == o.answer.data && position == o.position;
    }
  };

  explicit CoreBench(const model::CardConfig& config = {}) : core(config) { core.set_steps(&steps); }

  // Every clock goes through this function.
  void clock(model::CoreModel::Inputs in) {
    if (before_clock) before_clock();
    in.pins = pins;
    in.emergency_stop = emergency_stop;
    if (skips)
      skip::clock(core, in);
    else
      core.clock(in);
    if (after_clock) after_clock();
    taken += core.outputs().tick ? 1U : 0U;
    if (!logs) return;
    Shown shown{core.outputs(), core.answer(), {}};
    for (unsigned n = 0; n < core.config().axes; ++n) shown.position[n] = core.position(n);
    log.push_back(shown);
  }
  void idle(std::uint64_t clocks) {
    for (; clocks != 0; --clocks) clock({});
  }
  // True when the card accepted the write.
  bool write(std::uint32_t address, std::uint32_t data) { return access(address, true, data); }
  std::uint32_t read(std::uint32_t address) {
    access(address, false, 0);
    return core.answer().data;
  }
  bool access(std::uint32_t address, bool write, std::uint32_t data) {
    model::CoreModel::Inputs in;
    in.request = true;
    in.write = write;
    in.address = address;
    in.data = data;
    clock(in);
    for (int clocks = 0; !core.answer().ack && clocks < 2000; ++clocks) clock({});
    return core.answer().ack && !core.answer().error;
  }
  bool send(const std::vector<std::uint32_t>& words) {
    bool good = true;
    for (const std::uint32_t word : words) good = write(card_map::reg::kStream, word) && good;
    return good;
  }
  bool line(std::uint64_t ticks, const std::vector<std::int64_t>& increments) {
    const auto mask = static_cast<std::uint8_t>((1U << increments.size()) - 1);
    return send(command_words(card_map::Opcode::Line, mask, number++, ticks, {}, increments));
  }
  bool feed(std::uint64_t ticks, std::uint64_t rate, std::int64_t acceleration = 0, std::int64_t jerk = 0,
            std::uint32_t floor = 1, std::uint8_t piece_class = card_map::constant::kClassFeed) {
    return send(command_words(card_map::Opcode::Feed, piece_class, number++, ticks,
                              {{"rate", rate}, {"acceleration", acceleration}, {"jerk", jerk}, {"floor", floor}}));
  }
  // A whole circle of radius r from its rightmost point, in `ticks` feed ticks. It takes 8 r path ticks, or
  // steps_in_eight(r).
  static std::vector<std::uint32_t> circle_words(std::uint8_t number, std::uint64_t ticks, std::int64_t r,
                                                 bool clockwise, bool eight = false) {
    const std::int64_t made = eight ? steps_in_eight(r) : 8 * r;
    const auto n = static_cast<int128>(ticks);
    const int128 prescale = (int128{made} * kOnePulse + n / 2) / n;
    return command_words(card_map::Opcode::Arc, 3, number, ticks,
                         {{"path_ticks", made},
                          {"prescale", prescale},
                          {"plane", 1 << 8 | (eight ? 2 : 0) | (clockwise ? 1 : 0)},
                          {"quadrants", 4},
                          {"gradient_x", 2 * r},
                          {"half_x", 1},
                          {"half_y", 1}});
  }
  bool circle(std::uint64_t ticks, std::int64_t r, bool clockwise = false, bool eight = false) {
    return send(circle_words(number++, ticks, r, clockwise, eight));
  }
  // Steps of a circle of radius r in 8 directions.
  static std::int64_t steps_in_eight(std::int64_t r) {
    return r == 1 ? 6 : 4 * std::llround(std::sqrt(2.0) * static_cast<double>(r));
  }
  bool dwell(std::uint64_t clocks) { return send(command_words(card_map::Opcode::Dwell, 0, number++, clocks, {})); }
  bool output(std::uint16_t set, std::uint16_t clear) {
    return send(command_words(card_map::Opcode::Output, 0, number++, 0, {{"set", set}, {"clear", clear}}));
  }
  bool mark() { return send(command_words(card_map::Opcode::Mark, 0, number++, 0, {})); }
  // `condition`: bit 5 is the level, bits 4:0 are the input.
  bool probe(unsigned condition) {
    return send(command_words(card_map::Opcode::Probe, 0, number++, 0, {{"condition", condition}}));
  }
  bool probe_end() { return send(command_words(card_map::Opcode::ProbeEnd, 0, number++, 0, {})); }
  bool wait_input(unsigned condition, std::uint64_t clocks) {
    return send(command_words(card_map::Opcode::WaitInput, 0, number++, clocks, {{"condition", condition}}));
  }
  bool end() { return send(command_words(card_map::Opcode::End, 0, number++, 0, {})); }
  // Clocks until the core is not busy; false when it is still busy after `limit` clocks.
  bool finish(std::uint64_t limit) {
    idle(8);
    for (; limit != 0 && (core.outputs().status & 1) != 0; --limit) clock({});
    return (core.outputs().status & 1) == 0;
  }

  model::CoreModel core;
  StepRecorder steps;
  std::uint8_t number = 0;
  std::uint64_t taken = 0;  // feed ticks so far
  std::uint32_t pins = 0;   // levels of the card's inputs
  std::function<void()> before_clock;
  std::function<void()> after_clock;
  bool emergency_stop = false;  // level of its pin
  bool logs = false;
  bool skips = true;  // leaves out the clocks that change nothing in a block
  std::vector<Shown> log;
};

}  // namespace trammel::testing
