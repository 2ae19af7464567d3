// Golden model of the snapshot's sequence: who is served when (docs/developer/architecture.md, Registers).
//
// A request in clock r strobes in r+1 and keeps the RAM from r+1 to r+axes+11. The stop's request goes before the
// host's: it breaks into one under way, and the host's is then taken anew, in the clock after the stop's last.
// One instance for each card; not thread-safe.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::model {

class SnapshotWriter {
 public:
  // axes: 1 .. 8
  explicit SnapshotWriter(std::uint32_t axes) : length_(axes + 11) {}

  // One rising edge, with the requests of the clock that it ends. True when the last word of finished() was written.
  bool clock(bool host, bool stop) {
    const bool last = left_ == 1;
    strobe_ = false;
    if (stop) {
      host_waits_ = host_waits_ || host || (left_ != 0 && area_ == card_map::Area::Snap);
      begin(card_map::Area::Stop);
      return false;
    }
    host_waits_ = host_waits_ || host;
    finished_ = area_;
    if (left_ != 0) --left_;
    if (left_ == 0 && host_waits_) {
      host_waits_ = false;
      begin(card_map::Area::Snap);
    }
    return last;
  }

  // Values and time of this clock are the snapshot's.
  bool strobe() const { return strobe_; }
  // STATUS.snapshot: the RAM is taken.
  bool busy() const { return left_ != 0; }
  // The area that was finished last.
  card_map::Area finished() const { return finished_; }

 private:
  void begin(card_map::Area area) {
    area_ = area;
    left_ = length_;
    strobe_ = true;
  }

  std::uint32_t length_;
  std::uint32_t left_ = 0;  // clocks for which the RAM is still taken
  bool strobe_ = false;
  bool host_waits_ = false;
  card_map::Area area_ = card_map::Area::Snap;
  card_map::Area finished_ = card_map::Area::Snap;
};

}  // namespace trammel::model
