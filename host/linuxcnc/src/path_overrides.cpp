// Holds and overrides of the path server: LinuxCNC's scales as the ratios of the card's time base.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "path_progress.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/linuxcnc/path_server.hpp"

namespace trammel::linuxcnc {

// Other users of the card expect the full ratio, and this server does not know their scales; so both ratios start at 1.
void PathServer::begin_overrides() {
  feed_scale_ = rapid_scale_ = -1;
  for (const auto piece_class : {driver::PieceClass::kFeed, driver::PieceClass::kRapid}) set_ratio(piece_class, 1);
}

void PathServer::end_overrides() {
  set_hold(false);
  card_.set_ratio(driver::PieceClass::kFeed, driver::Card::kFullRatio);
  if (card_.parts().time_base.has_classes()) card_.set_ratio(driver::PieceClass::kRapid, driver::Card::kFullRatio);
}

void PathServer::apply_overrides() {
  const trammel_path_settings& from = region_.path_settings;
  trammel_path_settings settings{};
  for (int tries = 0; tries < TRAMMEL_TRIES; ++tries) {
    const std::uint32_t before = __atomic_load_n(&region_.path_settings_sequence, __ATOMIC_ACQUIRE);
    std::memcpy(&settings, &from, sizeof settings);
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (before % 2 != 0 || before != __atomic_load_n(&region_.path_settings_sequence, __ATOMIC_RELAXED)) continue;
    beat_ = settings.beat;
    if (beat_ == 0) break;  // no planner module has written any yet
    set_ratio(driver::PieceClass::kFeed, settings.feed_scale);
    set_ratio(driver::PieceClass::kRapid, settings.rapid_scale);
    break;
  }
  set_hold(queue_.paused() || (feed_scale_ <= 0 && rapid_scale_ <= 0));
}

// If both scales are 0, the card holds instead; if only this one is, pieces of its class get the smallest ratio and
// almost stop.
void PathServer::set_ratio(driver::PieceClass piece_class, double scale) {
  double& in_force = piece_class == driver::PieceClass::kFeed ? feed_scale_ : rapid_scale_;
  if (!std::isfinite(scale)) return;
  scale = std::clamp(scale, 0.0, machine_.motion.max_override);
  if (scale == in_force) return;
  in_force = scale;
  if (scale <= 0 && feed_scale_ <= 0 && rapid_scale_ <= 0) return;
  if (piece_class != driver::PieceClass::kFeed && !card_.parts().time_base.has_classes()) return;
  const std::uint32_t ratio = driver::Card::ratio_of(100 * scale, 100 * machine_.motion.max_override);
  if (progress_) return card_.request_ratio(piece_class, std::max(ratio, 1U));
  card_.set_ratio(piece_class, std::max(ratio, 1U));
}

void PathServer::set_hold(bool hold) {
  if (hold == holding_) return;
  holding_ = hold;
  if (progress_) return card_.request_hold(hold);
  card_.set_hold(hold);
}

}  // namespace trammel::linuxcnc
