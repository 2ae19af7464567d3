// Effects of a flipped bit in the memory of a queue: each bit of a waiting program is flipped, one at a time. The card
// has no parity. The test shows which flips the card notices itself, which flips the host sees from the end position,
// and lists by field those that nobody sees (docs/developer/evidence.md has the table).
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "core_bench.hpp"
#include "trammel/skip/card.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

enum class Seen { ByTheCard, ByTheEnd, PathDiffers, TimeDiffers, Harmless };
constexpr std::array kSeen = {Seen::ByTheCard, Seen::ByTheEnd, Seen::PathDiffers, Seen::TimeDiffers, Seen::Harmless};

// Fields in which a flip can change the path while neither the card nor the host notices.
const std::set<std::string> kSilent{"ARC deviation", "ARC gradient_x",    "ARC half_x",     "ARC half_y", "ARC plane",
                                    "ARC quadrants", "FEED opcode, mask", "LINE increment", "OUTPUT set"};

constexpr unsigned kFlipAxes = 2;
constexpr std::uint64_t kFlipLimit = 15'000;  // clocks; the program takes about 5,000

model::CardConfig flip_config() {
  model::CardConfig config;
  config.axes = kFlipAxes;
  config.engines |= card_map::engines::kArcGenerator;
  return config;
}

// Observed results of a run.
struct Shown {
  std::vector<std::tuple<std::uint64_t, std::uint64_t, unsigned, int>> path;  // command, tick, axis, direction
  std::vector<StepRecorder::Pin> pins;
  std::array<std::uint32_t, kFlipAxes> end{};
  std::array<std::uint32_t, kFlipAxes> counted{};
  std::uint32_t output = 0;
  std::uint32_t fault = 0;
  bool rested = false;
};

// The program is complete in the queues while the card is held; each run uses a copy of this card.
class Flips {
 public:
  struct Place {
    bool geometry;
    std::size_t at;  // halfword of the queue's memory
    std::string name;
  };

  Flips() : bench_(flip_config()) {
    bench_.idle(300);
    bench_.write(reg::kHold, 1);
    bench_.idle(100);
    for (int n = 0; n < 4; ++n) fetched();
    line(400, {kOnePulse / 10, -kOnePulse / 20});
    piece(400);
    arc();
    piece(1200);
    output();
    line(300, {-kOnePulse / 10, kOnePulse / 30});
    piece(300);
    bench_.idle(200);
  }

  const std::vector<Place>& places() const { return places_; }

  Shown run(const Place* flipped, unsigned bit) const {
    model::CoreModel core = bench_.core;
    StepRecorder steps;
    core.set_steps(&steps);
    if (flipped != nullptr) {
      auto& queue = flipped->geometry ? core.state().geometry_queue : core.state().feed_queue;
      queue.state().memory[flipped->at] ^= static_cast<std::uint16_t>(1U << bit);
    }
    write(core, reg::kHold, 0);
    Shown shown;
    for (std::uint64_t clocks = 0; clocks < kFlipLimit && !shown.rested; clocks += 1000) {
      skip::run(core, 1000);
      shown.rested = (core.outputs().status & field::kStatusBusy) == 0;
    }
    for (const auto& [command, tick, axis, direction, cycle] : steps.path)
      shown.path.emplace_back(command, tick, axis, direction);
    for (const auto& [cycle, axis, direction] : steps.pins)
      shown.counted[axis] += static_cast<std::uint32_t>(direction);
    for (unsigned n = 0; n < kFlipAxes; ++n) shown.end[n] = core.position(n);
    shown.pins = std::move(steps.pins);
    shown.output = core.outputs().output;
    shown.fault = core.outputs().fault;
    return shown;
  }

 private:
  static void write(model::CoreModel& core, std::uint32_t address, std::uint32_t data) {
    model::CoreModel::Inputs in;
    in.request = in.write = true;
    in.address = address;
    in.data = data;
    skip::clock(core, in);
    for (int clocks = 0; !core.answer().ack && clocks < 2000; ++clocks) skip::clock(core, {});
  }

