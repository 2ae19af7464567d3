#include "trammel/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trammel::world {

bool World::Switch::pressed_at(double place) const {
  const std::int64_t back = contact.pressed() ? description.hysteresis : 0;
  return description.above ? place >= static_cast<double>(description.at - back)
                           : place <= static_cast<double>(description.at + back);
}

std::int64_t World::Switch::edge() const {
  const std::int64_t back = contact.pressed() ? description.hysteresis : 0;
  return description.above ? description.at - back : description.at + back;
}

void World::pulse(std::uint64_t clock, unsigned card_axis, int direction) {
  run_to(clock);
  for (Axis& axis : axes_) {
    if (axis.description.card_axis != card_axis) continue;
    axis.carriage.pulse(direction);
    step_due_ = std::min(step_due_, next_boundary());
  }
}

void World::run_to(std::uint64_t clock) {
  for (;;) {
    const std::uint64_t event = next_event_ < events_.size() ? events_[next_event_].clock : UINT64_MAX;
    const std::uint64_t due = std::min({event, step_due_, contact_due_, power_due_});
    if (due > clock) break;
    now_ = std::max(now_, due);
    if (due == power_due_) switch_power();
    if (due == event) make_events();
    if (due == step_due_) move();
    show_pins();
  }
  now_ = std::max(now_, clock);
}

std::uint64_t World::quiet_until() const {
  constexpr double kWatch = 1e-3;  // s, interval at which a drive monitors its motor
  std::uint64_t until = std::min(contact_due_, power_due_);
  if (next_event_ < events_.size()) until = std::min(until, events_[next_event_].clock);
  if (watches_) until = std::min(until, now_ + static_cast<std::uint64_t>(kWatch * clock_hz_));
  for (const Switch& one : switches_) {
    const Carriage& carriage = axes_[one.description.axis].carriage;
    const std::uint64_t steps = carriage.steps_short_of(one.edge(), part_) / parts_;
    until = std::min(until, next_boundary() + steps * step_clocks_);
  }
  return std::max(until, now_ + 1);
}

void World::make_events() {
  for (; next_event_ < events_.size() && events_[next_event_].clock <= now_; ++next_event_) {
    set(events_[next_event_].button, events_[next_event_].press);
  }
}

void World::move() {
  bool still = true;
  for (Axis& axis : axes_) {
    for (unsigned part = 0; part < parts_; ++part) axis.carriage.advance(part_);
    if (axis.description.alarm_at) watch(axis);
    still = still && axis.carriage.still();
  }
  for (Switch& one : switches_) {
    one.contact.set(one.pressed_at(axes_[one.description.axis].carriage.position()), now_);
  }
  step_due_ = still ? UINT64_MAX : next_boundary();
  if (watcher_ != nullptr) watcher_->moved(*this);
}

void World::watch(Axis& axis) {
  const double lag = static_cast<double>(axis.carriage.commanded()) - axis.carriage.position();
  const double most = *axis.description.alarm_at * axis.description.carriage.motor.pulses_a_full_step;
  if (std::abs(lag) < most || buttons_[axis.alarm].contact.pressed()) return;
  set(axis.alarm, true);
}

void World::set(std::size_t button, bool pressed) {
  time_power(buttons_[button], pressed);
  buttons_[button].contact.set(pressed, now_);
  switch_power();
  show_pins();
}

// A second press of a button that is already pressed does not restart its delay.
void World::time_power(Button& button, bool pressed) {
  if (!button.description.cuts_power || pressed == button.contact.pressed()) return;
  const auto delay = static_cast<std::uint64_t>(button.description.power_delay * clock_hz_);
  button.cut_at = pressed ? now_ + delay : UINT64_MAX;
}

void World::switch_power() {
  bool cut = false;
  power_due_ = UINT64_MAX;
  for (const Button& button : buttons_) {
    cut = cut || button.cut_at <= now_;
    if (button.cut_at > now_) power_due_ = std::min(power_due_, button.cut_at);
  }
  for (Axis& axis : axes_) {
    axis.carriage.set_power(!cut && (axis.alarm == kNone || !buttons_[axis.alarm].contact.pressed()));
    if (!axis.carriage.still()) step_due_ = std::min(step_due_, next_boundary());
  }
}

void World::show_pins() {
  std::uint64_t due = UINT64_MAX;
  const auto level = [&](Contact& contact) {
    contact.run_to(now_);
    due = std::min(due, contact.next_change());
    return contact.closed() == closed_level_;
  };
  std::uint32_t levels = 0;
  const bool emergency_stop = emergency_stop_;
  for (Switch& one : switches_) levels |= std::uint32_t{level(one.contact)} << one.description.input;
  for (Button& button : buttons_) {
    const bool high = level(button.contact);
    if (button.description.input)
      levels |= std::uint32_t{high} << *button.description.input;
    else
      emergency_stop_ = button.contact.closed() != button.description.contact.normally_closed;
  }
  const bool changed = levels != levels_ || emergency_stop_ != emergency_stop;
  levels_ = levels;
  contact_due_ = due;
  if (changed && watcher_ != nullptr) watcher_->pins_changed(*this);
}

}  // namespace trammel::world
