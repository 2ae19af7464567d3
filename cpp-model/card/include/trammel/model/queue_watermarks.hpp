// Golden model of the queues' watermarks: a queue is low while it holds fewer halfwords than its watermark. The
// outputs of clock c+2 follow from room and watermark in clock c. Not thread-safe; no errors are reported.
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
  // All that the next clock() depends on besides its inputs.
  struct State {
    std::uint32_t geometry_watermark = 0;
    std::uint32_t feed_watermark = 0;
    Outputs next;
    Outputs outputs;
  };

  // Depths in halfwords.
  QueueWatermarks(std::uint32_t geometry_depth, std::uint32_t feed_depth)
      : geometry_depth_(geometry_depth), feed_depth_(feed_depth) {}

  // One rising edge.
  void clock(const Inputs& in) {
    state_.outputs = state_.next;
    state_.next = judged(in);
    if (in.setting.set) set(in.setting);
  }

  const Outputs& outputs() const { return state_.outputs; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // The outputs two clocks later.
  Outputs judged(const Inputs& in) const {
    return {geometry_depth_ - in.geometry_room < state_.geometry_watermark,
            feed_depth_ - in.feed_room < state_.feed_watermark};
  }

 private:
  void set(const Setting& setting) {
    if (setting.address == card_map::reg::kGeometryWatermark) state_.geometry_watermark = setting.data;
    if (setting.address == card_map::reg::kFeedWatermark) state_.feed_watermark = setting.data;
  }

  std::uint32_t geometry_depth_;
  std::uint32_t feed_depth_;

  State state_;
};

}  // namespace trammel::model