  // Names the halfwords that the command occupies in its queue.
  void named(bool geometry, const char* command, const std::vector<std::string>& names) {
    const auto& queue = geometry ? bench_.core.state().geometry_queue.state() : bench_.core.state().feed_queue.state();
    std::size_t& at = geometry ? geometry_at_ : feed_at_;
    bench_.idle(50);
    const std::size_t end = (queue.read + queue.committed) % queue.memory.size();
    for (std::size_t n = 0; at != end; ++n, ++at)
      places_.push_back({geometry, at, std::string(command) + " " + (n < names.size() ? names[n] : names.back())});
  }
  // Names of the halfwords of a command in a queue: all but the second one, which the checker consumes.
  static std::vector<std::string> names_of(card_map::Opcode opcode, std::uint8_t mask) {
    const card_map::Command& layout = *card_map::find_command(static_cast<std::uint8_t>(opcode));
    std::vector<std::string> names{"opcode, mask", "words, number", "count", "count", "count"};
    names.resize(card_map::halfwords(layout, mask), "increment");
    for (std::size_t i = 0; i < layout.field_count; ++i)
      for (std::size_t n = 0; n < layout.fields[i].halfwords; ++n)
        if (5 + layout.fields[i].offset + n < names.size())
          names[5 + layout.fields[i].offset + n] = std::string(layout.fields[i].name);
    names.erase(names.begin() + 1);
    return names;
  }
  void line(std::uint64_t ticks, const std::vector<std::int64_t>& increments) {
    ASSERT_TRUE(bench_.line(ticks, increments));
    named(true, "LINE", names_of(card_map::Opcode::Line, 3));
  }
  void piece(std::uint64_t ticks) {
    ASSERT_TRUE(bench_.feed(ticks, std::uint64_t{1} << 63));  // a tick in two clocks
    named(false, "FEED", names_of(card_map::Opcode::Feed, 0));
  }
  // A path that leaves the queue before the program is complete, because the card fetches ahead.
  void fetched() {
    ASSERT_TRUE(bench_.line(50, {kOnePulse / 10, 0}));
    ASSERT_TRUE(bench_.feed(50, std::uint64_t{1} << 63));
    bench_.idle(50);
    geometry_at_ =
        bench_.core.state().geometry_queue.state().read + bench_.core.state().geometry_queue.state().committed;
    feed_at_ = bench_.core.state().feed_queue.state().read + bench_.core.state().feed_queue.state().committed;
  }
  void output() {
    ASSERT_TRUE(bench_.output(5, 2));
    named(true, "OUTPUT", names_of(card_map::Opcode::Output, 0));
  }
  void arc() {
    ASSERT_TRUE(bench_.circle(1200, 12));
    named(true, "ARC", names_of(card_map::Opcode::Arc, 3));
  }

  CoreBench bench_;
  std::vector<Place> places_;
  std::size_t geometry_at_ = 0;
  std::size_t feed_at_ = 0;
};

Seen judge(const Shown& flipped, const Shown& sound) {
  if (flipped.fault != 0 || !flipped.rested) return Seen::ByTheCard;
  if (flipped.end != sound.end) return Seen::ByTheEnd;
  if (flipped.path != sound.path || flipped.output != sound.output) return Seen::PathDiffers;
  return flipped.pins == sound.pins ? Seen::Harmless : Seen::TimeDiffers;
}

void print(const std::map<std::string, std::map<Seen, unsigned>>& table) {
  std::printf("%-24s %8s %8s %8s %8s %8s\n", "field", "card", "end", "path", "time", "harmless");
  std::map<Seen, unsigned> all;
  for (const auto& [name, seen] : table) {
    std::printf("%-24s", name.c_str());
    for (const Seen which : kSeen) {
      const unsigned count = seen.count(which) != 0 ? seen.at(which) : 0;
      all[which] += count;
      std::printf(" %8u", count);
    }
    std::printf("\n");
  }
  std::printf("%-24s", "all");
  for (const Seen which : kSeen) std::printf(" %8u", all[which]);
  std::printf("\n");
}

TEST(BitFlips, InTheQueuesAreNoticedHarmlessOrListed) {
  const Flips flips;
  const Shown sound = flips.run(nullptr, 0);
  ASSERT_TRUE(sound.rested && sound.fault == 0 && sound.path.size() > 150);
  std::map<std::string, std::map<Seen, unsigned>> table;
  for (const Flips::Place& place : flips.places()) {
    for (unsigned bit = 0; bit < 16; ++bit) {
      const Shown flipped = flips.run(&place, bit);
      ++table[place.name][judge(flipped, sound)];
      EXPECT_EQ(flipped.end, flipped.counted)
          << place.name << " bit " << bit << ": the position is the pulses all the same";
    }
  }
  print(table);
  std::set<std::string> silent;
  for (const auto& [name, seen] : table) {
    if (seen.count(Seen::PathDiffers) != 0) silent.insert(name);
  }
  EXPECT_EQ(silent, kSilent) << "fields in which a flip changes the path, and neither the card nor its end shows it";
}

}  // namespace
}  // namespace trammel::testing
