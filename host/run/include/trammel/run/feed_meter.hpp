// Measures the feed that a run achieves beside the one that the program asks for. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "trammel/driver/steps.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::run {

// Over all motions with a feed, rapids and dwells left out. A motion's time goes from the last step of the path before
// it to its own last one; behind a dwell, and at the start, from its own first one.
class FeedMeter final : public driver::StepSink, public Observer {
 public:
  explicit FeedMeter(double clock_hz) : clock_hz_(clock_hz) {}

  void sending(const planner::PlannedBlock& planned) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override;

  // Mean along the path, mm/min; none without a motion with feed.
  std::optional<double> commanded() const { return per_minute(wanted_seconds_); }
  std::optional<double> achieved() const { return per_minute(static_cast<double>(clocks_) / clock_hz_); }

 private:
  enum class Kind : std::uint8_t { kFeed, kRapid, kBarrier };
  struct Sent {
    std::uint64_t number;
    Kind kind;
  };
  std::optional<double> per_minute(double seconds) const;

  double clock_hz_;
  Kind block_ = Kind::kBarrier;
  std::deque<Sent> sent_;  // to the geometry queue, from the one under way on
  double length_ = 0;      // mm
  double wanted_seconds_ = 0;
  std::uint64_t clocks_ = 0;
  std::optional<std::uint64_t> last_;  // clock of the step before
};

}  // namespace trammel::run
