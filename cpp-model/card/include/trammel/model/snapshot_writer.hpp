// Golden model of the snapshot's sequence: who is served when (docs/developer/architecture.md, Registers).
//
// A request in clock r strobes in r+1 and keeps the RAM from r+1 to r+axes+11. The stop's, its rest's and the probe's
// break into any other's, a MARK's into the host's, but not where that is taken anew already. The host's is then taken
// anew in the clock after the last; a MARK's, or one that had to wait, follows when the RAM was free for a clock. A
// capture's breaks into none, and follows likewise; its unit asks until it is told. One instance for each card; not
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
    std::uint8_t captures = 0;  // a bit for each unit that wants its snapshot
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

  // Values and time of this clock are the snapshot's.
  bool strobe() const { return strobe_; }
  // STATUS.snapshot: the RAM is taken.
  bool busy() const { return left_ != 0; }
  // A request has not begun.
  bool waits() const { return host_waits_ || mark_waits_; }
  card_map::Area area() const { return area_; }
  // The units, a bit each, that are told in this clock that their snapshot is in the area, where these ask in it.
  std::uint8_t captured(std::uint8_t captures) const {
    const std::uint32_t bit = 1U << unit_;
    return static_cast<std::uint8_t>(left_ == 1 && capture_ && wanted_ ? captures & bit : 0U);
  }
  // The words of the area are written a word a clock: the number of the one that is written in this clock, from 0; else
  // none. What breaks in comes too late for it.
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
  std::uint32_t left_ = 0;  // clocks for which the RAM is still taken
  bool strobe_ = false;
  bool host_waits_ = false;
  bool mark_waits_ = false;
  bool again_ = false;    // the host's is taken anew
  bool capture_ = false;  // the snapshot under way, or the last one, is a capture's
  bool wanted_ = false;   // its unit has asked all the while
  unsigned unit_ = 0;
  card_map::Area area_ = card_map::Area::Snap;
};

}  // namespace trammel::model
