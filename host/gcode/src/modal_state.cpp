#include "modal_state.hpp"

#include <algorithm>

namespace trammel::gcode {

void ModalState::set(const WordSet& words) {
  if (const auto wanted = words.code(Group::kPlane)) plane = *wanted;
  if (const auto units = words.code(Group::kUnits)) inches = units == 200;
  if (const auto distance = words.code(Group::kArcDistance)) centre_absolute = distance == 901;
  if (const auto distance = words.code(Group::kDistance)) absolute = distance == 900;
  if (const auto extruder = words.code(Group::kExtruder)) extruder_absolute = extruder == 820;
  if (const auto retract = words.code(Group::kRetract)) retract_to_start = retract == 980;
  if (const auto speed = words.letter('S'); speed && !words.dwells_by_s()) spindle_speed = *speed;
  if (const auto state = words.code(Group::kSpindle)) spindle = *state;
  set_path_control(words);
}

void ModalState::set_path_control(const WordSet& words) {
  const std::optional<int> control = words.code(Group::kPathControl);
  if (!control) return;
  path_control = *control == 610   ? PathControl::kExactPath
                 : *control == 611 ? PathControl::kExactStop
                                   : PathControl::kContinuous;
  const std::optional<double> given = words.letter('P');
  // Can be below 0 only as long as a probe decides it.
  tolerance = path_control == PathControl::kContinuous && given ? std::max(0.0, *given) * mm_per_unit() : 0;
}

void ModalState::set_feed(const WordSet& words) {
  if (const auto mode = words.code(Group::kFeedMode)) {
    const bool wanted = mode == 930;
    if (wanted != inverse_time) feed.reset();
    inverse_time = wanted;
  }
  if (const auto given = words.letter('F')) {
    feed = *given;
    feed_in_inches = inches;
    feed_later = words.later('F');
  }
}

}  // namespace trammel::gcode
