// Shows whether two runs made the same path (PathIdentity), and how late the shaper emits each step (ShaperDelay). Not
// thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "trammel/card_map.hpp"
#include "trammel/driver/steps.hpp"

namespace trammel::run {

// A hash of the list of path steps (command, tick, axis, direction), in their order, without the times. Equal lists
// have equal hashes; two different lists have the same hash with a probability of 2^-64.
class PathIdentity final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override {
    const std::uint64_t word =
        step.tick << 8 | static_cast<std::uint64_t>(step.axis) << 1 | (step.direction < 0 ? 1U : 0U);
    add(hash_, step.command);
    add(hash_, word);
    add(unnumbered_, word);
    add(order_, word & 0xFF);
    ++count_;
  }
  std::uint64_t count() const { return count_; }
  std::string text() const;  // 16 hexadecimal digits
  // The same without the commands' numbers, which restart when an interrupted run goes on.
  std::string unnumbered_text() const;
  // The same for axis and direction only. It is equal even if the speeds were planned differently and the paths have
  // other tick counts.
  std::string order_text() const;

 private:
  static void add(std::uint64_t& hash, std::uint64_t word) {
    hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 32;
  }

  std::uint64_t hash_ = 0;
  std::uint64_t unnumbered_ = 0;
  std::uint64_t order_ = 0;
  std::uint64_t count_ = 0;
};

// Clocks from a step of the path to its leading edge at the pins: the shaper's minimum delay, plus the time for which
// it holds steps back for pulse, space and direction times. The n-th pulse of an axis is its n-th step of the path.
class ShaperDelay final : public driver::StepSink {
 public:
  struct Range {
    std::uint64_t least = 0;
    std::uint64_t most = 0;
  };
  void path_step(const driver::PathStep& step) override { waiting_[step.axis].push_back(step); }
  // Throws std::runtime_error for a pulse that has no path step, or has the other direction.
  void pin_step(const driver::PinStep& step) override;
  // None before the first step.
  const std::optional<Range>& range() const { return range_; }
  // Throws std::runtime_error if a path step has not appeared at the pins.
  void finish() const;

 private:
  std::array<std::deque<driver::PathStep>, card_map::kMaxAxes> waiting_;  // steps in the shapers; a few
  std::optional<Range> range_;
};

}  // namespace trammel::run
