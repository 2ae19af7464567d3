// LinuxCNC's periods on a card by position streaming (driver::PositionStream): one line per period, to its target.
//
// Time. LinuxCNC's clock and the card's differ, and periods come unevenly. The stream keeps half a period less than
// `lead` periods queued, by making each period at most 0.2 % longer or shorter. At rest it is quicker: it leaves out a
// period where too many are queued, and doubles one where too few are. A period that never came is made up by a line
// that is longer by it, so that the next target is met in time.
//
// Thread-safety: as of the card. Nothing is allocated for a period.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "trammel/driver/card.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

struct ServoSettings {
  unsigned lead = 2;                                   // periods, at least 1
  unsigned stale_periods = 1;                          // that the card goes on for along its last line
  std::array<double, card_map::kMaxAxes> max_speed{};  // pulses/s; 0: what the card can do
};

// Told what goes to the card.
class ServoRecord {
 public:
  virtual ~ServoRecord() = default;
  // `clock`: of the card; positions: pulses from machine zero.
  virtual void opened(std::uint64_t clock, const std::array<std::int64_t, card_map::kMaxAxes>& positions) = 0;
  // A line that was sent: its duration, ns, and where it ends, 2^-24 pulses from machine zero.
  virtual void line(const trammel_period& period, std::int64_t duration) = 0;
  virtual void closed(std::uint64_t clock) = 0;
};

class ServoStream {
 public:
  using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;
  struct Counts {
    std::uint32_t late = 0;     // periods before which the card went on along its line
    std::uint32_t dropped = 0;  // that never came
  };

  // `card` must outlive it, and `record` where there is one.
  explicit ServoStream(driver::Card& card, ServoRecord* record = nullptr) : card_(card), record_(record) {}

  bool is_open() const { return stream_ != nullptr; }
  // Opens where the card stands, which is `from`, pulses from machine zero. Errors as of PositionStream's constructor.
  void open(const ServoSettings& settings, const Pulses& from);
  // Sends the period's line. `held`: the card stands in a hold. Errors as of PositionStream::send(); the stream is
  // still open behind them.
  void follow(const trammel_period& period, bool held);
  // Whether the last line moved nothing: the card ends it at rest.
  bool at_rest() const { return resting_; }
  // Ends the stream: at rest behind the last line, else on the card's ramp. Waits until the card stands. FaultError for
  // a fault of another cause; else errors as of PositionStream::finish(). It is closed behind them.
  void close();
  // The same, always on the ramp: for a stream in which a period was refused.
  void end_on_ramp();
  // Behind a fault: waits until the card stands, and closes. Leaves the card's fault as it is.
  void abandon();

  const Counts& counts() const { return counts_; }
  std::uint64_t ahead() const { return ahead_; }  // periods that have not begun, as the last one was sent
  std::uint64_t last_period() const { return last_number_; }

 private:
  std::int64_t duration_of(const trammel_period& period, std::uint64_t periods);
  bool can_skip(bool moves, bool held);
  void note_end();

  driver::Card& card_;
  ServoRecord* record_;
  ServoSettings settings_;
  std::unique_ptr<driver::PositionStream> stream_;
  Pulses origin_{};   // where the stream was opened, pulses from machine zero
  Pulses rounded_{};  // the last target
  bool resting_ = true;
  bool first_ = true;
  std::uint64_t last_number_ = 0;
  std::uint64_t ahead_ = 0;
  double mean_ahead_ = 0;  // periods
  Counts counts_;
};

}  // namespace trammel::linuxcnc
