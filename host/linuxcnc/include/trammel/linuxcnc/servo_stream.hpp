// Executes LinuxCNC's periods on a card by position streaming (driver::PositionStream): one line per period, to its
// target.
//
// Timing. LinuxCNC's clock and the card's differ, and periods arrive unevenly. The stream keeps half a period less than
// `lead` periods queued, by making each period up to 0.2 % longer or shorter. At rest the correction is faster: it
// omits a period if too many are queued, and doubles one if too few are. If a period never arrived, the next line is
// longer by its duration, so that the next target is reached on time.
//
// Thread safety: as the card. Sending a period allocates no memory.
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
  unsigned stale_periods = 1;                          // periods for which the card continues its last line
  std::array<double, card_map::kMaxAxes> max_speed{};  // pulses/s; 0: the card's maximum
};

// Receives a record of all that is sent to the card.
class ServoRecord {
 public:
  virtual ~ServoRecord() = default;
  // `clock`: card time; positions: pulses from machine zero.
  virtual void opened(std::uint64_t clock, const std::array<std::int64_t, card_map::kMaxAxes>& positions) = 0;
  // A line that was sent: its duration in ns, and its end in 2^-24 pulses from machine zero.
  virtual void line(const trammel_period& period, std::int64_t duration) = 0;
  virtual void closed(std::uint64_t clock) = 0;
};

class ServoStream {
 public:
  using Pulses = std::array<std::int64_t, card_map::kMaxAxes>;
  struct Counts {
    std::uint32_t late = 0;     // periods that arrived after the card had to continue its line
    std::uint32_t dropped = 0;  // periods that never arrived
  };

  // `card`, and `record` if given, must outlive the stream.
  explicit ServoStream(driver::Card& card, ServoRecord* record = nullptr) : card_(card), record_(record) {}

  bool is_open() const { return stream_ != nullptr; }
  // Opens at the card's present position, which is `from`, in pulses from machine zero. Throws as PositionStream's
  // constructor does.
  void open(const ServoSettings& settings, const Pulses& from);
  // Sends the period's line. `held`: the card is at rest in a hold. Throws as PositionStream::send() does; the stream
  // stays open then.
  void follow(const trammel_period& period, bool held);
  // Whether the last line had no motion: the card ends it at rest.
  bool at_rest() const { return resting_; }
  // Ends the stream: after the last line if that ends at rest, otherwise on the card's ramp. Waits until the card is at
  // rest. Throws FaultError for a fault with another cause; otherwise throws as PositionStream::finish() does. The
  // stream is closed in all cases.
  void close();
  // The same, but always on the ramp: for a stream in which a period was refused.
  void end_on_ramp();
  // After a fault: waits until the card is at rest, and closes. Does not clear the card's fault.
  void abandon();

  const Counts& counts() const { return counts_; }
  std::uint64_t ahead() const { return ahead_; }  // periods not yet begun when the last one was sent
  std::uint64_t last_period() const { return last_number_; }

 private:
  std::int64_t duration_of(const trammel_period& period, std::uint64_t periods);
  bool can_skip(bool moves, bool held);
  void drop();
  void note_end();

  driver::Card& card_;
  ServoRecord* record_;
  ServoSettings settings_;
  std::unique_ptr<driver::PositionStream> stream_;
  Pulses origin_{};   // position at which the stream was opened, pulses from machine zero
  Pulses rounded_{};  // the last target, in whole pulses
  bool resting_ = true;
  bool first_ = true;
  std::uint64_t last_number_ = 0;
  std::uint64_t ahead_ = 0;
  double mean_ahead_ = 0;  // periods
  Counts counts_;
};

}  // namespace trammel::linuxcnc
