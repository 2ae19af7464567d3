// Captures of inputs' edges: reads and writes of their registers.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "register_checks.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {

namespace reg = card_map::reg;
namespace field = card_map::field;

namespace {

card_map::Area area_of(unsigned unit) {
  constexpr card_map::Area kAreas[kCaptureUnits] = {card_map::Area::Capture0, card_map::Area::Capture1,
                                                    card_map::Area::Capture2, card_map::Area::Capture3};
  return kAreas[unit];
}

CaptureStates states_of(std::uint32_t word) {
  CaptureStates states;
  for (unsigned n = 0; n < kCaptureUnits; ++n) {
    const auto bit = [word, n](std::uint32_t shift) { return (word >> (shift + n) & 1) != 0; };
    states.units[n] = {bit(field::kCaptureStatePendingShift), bit(field::kCaptureStateValidShift),
                       bit(field::kCaptureStateOverrunShift), bit(field::kCaptureStateActiveShift)};
  }
  states.snapshots = static_cast<std::uint16_t>(word >> field::kCaptureStateSnapshotsShift);
  return states;
}

constexpr unsigned kMostQueued = 16;  // per call: callers have room for this many
unsigned captures_in(std::uint32_t queue) { return queue & field::kCaptureQueueCaptures; }

}  // namespace

unsigned Card::captures_present() const {
  const card_map::Descriptor* unit = identification().units.find(card_map::unit::kCaptures);
  return unit == nullptr ? 0 : std::min<unsigned>(unit->instances, kCaptureUnits);
}

void Card::check_capture(unsigned unit) const {
  if (unit < captures_present()) return;
  throw ArgumentError(fmt::format("capture unit {}: the card has {}", unit, captures_present()));
}

void Card::select_capture(unsigned unit, const CaptureSelect& select) {
  check_capture(unit);
  if (select.queue) check_capture_queue();
  if (select.input >= inputs_present()) {
    throw ArgumentError(
        fmt::format("capture unit {}: input {}: the card has {} inputs", unit, select.input, inputs_present()));
  }
  const std::uint32_t word =
      select.input << field::kCaptureSelectInputNumberShift | (select.to_active ? field::kCaptureSelectToActive : 0) |
      (select.to_inactive ? field::kCaptureSelectToInactive : 0) |
      (select.continuous ? field::kCaptureSelectContinuous : 0) | (select.queue ? field::kCaptureSelectQueue : 0);
  parts_->registers.write(reg::capture_select(unit), word, "capture");
}

void Card::stop_capture(unsigned unit) {
  check_capture(unit);
  parts_->registers.write(reg::capture_select(unit), 0, "capture");
}

CaptureStates Card::read_captures() {
  check_capture(0);
  const std::uint32_t word = parts_->registers.read(reg::kCaptureState);
  Registers::check_read({reg::kCaptureState, word});
  return states_of(word);
}

std::optional<Capture> Card::take_capture(unsigned unit) {
  check_capture(unit);
  if (!read_captures().units[unit].valid) return std::nullopt;
  Capture capture;
  capture.at = parts_->snapshots.capture(area_of(unit));
  const CaptureState state = read_captures().units[unit];
  capture.active = state.active;
  capture.overrun = state.overrun;
  parts_->registers.write(reg::kCaptureClear, 1U << unit, "capture");
  return capture;
}

bool Card::has_capture_queue() const {
  return card_map::has_engine(identification().engines, card_map::engine::kCaptureFifo);
}

void Card::check_capture_queue() const {
  if (!has_capture_queue()) throw ArgumentError("the card has no queue of captures");
}

CaptureQueue Card::read_capture_queue() {
  check_capture_queue();
  const std::uint32_t word = parts_->registers.read(reg::kCaptureQueue);
  Registers::check_read({reg::kCaptureQueue, word});
  return {captures_in(word), static_cast<std::uint16_t>(word >> field::kCaptureQueueLostShift)};
}

// Each capture is read before it is dropped, and dropped by its number. So a link that fails in between loses no
// capture and drops no capture twice.
std::vector<QueuedCapture> Card::take_queued_captures() {
  check_capture_queue();
  std::vector<QueuedCapture> result;
  std::uint32_t queue = parts_->registers.read(reg::kCaptureQueue);
  Registers::check_read({reg::kCaptureQueue, queue});
  for (unsigned left = std::min(captures_in(queue), kMostQueued); left != 0; --left) {
    QueuedCapture capture;
    capture.at = parts_->snapshots.capture(card_map::Area::CaptureHead);
    capture.unit = field_bits(queue, field::kCaptureQueueUnitNumber, field::kCaptureQueueUnitNumberShift);
    capture.active = (queue & field::kCaptureQueueActive) != 0;
    result.push_back(capture);
    const std::uint32_t number = field_bits(queue, field::kCaptureQueueOldest, field::kCaptureQueueOldestShift);
    std::array<Access, 3> next{write_of(reg::kCaptureNext, number), read_of(reg::kCaptureQueue)};
    parts_->registers.transfer(next.data(), 2, "capture");
    queue = next[1].data;
  }
  return result;
}

void Card::clear_captures(unsigned units) {
  check_capture(0);
  check_setting(reg::kCaptureClear, units, "units of captures");
  parts_->registers.write(reg::kCaptureClear, units, "capture");
}

Capture Card::wait_for_capture(unsigned unit, std::chrono::nanoseconds timeout) {
  const std::uint64_t limit = clocks_of(timeout, timing().clock_hz, "waiting for a capture: timeout");
  const std::uint64_t pause = poll_interval(timing().clock_hz);
  for (std::uint64_t waited = 0;; waited += pause) {
    if (std::optional<Capture> capture = take_capture(unit)) return *capture;
    parts_->watchdog.look();
    if (waited > limit) throw TimeoutError("waiting for a capture", waited);
    if (interrupted()) throw InterruptedError("waiting for a capture: interrupted; the unit goes on watching");
    bus().sleep(time_of(pause, timing().clock_hz));
  }
}

}  // namespace trammel::driver
