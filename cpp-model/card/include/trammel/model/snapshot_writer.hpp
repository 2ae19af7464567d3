// Golden model of the snapshot writer: the order in which it serves requests (docs/developer/architecture.md,
// Registers).
//
// A request in clock r strobes in r+1 and occupies the RAM from r+1 to r+axes+11. Requests of a stop, of its rest and
// of the probe interrupt any snapshot. A MARK's request interrupts the host's snapshot, unless that one is being
// repeated. An interrupted host snapshot is repeated in the clock after the end of the other one. A MARK's snapshot
// that was interrupted or had to wait follows when the RAM has been free for one clock. A capture's request
// interrupts nothing and waits in the same way; its unit requests until it is told. One instance per card; not
// thread-safe.
#pragma once

#include <cstdint>
#include <optional>

#include "trammel/card_map.hpp"

namespace trammel::model {

class SnapshotWriter {
 public:
  // axes: 1 .. 8
  explicit SnapshotWriter(std::uint32_t axes) : length_(axes + 11) {}

  struct Requests {
    bool host = false;
    bool stop = false;
    bool rest = false;
    bool probe = false;
    bool mark = false;
    std::uint8_t captures = 0;  // a bit per unit: it requests its snapshot
  };
  // One rising edge, with the requests of the clock that it ends.
  void clock(const Requests& in) {
    using card_map::Area;
    strobe_ = false;
    const bool under_way = left_ != 0;
    const bool hosts = under_way && area_ == Area::Snap;
    const bool breaks = in.stop || in.rest || in.probe;
    const bool marks = in.mark || mark_waits_;
    const bool capture = !breaks && !under_way && in.captures != 0 && !(capture_ && marks);
    const bool mark = !breaks && !capture && (under_way ? in.mark && hosts && !again_ : marks);
    wanted_ = wanted_ && (in.captures >> unit_ & 1) != 0;
    host_waits_ = host_waits_ || in.host || ((breaks || mark) && hosts);
    mark_waits_ = (marks || (breaks && under_way && area_ == Area::Mark)) && !mark;
    if (left_ != 0) --left_;
    if (capture) {
      for (unit_ = 0; (in.captures >> unit_ & 1) == 0;) ++unit_;
      begin(capture_area(unit_));
      capture_ = wanted_ = true;
    } else if (breaks || mark) {
      begin(in.stop ? Area::Stop : in.rest ? Area::Rest : in.probe ? Area::Probe : Area::Mark);
    } else if (left_ == 0 && host_waits_) {
      host_waits_ = false;
      again_ = under_way;
      begin(Area::Snap);
    }
  }

  // The snapshot takes the values and the time of this clock.
  bool strobe() const { return strobe_; }
  // STATUS.snapshot: the RAM is occupied.
  bool busy() const { return left_ != 0; }
  // True if a request of the host or of a MARK has not begun.
  bool waits() const { return host_waits_ || mark_waits_; }
  card_map::Area area() const { return area_; }
  // The units, a bit each, that learn in this clock that their snapshot is in the area. `captures`: the units that
  // request in this clock.
  std::uint8_t captured(std::uint8_t captures) const {
    const std::uint32_t bit = 1U << unit_;
    return static_cast<std::uint8_t>(left_ == 1 && capture_ && wanted_ ? captures & bit : 0U);
  }
  // The area is written at one word per clock. Returns the number of the word that is written in this clock, from 0,
  // or none. A request that interrupts in this clock does not prevent the write.
  std::optional<std::uint32_t> word() const {
    if (left_ < 2 || left_ > length_ - 2) return std::nullopt;
    return length_ - 2 - left_;
  }

 private:
  static card_map::Area capture_area(unsigned unit) {
    constexpr card_map::Area kAreas[] = {card_map::Area::Capture0, card_map::Area::Capture1, card_map::Area::Capture2,
                                         card_map::Area::Capture3};
    return kAreas[unit];
  }
  void begin(card_map::Area area) {
    capture_ = false;
    area_ = area;
    left_ = length_;
    strobe_ = true;
  }

  std::uint32_t length_;
  std::uint32_t left_ = 0;  // clocks for which the RAM is still occupied
  bool strobe_ = false;
  bool host_waits_ = false;
  bool mark_waits_ = false;
  bool again_ = false;    // the host's snapshot is being repeated
  bool capture_ = false;  // the snapshot under way, or the last one, is that of a capture
  bool wanted_ = false;   // its unit has requested it without a break
  unsigned unit_ = 0;
  card_map::Area area_ = card_map::Area::Snap;
};

}  // namespace trammel::model
