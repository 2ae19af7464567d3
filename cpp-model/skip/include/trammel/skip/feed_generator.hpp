// Adaptor of the feed generator. FeedAhead passes many enabled clocks at once. See horizon.hpp.
#pragma once

#include <cstdint>

#include "trammel/model/feed_generator.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

class FeedAhead {
 public:
  explicit FeedAhead(model::FeedGenerator& block) : block_(block), s_(block.state()) {}

  struct Advanced {
    std::uint64_t enables = 0;
    std::uint64_t carries = 0;
  };
  // Passes enabled clocks up to the `carries`-th carry, at most `limit`. Exact except for the ticks and rates in
  // flight, which appear only after 3 more clocks of clock(). Not for clocks with a swap, load or clear. Cost: one
  // division at a constant rate, otherwise about a nanosecond per update.
  Advanced advance(std::uint64_t limit, std::uint64_t carries);

 private:
  void advance_constant(Advanced& gone, std::uint64_t limit, std::uint64_t carries);
  void advance_varying(Advanced& gone, std::uint64_t limit, std::uint64_t carries);
  std::uint64_t whole_updates(std::uint64_t& sum, std::uint64_t target, std::uint64_t most);
  bool unclamped_for(std::uint64_t updates) const;

  model::FeedGenerator& block_;
  model::FeedGenerator::State& s_;
};

// The carry of the last clock(), or of the one or two clocks before it.
inline bool carried(const model::FeedGenerator& block, unsigned clocks_ago) {
  const model::FeedGenerator::State& s = block.state();
  return clocks_ago == 2 ? s.outputs.tick : s.in_flight[clocks_ago].tick;
}
// True if no tick is visible or in flight, and the rate shown is the one in use.
inline bool at_rest(const model::FeedGenerator& block) {
  const model::FeedGenerator::State& s = block.state();
  const auto rate = static_cast<std::uint32_t>(s.slope >> 16);
  return !(s.outputs.tick || s.in_flight[0].tick || s.in_flight[1].tick) && s.outputs.rate == rate &&
         s.in_flight[0].rate == rate && s.in_flight[1].rate == rate;
}

inline std::uint64_t horizon(const model::FeedGenerator& block, const model::FeedGenerator::Inputs& in) {
  const model::FeedGenerator::State& s = block.state();
  const bool moves = in.enable || in.swap || in.load.valid || (in.freeze && !(s.frozen && s.constant));
  return forever_if(!moves && at_rest(block) && (!in.clear || s.phase == 0));
}
inline void advance(model::FeedGenerator&, const model::FeedGenerator::Inputs&, std::uint64_t) {}

}  // namespace trammel::skip
