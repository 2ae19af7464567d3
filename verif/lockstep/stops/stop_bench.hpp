// A card with its causes of a stop wired, and a host at its register port. The bench observes only the pins, with a
// PinWatch, and the port's answers.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../card/axi_host.hpp"
#include "../card/commands.hpp"
#include "pin_watch.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "watched_card.hpp"

namespace trammel::test {

namespace reg = card_map::reg;
namespace field = card_map::field;

// Each mode of the pins once, with different times. Steps of an axis are at least kTickClocks apart.
inline constexpr std::array<AxisPins, kWatchedAxes> kAxisPins{{{AxisPins::kStepDir, false, 2, 3, 2, 2},
                                                               {AxisPins::kUpDown, false, 3, 2, 3, 1},
                                                               {AxisPins::kQuadrature, false, 2, 3, 1, 3},
                                                               {AxisPins::kStepDir, true, 0, 4, 2, 2}}};
inline constexpr unsigned kTickClocks = 16;
// 1,024 clocks from full ratio to rest; the ramp has the ticks of half of them.
inline constexpr std::uint32_t kSlew = 1U << 20;
inline constexpr std::uint64_t kRampClocks = (std::uint64_t{1} << 30) / kSlew;

// Outputs, all on after a reset: one changes at the cause of a stop, one at rest, one never.
enum Output : std::uint32_t { kOutputKept = 1, kOutputSafeAtCause = 2, kOutputSafeAtRest = 4, kOutputsAfterReset = 7 };
inline constexpr unsigned kDriveAxis = 2;  // the axis whose drive reports by kDriveInput

// The straps of each card here.
inline sim::CardStraps watched_straps() {
  sim::CardStraps straps;
  straps.output_idle = kOutputsAfterReset;
  return straps;
}

// Inputs of the card and their roles. The programs move axis 0 in the positive and axis 1 in the negative direction.
enum Input : std::uint32_t {
  kProbeInput = 2,  // for the command PROBE
  kLimitPlusInput = 5,
  kLimitMinusInput = 6,
  kDriveInput = 7,
  kProbeRoleInput = 8,
  kToolSetterInput = 9,
  kFeedHoldInput = 10,
  kCycleStartInput = 11,
  kBeginInput = 12,        // a program waits for this level
  kEmergencyStopPin = 32,  // a pin of its own
};

class StopBench {
 public:
  explicit StopBench(std::unique_ptr<WatchedCard> card) : card_(std::move(card)), host(*card_, 1) {
    card_->set_watch([this](const StepPins& pins) { watch.clock(++now_, pins); });
    host.wait(400);
  }

  // Sets times, modes and roles; the watch begins.
  void set_up() {
    for (unsigned n = 0; n < kWatchedAxes; ++n) {
      const AxisPins& axis = kAxisPins[n];
      write(reg::step_length(n), axis.length);
      write(reg::step_space(n), axis.space);
      write(reg::dir_setup(n), axis.setup);
      write(reg::dir_hold(n), axis.hold);
      write(reg::mode(n), axis.mode | (axis.inverted ? 12U : 0U));
    }
    write(reg::kSlew, kSlew);
    write(reg::role(8 * 1 + 0), 1U << kLimitPlusInput);
    write(reg::role(8 * 0 + 1), 1U << kLimitMinusInput);
    write(reg::role(8 * 4 + kDriveAxis), 1U << kDriveInput);
    write(reg::role(48), 1U << kProbeRoleInput);
    write(reg::role(49), 1U << kToolSetterInput);
    write(reg::role(50), 1U << kFeedHoldInput);
    write(reg::role(51), 1U << kCycleStartInput);
    write(reg::kOutputSafe, kOutputSafeAtRest << field::kOutputSafeChangeShift);
    write(reg::kOutputSafeCause, kOutputSafeAtCause << field::kOutputSafeCauseChangeShift);
    write(reg::kSetPlace, ((1U << kWatchedAxes) - 1) << field::kSetPlaceAxesShift | field::kSetPlacePositionValid |
                              field::kSetPlaceHomed);
    host.wait(140);
    watch.begin(kAxisPins, card_->pins());
  }

  void write(std::uint32_t address, std::uint32_t data) {
    if (!host.write(address, data)) throw std::logic_error("register " + std::to_string(address) + " was refused");
  }
  std::uint32_t read(std::uint32_t address) {
    const std::optional<std::uint32_t> data = host.read(address);
    if (!data) throw std::logic_error("register " + std::to_string(address) + " was not read");
    return *data;
  }
  std::uint64_t read_pair(std::uint32_t low, std::uint32_t high) {
    const std::uint64_t data = read(low);
    return data | std::uint64_t{read(high)} << 32;
  }
  // False if a word was refused.
  bool send(const driver::Command& command) {
    std::vector<std::uint32_t> words;
    driver::encode(command, number, words);
    for (const std::uint32_t word : words) {
      if (!host.write(reg::kStream, word)) return false;
    }
    ++number;
    return true;
  }
  void set_input(Input input, bool level) {
    if (input == kEmergencyStopPin) return host.press_emergency_stop(level);
    host.set_pins((host.pins() & ~(1U << input)) | (level ? 1U << input : 0U));
  }
  // Waits until an axis has made this many pulses, in either direction.
  void wait_pulses(unsigned axis, std::int32_t count) {
    for (unsigned clocks = 0; std::abs(watch.place[axis]) < count; ++clocks) {
      if (clocks == 20'000) throw std::logic_error("the program does not come to its window");
      host.wait(1);
    }
  }
  std::uint64_t now() const { return now_; }
  WatchedCard& card() { return *card_; }

 private:
  std::unique_ptr<WatchedCard> card_;
  std::uint64_t now_ = 0;

 public:
  AxiHostOf<WatchedCard> host;
  PinWatch watch;
  std::uint8_t number = 0;  // number of the next command
};

}  // namespace trammel::test
