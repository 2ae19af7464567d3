// The command checker in lockstep with its model: every violation of every layout; then random streams with corrupted
// words, little room, flushes, clears, and writes while it is not ready.
#include "trammel/model/command_checker.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "Vdut.h"
#include "command_source.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace {

using trammel::lockstep::Checker;
using trammel::model::CommandChecker;
using trammel::testing::CommandSource;
using trammel::testing::WireCommand;

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint32_t kEngines = TRAMMEL_ENGINES;
constexpr std::uint64_t kSignals = 12;
constexpr std::uint16_t kMuchRoom = 4096;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("command_checker", seed), model_(kAxes, kEngines) {
    CommandChecker::Inputs in;
    in.reset = true;
    clock(in);
  }

  void clock(const CommandChecker::Inputs& in) {
    rtl_->rst_i = in.reset;
    rtl_->write_i = in.write;
    // A word is stable until it is answered.
    if (model_.outputs().ready) word_ = in.word;
    rtl_->word_i = word_;
    rtl_->flush_i = in.flush;
    rtl_->clear_i = in.clear;
    rtl_->closed_i = in.closed;
    rtl_->geometry_room_i = in.geometry_room;
    rtl_->feed_room_i = in.feed_room;
    if (in.write) checker_.event("write", in.word);
    if (in.flush) checker_.event("flush");
    if (in.clear) checker_.event("clear");
    rtl_.clock();
    model_.clock(in);
    full_ = in.geometry_room < 64 || in.feed_room < 32;
    checker_.next_cycle();
    compare(model_.outputs());
    commits_ += model_.outputs().geometry_commit || model_.outputs().feed_commit ? 1U : 0U;
    refusals_ += model_.outputs().refuse ? 1U : 0U;
  }

  const CommandChecker::Outputs& outputs() const { return model_.outputs(); }
  const Checker& checker() const { return checker_; }
  std::uint64_t commits() const { return commits_; }
  std::uint64_t refusals() const { return refusals_; }

 private:
  void compare(const CommandChecker::Outputs& model) {
    namespace arrival = trammel::bus::arrival;
    namespace answer = trammel::bus::stream_answer;
    const auto stored = [this](const trammel::bus::Field& field) { return get(rtl_->arrival_o, field); };
    const auto answered = [this](const trammel::bus::Field& field) { return get(rtl_->answer_o, field); };
    checker_.compare("ready", answered(answer::kReady), model.ready);
    checker_.compare("halfword", stored(arrival::kHalfword), model.halfword);
    checker_.compare("geometry, write", stored(arrival::kGeometryWrite), model.geometry_write);
    checker_.compare("feed, write", stored(arrival::kFeedWrite), model.feed_write);
    checker_.compare("geometry, commit", stored(arrival::kGeometryCommit), model.geometry_commit);
    checker_.compare("feed, commit", stored(arrival::kFeedCommit), model.feed_commit);
    checker_.compare("drop", stored(arrival::kDrop), model.drop);
    checker_.compare("full", stored(arrival::kFull), full_);
    checker_.compare("refuse", answered(answer::kRefuse), model.refuse);
    checker_.compare("reason", answered(answer::kReason), model.reason);
    checker_.compare("number", answered(answer::kNumber), model.number);
    checker_.compare("partial", answered(answer::kPartial), model.partial);
  }

  Checker checker_;
  trammel::lockstep::Simulated<Vdut> rtl_;
  CommandChecker model_;
  std::uint32_t word_ = 0;
  bool full_ = false;  // there may be no room for the largest command: 50 halfwords of geometry, 20 of feed
  std::uint64_t commits_ = 0;
  std::uint64_t refusals_ = 0;
};

void send(Bench& bench, const std::vector<std::uint32_t>& words, std::uint16_t geometry_room, std::uint16_t feed_room) {
  CommandChecker::Inputs in;
  in.geometry_room = geometry_room;
  in.feed_room = feed_room;
  for (const std::uint32_t word : words) {
    in.write = true;
    in.word = word;
    bench.clock(in);
    in.write = false;
    while (!bench.outputs().ready) bench.clock(in);
  }
}

void clear(Bench& bench) {
  CommandChecker::Inputs in;
  in.clear = true;
  bench.clock(in);
}

void directed(Bench& bench, CommandSource& source) {
  for (const auto& layout : trammel::card_map::kCommands) {
    if (!CommandSource::possible(layout, kAxes, kEngines)) continue;
    const WireCommand good = source.make(layout, 0);
    const auto needed = static_cast<std::uint16_t>(good.stored().size());
    for (int lack = 0; lack < 4; ++lack) {
      clear(bench);
      send(bench, good.words(), static_cast<std::uint16_t>(needed - (lack & 1)),
           static_cast<std::uint16_t>(needed - (lack >> 1)));
    }
    for (const auto& violation : trammel::testing::violations(good, kAxes, kEngines)) {
      clear(bench);
      send(bench, violation.command.words(violation.padding), kMuchRoom, kMuchRoom);
    }
  }
}

// Drives the checker as no register file would: writes and flushes at any time, clears during words.
void random_stream(Bench& bench, CommandSource& source, std::uint64_t commands) {
  auto& random = source.random();
  std::uint8_t number = 0;
  unsigned closed_for = 0;  // clocks
  for (std::uint64_t i = 0; i < commands; ++i) {
    const bool corrupt = random() % 8 == 0;
    const bool patient = random() % 8 != 0;
    std::vector<std::uint32_t> words = source.any(number).words();
    if (corrupt) words[random() % words.size()] ^= 1U << random() % 32;
    bool open = true;
    for (std::size_t w = 0; w < words.size();) {
      CommandChecker::Inputs in;
      in.write = patient ? bench.outputs().ready && random() % 4 != 0 : random() % 2 == 0;
      in.word = words[w];
      in.flush = random() % 400 == 0;
      in.clear = random() % 700 == 0;
      in.reset = random() % 5000 == 0;
      in.closed = closed_for != 0 || random() % 600 == 0;
      if (in.closed) closed_for = closed_for != 0 ? closed_for - 1 : static_cast<unsigned>(random() % 30);
      in.geometry_room = static_cast<std::uint16_t>(random() % 20 == 0 ? random() % 52 : random() % 8192);
      in.feed_room = static_cast<std::uint16_t>(random() % 20 == 0 ? random() % 52 : random() % 8192);
      if (in.write && bench.outputs().ready) ++w;
      bench.clock(in);
      open = open && !bench.outputs().refuse && !in.clear && !in.reset;
    }
    while (!bench.outputs().ready) bench.clock({});
    open = open && !bench.outputs().refuse;
    number = static_cast<std::uint8_t>(open ? number + 1 : 0);
    if (!open && random() % 4 != 0) clear(bench);
  }
}

TEST(CommandCheckerLockstep, EqualsModelInEveryCycle) {
  const std::string complaint = trammel::lockstep::judge([] {
    const std::uint64_t seed = trammel::lockstep::seed_from_environment(20260102);
    Bench bench(seed);
    CommandSource source(kAxes, seed, kEngines);
    directed(bench, source);
    random_stream(bench, source, trammel::lockstep::scaled(20000));
    ASSERT_EQ(bench.checker().comparisons(), kSignals * bench.checker().cycles());
    ASSERT_GT(bench.commits(), 1000U);
    ASSERT_GT(bench.refusals(), 1000U);
  });
  EXPECT_EQ(complaint, "");
}

}  // namespace
