// Golden model of the queues' watermarks: a queue is low while fewer halfwords are in it than its watermark says. What
// room and watermark are in clock c shows at c+2. Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"

namespace trammel::model {

class QueueWatermarks {
 public:
  struct Inputs {
    Setting setting;                  // GEOMETRY_WATERMARK, FEED_WATERMARK
    std::uint32_t geometry_room = 0;  // halfwords
    std::uint32_t feed_room = 0;
  };
  struct Outputs {
    bool geometry_low = false;
    bool feed_low = false;
    bool operator==(const Outputs& o) const { return geometry_low == o.geometry_low && feed_low == o.feed_low; }
  };

  // Depths in halfwords.
  QueueWatermarks(std::uint32_t geometry_depth, std::uint32_t feed_depth)
      : geometry_depth_(geometry_depth), feed_depth_(feed_depth) {}

  // One rising edge.
  void clock(const Inputs& in) {
    outputs_ = next_;
    next_ = judged(in);
    if (in.setting.set) set(in.setting);
  }

  const Outputs& outputs() const { return outputs_; }

  // Without a setting clock() changes nothing while the rooms stay.
  bool quiet(const Inputs& in) const { return outputs_ == next_ && next_ == judged(in); }

 private:
  Outputs judged(const Inputs& in) const {
    return {geometry_depth_ - in.geometry_room < geometry_watermark_, feed_depth_ - in.feed_room < feed_watermark_};
  }
  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kGeometryWatermark) geometry_watermark_ = setting.data;
    if (setting.address == card_map::reg::kFeedWatermark) feed_watermark_ = setting.data;
  }

  std::uint32_t geometry_depth_;
  std::uint32_t feed_depth_;
  std::uint32_t geometry_watermark_ = 0;
  std::uint32_t feed_watermark_ = 0;
  Outputs next_;
  Outputs outputs_;
};

}  // namespace trammel::model
