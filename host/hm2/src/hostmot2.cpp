#include "trammel/hm2/hostmot2.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "trammel/hm2/register_map.hpp"

namespace trammel::hm2 {
namespace {

constexpr std::uint32_t kRegisterBytes = 0x100;  // distance between two registers of the step generators

driver::StepMode mode_of(std::uint32_t value) {
  return value == 1   ? driver::StepMode::kUpDown
         : value == 2 ? driver::StepMode::kQuadrature
                      : driver::StepMode::kStepDirection;
}

unsigned inputs_of(driver::Card& card) {
  const bool has = card_map::has_engine(card.identification().engines, card_map::engine::kPathCommands);
  return has ? std::min(card.inputs_present(), map::kPins - 2 * card.identification().axes) : 0;
}

}  // namespace

Hostmot2::Hostmot2(driver::Card& card, CardTime& time, Note note)
    : card_(card),
      time_(time),
      note_(std::move(note)),
      steps_(card, time),
      words_(map::constant_words(card.identification().axes, card.identification().clock_hz)),
      inputs_(inputs_of(card)) {}

std::uint32_t Hostmot2::read(std::uint32_t address) {
  const unsigned axis = address % kRegisterBytes / 4;
  if (address == map::kWatchdogTimer) return watchdog_.timer();
  if (address == map::kWatchdogStatus) return watchdog_.bitten() ? 1 : 0;
  if (address == map::kPortData) return read_pins();
  if (address - axis * 4 == map::kAccumulator && axis < steps_.axes()) return read_accumulator(axis);
  return words_[address / 4];
}

std::uint32_t Hostmot2::read_accumulator(unsigned axis) {
  if (!latched_) steps_.latch();
  latched_ = true;
  return steps_.accumulator(axis);
}

// The inputs, after the pins of the step generators.
std::uint32_t Hostmot2::read_pins() {
  if (inputs_ == 0) return 0;
  const std::uint32_t levels = card_.read_inputs() & ((std::uint32_t{1} << inputs_) - 1);
  return levels << (2 * steps_.axes());
}

void Hostmot2::write(std::uint32_t address, std::uint32_t value) {
  const unsigned axis = address % kRegisterBytes / 4;
  const std::uint32_t first = address - axis * 4;
  if (address == map::kWatchdogTimer) return watchdog_.set_timer(value, time_.now());
  if (address == map::kWatchdogReset) return watchdog_.reset(value, time_.now());
  if (address == map::kWatchdogStatus) return write_status(value);
  if (address == map::kPortInvert) return write_inverts(value);
  if (first == map::kStepRate && axis < steps_.axes()) {
    if (!watchdog_.bitten()) steps_.set_rate(axis, static_cast<std::int32_t>(value));
    return;
  }
  if (first >= map::kMode && first <= map::kStepSpace && axis < steps_.axes()) write_times(first, axis, value);
}

void Hostmot2::write_times(std::uint32_t address, unsigned axis, std::uint32_t value) {
  words_[address / 4 + axis] = value;
  StepTimes& times = times_[axis];
  const std::uint32_t clocks = value & map::kLongestTime;
  if (address == map::kMode) times.mode = mode_of(value);
  if (address == map::kDirectionSetup) times.setup = clocks;
  if (address == map::kDirectionHold) times.hold = clocks;
  if (address == map::kStepLength) times.length = clocks;
  if (address == map::kStepSpace) times.space = clocks;
  steps_.set_times(axis, times);
}

void Hostmot2::write_inverts(std::uint32_t value) {
  words_[map::kPortInvert / 4] = value;
  for (unsigned n = 0; n < steps_.axes(); ++n) {
    times_[n].invert_first = (value >> (2 * n) & 1) != 0;
    times_[n].invert_second = (value >> (2 * n + 1) & 1) != 0;
    steps_.set_times(n, times_[n]);
  }
}

void Hostmot2::write_status(std::uint32_t value) {
  if (!watchdog_.set_status(value, time_.now())) return;
  if (!steps_.trouble().empty()) steps_.clear_trouble();
  note_("the driver has cleared the watchdog");
}

void Hostmot2::run_to(std::uint64_t clock) {
  steps_.run_to(std::min(clock, watchdog_.deadline()));
  // The card may be some accesses beyond `clock`, but datagrams that arrived by then must still be processed; so
  // `clock` is compared.
  if (clock >= watchdog_.deadline()) bite("the driver has not written the watchdog in time");
  if (!steps_.trouble().empty() && !watchdog_.bitten()) bite(steps_.trouble());
  steps_.run_to(clock);
}

void Hostmot2::bite(const std::string& why) {
  watchdog_.bite();
  ++bites_;
  const bool moved = steps_.moves();
  steps_.stop();
  std::string places;
  for (unsigned n = 0; n < steps_.axes(); ++n) places += fmt::format(" {}", steps_.counters()[n]);
  note_(fmt::format("watchdog at clock {}: {}; {}; counters{}", time_.now(), why,
                    moved ? "motion has ended" : "at rest", places));
}

}  // namespace trammel::hm2
