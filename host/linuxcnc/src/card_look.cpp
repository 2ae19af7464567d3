#include "trammel/linuxcnc/card_look.hpp"

#include <algorithm>

#include "trammel/driver/card_place.hpp"

namespace trammel::linuxcnc {
namespace {

constexpr unsigned kPlaceLooks = 16;    // homed and valid change rarely: they are read once per this number of looks
constexpr double kSpeedSeconds = 2e-3;  // shortest time over which a speed is measured

}  // namespace

CardLook::CardLook(driver::Card& card, const machine::Machine& machine) : card_(card), machine_(machine) {
  const driver::CardPlace place = driver::read_card_place(card);
  zero_ = place.zero;
  now_ = before_ = place.now;
  start_probe();
}

void CardLook::start_probe() {
  if (!machine_.probe.input || card_.captures_present() == 0) return;
  driver::CaptureSelect select;
  select.input = *machine_.probe.input;
  select.to_active = machine_.probe.touched_level;
  select.to_inactive = !machine_.probe.touched_level;
  select.continuous = true;
  card_.select_capture(0, select);
  probe_unit_ = 0;
}

CardLook::Pulses CardLook::from_zero(const driver::Snapshot& snapshot) const {
  Pulses pulses{};
  for (unsigned n = 0; n < card_.identification().axes; ++n) {
    pulses[n] = driver::pulses_between(zero_[n], snapshot.position[n]);
  }
  return pulses;
}

void CardLook::look(trammel_status& status) {
  now_ = card_.read_snapshot();
  const Pulses position = from_zero(now_);
  std::copy(position.begin(), position.end(), std::begin(status.position));
  const double seconds = static_cast<double>(now_.time - before_.time) / card_.identification().clock_hz;
  if (seconds >= kSpeedSeconds) {
    for (unsigned n = 0; n < card_.identification().axes; ++n) {
      status.speed[n] = driver::pulses_between(before_.position[n], now_.position[n]) / seconds;
    }
    before_ = now_;
  }
  status.flags |= TRAMMEL_STATUS_LINK;
  if (now_.status.held) status.flags |= TRAMMEL_STATUS_HELD;
  status.fault = now_.faults;
  status.inputs = card_.read_inputs();
  if (machine_.probe.input) {
    const bool level = (status.inputs >> *machine_.probe.input & 1U) != 0;
    if (level == machine_.probe.touched_level) status.flags |= TRAMMEL_STATUS_PROBE;
  }
  if (looks_++ % kPlaceLooks == 0) look_at_place(status);
  if (probe_unit_ || waits_ != 0) look_at_captures(status);
}

void CardLook::look_at_place(trammel_status& status) {
  const driver::Place place = card_.read_place();
  status.homed = place.homed;
  status.valid = place.valid;
}

void CardLook::look_at_captures(trammel_status& status) {
  const driver::CaptureStates states = card_.read_captures();
  if (probe_unit_ && states.units[*probe_unit_].valid) {
    if (const auto capture = card_.take_capture(*probe_unit_)) {
      const Pulses at = from_zero(capture->at);
      std::copy(at.begin(), at.end(), std::begin(status.capture_position));
      ++status.captures;
    }
  }
  for (unsigned n = 0; n < card_map::kMaxAxes; ++n) {
    if (!unit_[n] || (latched_ >> n & 1U) != 0 || !states.units[*unit_[n]].valid) continue;
    if (const auto capture = card_.take_capture(*unit_[n])) {
      status.index_position[n] = from_zero(capture->at)[n];
      latched_ |= 1U << n;
    }
  }
  status.index_latched = latched_;
}

std::optional<unsigned> CardLook::free_unit() const {
  for (unsigned unit = probe_unit_ ? 1 : 0; unit < card_.captures_present(); ++unit) {
    if (std::find(unit_.begin(), unit_.end(), std::optional<unsigned>(unit)) == unit_.end()) return unit;
  }
  return std::nullopt;
}

std::uint32_t CardLook::set_index_waits(std::uint32_t joints) {
  std::uint32_t refused = 0;
  for (unsigned n = 0; n < card_map::kMaxAxes; ++n) {
    const bool waits = (joints >> n & 1U) != 0;
    if (!waits && unit_[n]) {
      card_.stop_capture(*unit_[n]);
      unit_[n].reset();
    }
    if (!waits) latched_ &= ~(1U << n);
    if (!waits || unit_[n]) continue;
    const std::uint32_t inputs = machine_.inputs.roles[driver::Role(driver::AxisRole::kIndex, n).number()].inputs;
    const std::optional<unsigned> unit = free_unit();
    if (inputs == 0 || !unit) {
      refused |= 1U << n;
      continue;
    }
    driver::CaptureSelect select;
    while ((inputs >> select.input & 1U) == 0) ++select.input;
    card_.select_capture(*unit, select);
    unit_[n] = unit;
  }
  waits_ = joints;
  return refused;
}

}  // namespace trammel::linuxcnc
