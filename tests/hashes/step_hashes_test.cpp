// The hashes of small known step lists: what changes them, and which changes cancel.
#include "step_hashes.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace trammel::test {
namespace {

// Two lines, a dwell, and a third line. Each path step has its step at the pin some clocks later.
struct Steps {
  struct Both {
    driver::PathStep path;
    std::uint64_t cycle;  // cycle at the pin
  };
  std::vector<Both> steps = {
      {{1, 10, 0, 1}, 1010}, {{1, 10, 1, -1}, 1010}, {{1, 30, 0, 1}, 1030},
      {{3, 5, 0, -1}, 1105}, {{3, 6, 1, 1}, 1106},  // two axes, one clock apart
      {{6, 7, 0, 1}, 5007},  {{6, 9, 0, 1}, 5009},
  };
  std::uint64_t first_write = 900;
  StepHasher::Path path = StepHasher::Path::kNoArc;  // of the second line
};

void send(StepHasher& hasher, const std::vector<driver::Command>& commands, std::uint64_t cycle,
          StepHasher::Path path = StepHasher::Path::kNoArc) {
  hasher.block(path);
  for (const driver::Command& command : commands) hasher.command(command);
  hasher.sent(cycle);
}

const std::vector<driver::Command> kMove = {driver::FeedCommand{}, driver::LineCommand{}};

StepHashes hashes_of(const Steps& list, Shift shift = {0, 0}) {
  StepHasher hasher(shift);
  send(hasher, kMove, list.first_write);                          // commands 0 and 1
  send(hasher, kMove, list.first_write + 20, list.path);          // 2 and 3
  send(hasher, {driver::DwellCommand{}}, list.first_write + 30);  // 4
  send(hasher, kMove, list.first_write + 50);                     // 5 and 6
  send(hasher, {driver::EndCommand{}}, list.first_write + 60);
  for (const Steps::Both& step : list.steps) {
    hasher.path_step(step.path);
    hasher.pin_step({step.cycle, step.path.axis, step.path.direction});
  }
  return hasher.finish();
}

StepHashes hashes_with(const std::function<void(Steps&)>& change, Shift shift = {0, 0}) {
  Steps steps;
  change(steps);
  return hashes_of(steps, shift);
}

TEST(StepHashes, CountStepsBarriersAndTimes) {
  const StepHashes hashes = hashes_of({});
  EXPECT_EQ(hashes.path_steps, 7U);
  EXPECT_EQ(hashes.pin_steps, 7U);
  EXPECT_EQ(hashes.barriers, 2U);
  EXPECT_EQ(hashes.start, 110);
  EXPECT_EQ(hashes.lead, 1030 - 920);
}

TEST(StepHashes, OfTheSameStepsAreTheSame) {
  EXPECT_EQ(hashes_of({}).path, hashes_of({}).path);
  EXPECT_EQ(hashes_of({}).pins, hashes_of({}).pins);
}

TEST(StepHashes, ShowATickACommandAnAxisADirectionOfThePath) {
  const StepHashes same = hashes_of({});
  EXPECT_NE(hashes_with([](Steps& s) { ++s.steps[2].path.tick; }).path, same.path);
  EXPECT_NE(hashes_with([](Steps& s) { s.steps[2].path.command = 0; }).path, same.path);
  EXPECT_NE(hashes_with([](Steps& s) { s.steps[2].path.axis = 1; }).path, same.path);
  EXPECT_NE(hashes_with([](Steps& s) { s.steps[2].path.direction = -1; }).path, same.path);
}

TEST(StepHashes, ShowACycleAnAxisADirectionAtThePins) {
  const StepHashes same = hashes_of({});
  for (std::size_t i = 1; i < Steps{}.steps.size(); ++i) {
    EXPECT_NE(hashes_with([i](Steps& s) { ++s.steps[i].cycle; }).pins, same.pins) << i;
  }
  EXPECT_NE(hashes_with([](Steps& s) { s.steps[2].path.axis = 1; }).pins, same.pins);
  EXPECT_NE(hashes_with([](Steps& s) { s.steps[2].path.direction = -1; }).pins, same.pins);
}

TEST(StepHashes, ShowStepsThatChangedPlaces) {
  const auto swapped = [](Steps& s) {
    std::swap(s.steps[3].path.axis, s.steps[4].path.axis);
    std::swap(s.steps[3].path.direction, s.steps[4].path.direction);
  };
  EXPECT_NE(hashes_with(swapped).path, hashes_of({}).path);
  EXPECT_NE(hashes_with(swapped).pins, hashes_of({}).pins);
}

TEST(StepHashes, ShowAStepTooManyAndOneTooFew) {
  const auto more = [](Steps& s) { s.steps.push_back({{6, 11, 0, 1}, 5011}); };
  const auto fewer = [](Steps& s) { s.steps.pop_back(); };
  for (const auto& change : {std::function<void(Steps&)>(more), std::function<void(Steps&)>(fewer)}) {
    EXPECT_NE(hashes_with(change).path, hashes_of({}).path);
    EXPECT_NE(hashes_with(change).pins, hashes_of({}).pins);
  }
}

TEST(StepHashes, DoNotDependOnTheOrderWithinOneTick) {
  const auto swapped = [](Steps& s) { std::swap(s.steps[0], s.steps[1]); };
  EXPECT_EQ(hashes_with(swapped).path, hashes_of({}).path);
  EXPECT_EQ(hashes_with(swapped).pins, hashes_of({}).pins);
}

TEST(StepHashes, LeaveOutWhenTheConfigurationEnded) {
  const StepHashes later = hashes_with([](Steps& s) {
    s.first_write += 77;
    for (auto& step : s.steps) step.cycle += 77;
  });
  EXPECT_EQ(later.pins, hashes_of({}).pins);
  EXPECT_EQ(later.start, hashes_of({}).start);
}

TEST(Shift, CancelsExactly) {
  const auto slower = [](Steps& s) {
    for (auto& step : s.steps) step.cycle += step.path.command > 4 ? 5 + 3 : 5;
  };
  const StepHashes shifted = hashes_with(slower, {5, 3});
  EXPECT_EQ(shifted.pins, hashes_of({}).pins);
  EXPECT_EQ(shifted.start, hashes_of({}).start);
  for (const Shift wrong : {Shift{5, 2}, Shift{5, 4}, Shift{5, 0}}) {
    EXPECT_NE(hashes_with(slower, wrong).pins, hashes_of({}).pins);
  }
  EXPECT_NE(hashes_with(slower, {4, 3}).start, hashes_of({}).start);
}

TEST(Shift, OfABarrierDoesNotHideOneClockBehindIt) {
  const auto slower = [](Steps& s) {
    s.steps[5].cycle += 3;
    s.steps[6].cycle += 4;
  };
  EXPECT_NE(hashes_with(slower, {0, 3}).pins, hashes_of({}).pins);
}

// An arc on the accumulator: its path ticks are included, and there is no hash of the pins.
TEST(Arcs, HaveNoHashOfThePins) {
  const auto arc = [](Steps& s) { s.path = StepHasher::Path::kArc; };
  EXPECT_FALSE(hashes_with(arc).pins);
  EXPECT_EQ(hashes_with(arc).path, hashes_of({}).path);
}

TEST(Arcs, InChordsCountThePulsesOfEachCommandAndAxis) {
  const auto chords = [](Steps& s) { s.path = StepHasher::Path::kChords; };
  const auto same = hashes_with(chords);
  const auto with = [&](const std::function<void(Steps&)>& change) {
    return hashes_with([&](Steps& s) {
      chords(s);
      change(s);
    });
  };
  EXPECT_EQ(with([](Steps& s) { ++s.steps[3].path.tick; }).path, same.path);
  EXPECT_NE(with([](Steps& s) { s.steps[3].path.command = 2; }).path, same.path);
  EXPECT_NE(with([](Steps& s) { s.steps[3].path.axis = 1; }).path, same.path);
  EXPECT_NE(with([](Steps& s) { s.steps[4].path.direction = -1; }).path, same.path);
  EXPECT_NE(with([](Steps& s) { ++s.steps[5].path.tick; }).path, same.path) << "a line";
}

TEST(Pins, WithOtherStepsThanThePathsAreRefused) {
  StepHasher hasher({0, 0});
  send(hasher, kMove, 10);
  EXPECT_THROW(hasher.pin_step({20, 0, 1}), std::logic_error);
  hasher.path_step({1, 1, 0, 1});
  EXPECT_THROW(hasher.pin_step({20, 0, -1}), std::logic_error);
  EXPECT_THROW(hasher.finish(), std::logic_error);
}

TEST(Lead, ShowsAPathThatCameTooLate) {
  StepHasher hasher({0, 0});
  send(hasher, kMove, 10);
  hasher.path_step({1, 1, 0, 1});
  hasher.pin_step({20, 0, 1});
  send(hasher, kMove, 25);
  hasher.path_step({3, 1, 0, 1});
  hasher.pin_step({40, 0, 1});
  EXPECT_EQ(hasher.finish().lead, -5);
}

}  // namespace
}  // namespace trammel::test
