// Compares the feed that a run achieves with the programmed one. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "trammel/driver/steps.hpp"
#include "trammel/run/observer.hpp"

namespace trammel::run {

// Averages over all motions with a feed; rapids and dwells are excluded. The time of a motion is counted from the last
// step of the previous path to its own last step. After a dwell and at the start of the program it is counted from the
// motion's own first step.
class FeedMeter final : public driver::StepSink, public Observer {
 public:
  explicit FeedMeter(double clock_hz) : clock_hz_(clock_hz) {}

  void sending(const planner::PlannedBlock& planned) override;
  void command(std::uint64_t number, const driver::Command& command) override;
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override;

  // Mean feed along the path, mm/min; none if no motion has a feed.
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
  std::deque<Sent> sent_;  // commands sent to the geometry queue, from the current one on
  double length_ = 0;      // mm
  double wanted_seconds_ = 0;
  std::uint64_t clocks_ = 0;
  std::optional<std::uint64_t> last_;  // clock of the previous step
};

}  // namespace trammel::run
