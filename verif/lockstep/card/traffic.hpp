// Random traffic for the card under lockstep: programs, and everything that a host may do at any clock during them.
// The same seed gives the same traffic.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "axi_host.hpp"
#include "commands.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::test {

namespace reg = card_map::reg;
namespace field = card_map::field;

class Traffic {
 public:
  // One path in `arc_every` is an arc.
  Traffic(AxiHost& host, unsigned axes, unsigned arc_every = 4) : host_(host), axes_(axes), arc_every_(arc_every) {}

  // Sends a command; with `faulty`, sometimes with one wrong bit. False if a word was refused.
  bool send(const driver::Command& command, bool faulty = false) {
    std::vector<std::uint32_t> words;
    driver::encode(command, number_, words);
    return send_words(words, faulty);
  }
  // The same for the words of a command; their number is set here.
  bool send_words(std::vector<std::uint32_t> words, bool faulty) {
    words[0] = (words[0] & 0xFF'FFFF) | std::uint32_t{number_} << 24;
    if (faulty) corrupt(words);
    for (const std::uint32_t word : words) {
      const bool taken = host_.write(reg::kStream, word);
      note_causes();
      if (!taken) return false;
    }
    ++number_;
    chords_taken += (words[0] & 0xFF) == static_cast<std::uint32_t>(card_map::Opcode::ArcChord) ? 1U : 0U;
    return true;
  }
  // One OUTPUT or MARK per this many paths; 0: none.
  unsigned commands_every = 0;
  // Also PWM.
  bool pwm = false;
  // Pieces of all classes; otherwise only feed.
  bool classes = true;
  // One path in this many is an arc in chords; 0: none.
  unsigned chords_every = 0;
  std::uint64_t chords_taken = 0;
  void abort() {
    host_.write(reg::kControl, field::kControlAbort);
    number_ = 0;
  }
  // A few paths and their pieces in any order, sometimes with a barrier.
  void section(bool faulty);
  // A stream whose pieces have stop distances and continue each other, with stalls, holds and overrides; sometimes
  // left unfinished.
  void starved();
  // Paths between PROBE and PROBE_END, and waits for inputs, while inputs change; the edge is sometimes cleared,
  // sometimes not.
  void probing();
  std::uint64_t probed = 0;  // how often a probe had tripped; `missed`: had been missed
  std::uint64_t missed = 0;
  // Number of under-run holds; a reset clears it.
  std::uint64_t underruns = 0;
  // Position streaming: periods that are on time or late, by any number of clocks at any word; holds, overrides,
  // aborts and faults; mode changes in motion. Ends with an END, a missing period or an abort.
  void streamed();
  // False: no streams, for cards without position streaming.
  bool streams = true;
  // Missing periods, and observations of a card that continues a line without the next period.
  std::uint64_t missing = 0;
  std::uint64_t stale = 0;
  // Machine inputs: some filters, captures and roles of the inputs from 4 on, their effects, and soft limits. The
  // next recover() removes roles and soft limits. If `roles` is false, for cards without machine inputs, roles are
  // only given by chance.
  void machine_inputs();
  void drives();
  bool roles = false;
  // The emergency stop is pressed from time to time; recover() releases it.
  bool emergency = false;
  // Drives that are enabled for motion, in part of the traffic with `roles`.
  bool enables = false;
  std::uint64_t enabled = 0;  // observations of enabled drives, or of motion that waits for them
  // How often each bit of FAULT was set; button_holds: observations of a hold by the button.
  std::array<std::uint64_t, 32> causes{};
  // The count of the lowest bit in `mask`.
  std::uint64_t causes_of(std::uint32_t mask) const {
    unsigned bit = 0;
    while ((mask >> bit & 1U) == 0) ++bit;
    return causes[bit];
  }
  std::uint64_t button_holds = 0;
  // Observations of a capture, of a queued one, and of lost ones.
  std::uint64_t captured = 0;
  std::uint64_t queued = 0;
  std::uint64_t lost = 0;
  // Requests made in disturb() and starved().
  std::uint64_t holds = 0;
  std::uint64_t overrides = 0;
  // Runs sections until `commands` commands were tried; after each, one in `calm` is disturbed.
  void run(std::uint64_t commands, std::uint64_t calm);
  // One action of a host: a setting, a read, a hold, a START, an abort, a reset ...
  void disturb();
  // START with values at and beyond every limit.
  void start();
  void settings();
  // Restores a quiet state: no hold, full ratio, no fault, nothing queued; in any order.
  void recover();
  void reset(std::uint64_t clocks);
  bool wait_idle(std::uint64_t clocks);
  std::uint32_t status() { return host_.read(reg::kStatus).value_or(0); }

 private:
  std::uint64_t below(std::uint64_t count) { return host_.below(count); }
  bool one_in(std::uint64_t count) { return below(count) == 0; }
  // A number of up to `bits` bits, with all lengths equally likely; sometimes next to a power of two.
  std::uint64_t odd_number(unsigned bits) {
    const std::uint64_t power = std::uint64_t{1} << below(bits);
    if (one_in(3)) return power - 1 + below(3);
    return below(2 * power);
  }
  void corrupt(std::vector<std::uint32_t>& words) {
    std::uint32_t& word = words[below(words.size())];
    word ^= std::uint32_t{1} << below(32);
    if (one_in(4)) word = static_cast<std::uint32_t>(odd_number(32));
    if (one_in(6)) words.resize(1 + below(words.size()));
  }
  driver::Command beside_a_path() {
    if (pwm && one_in(2)) {
      driver::PwmCommand command{static_cast<std::uint8_t>(below(2)), static_cast<std::uint16_t>(below(0x10000)),
                                 one_in(2), static_cast<std::uint8_t>(below(4)),
                                 static_cast<std::uint16_t>(below(0x10000))};
      return command;
    }
    if (one_in(2)) return driver::MarkCommand{};
    return driver::OutputCommand{static_cast<std::uint16_t>(below(0x10000)),
                                 static_cast<std::uint16_t>(below(0x10000))};
  }
  static constexpr std::uint32_t kRatios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
  std::uint32_t any_ratio() { return kRatios[below(3)]; }
  void flip_a_pin() { host_.set_pins(host_.pins() ^ 1U << below(4)); }
  // Starts or ends a hold.
  void hold() {
    const auto wanted = static_cast<std::uint32_t>(below(2));
    holds += wanted;
    host_.write(reg::kHold, wanted);
  }
  void set_ratio(std::uint32_t address, std::uint32_t ratio) {
    ++overrides;
    host_.write(address, ratio);
  }
  std::uint32_t any_address();
  void read_anything();
  void write_anything();

  // Counts the causes since the last call.
  void note_causes() {
    const std::uint32_t fault = host_.card().model().outputs().fault;
    for (unsigned bit = 0; bit < causes.size(); ++bit) causes[bit] += (fault & ~noted_) >> bit & 1U;
    noted_ = fault;
  }
  // Also clears most faults, so that the card moves in the next section.
  void look_at_inputs() {
    note_causes();
    enabled += (status() & (field::kStatusEnabled | field::kStatusEnableWaits)) != 0 ? 1U : 0U;
    button_holds += (status() & field::kStatusButtonHold) != 0 ? 1U : 0U;
    host_.read(one_in(2) ? reg::kLimitState : one_in(2) ? reg::kRoles : reg::kRawInputs);
    const std::uint32_t fault = host_.read(reg::kFault).value_or(0);
    if (fault == 0 || one_in(3)) return;
    host_.write(reg::kFault, fault);
    note_causes();
    abort();
  }
  void select_capture();
  void look_at_captures();
  void look_at_queue();
  void set_soft_limits(unsigned axis);
  void write_role(std::uint32_t address, std::uint32_t inputs) {
    host_.write(address, inputs);
    roles_given_.push_back(address);
  }

  AxiHost& host_;
  std::vector<std::uint32_t> roles_given_;  // addresses of ROLE registers that were written
  std::uint32_t noted_ = 0;                 // FAULT at the last observation
  unsigned axes_;
  unsigned arc_every_;
  std::uint8_t number_ = 0;
};

inline void Traffic::machine_inputs() {
  for (std::uint64_t n = 2 + below(6); n != 0; --n) {
    constexpr std::uint32_t kKinds[] = {0, 0, 0, 1, 1, 1, 4};
    const auto of_axis = static_cast<std::uint32_t>(8 * kKinds[below(7)] + below(axes_));
    // Probe, tool setter, and rarely the buttons.
    const auto of_card = static_cast<std::uint32_t>(48 + (one_in(6) ? 2 + below(2) : below(2)));
    const auto any = static_cast<std::uint32_t>(below(64));
    const std::uint32_t role = one_in(20) ? any : one_in(2) ? of_card : of_axis;
    write_role(reg::role(role), std::uint32_t{1} << (4 + below(12)));
  }
  while (one_in(2))
    host_.write(reg::input_filter(static_cast<std::uint32_t>(below(16))), static_cast<std::uint32_t>(below(6)));
  for (std::uint64_t n = below(3); n != 0; --n) select_capture();
  const auto axis = static_cast<unsigned>(below(axes_));
  // The probe and the tool setter are mostly causes; any-step limits and shared switches rarely.
  const std::uint64_t counts = one_in(4) ? below(4) : 3;
  if (one_in(2))
    host_.write(reg::kStopCauses, static_cast<std::uint32_t>((below(1U << 16) & below(1U << 16)) | counts << 17));
  if (one_in(2)) host_.write(reg::overtravel(axis), static_cast<std::uint32_t>(below(20)));
  if (one_in(2)) host_.write(reg::kStopReaction, static_cast<std::uint32_t>(below(1U << 19) & 0x77C00));
  if (one_in(2)) host_.write(reg::kOutputSafeCause, static_cast<std::uint32_t>(odd_number(32)));
  if (one_in(2)) set_soft_limits(axis);
  if (one_in(3)) host_.set_pins(host_.pins() & 0xF);
}

// Selects an input that changes. Cards without captures refuse it.
inline void Traffic::select_capture() {
  const std::uint64_t edges = one_in(10) ? 0 : (1 + below(3)) << 8;
  std::uint32_t continuous = one_in(2) ? field::kCaptureSelectContinuous : 0;
  const std::uint32_t queue = one_in(2) ? field::kCaptureSelectQueue : 0;
  if (queue != 0) continuous = field::kCaptureSelectContinuous;  // otherwise no queue would become full
  host_.write(reg::capture_select(static_cast<std::uint32_t>(below(4))),
              static_cast<std::uint32_t>(below(16) | edges) | continuous | queue);
}

inline void Traffic::look_at_captures() {
  const std::uint32_t state = host_.read(reg::kCaptureState).value_or(0);
  captured += (state & field::kCaptureStateValid) != 0 ? 1U : 0U;
  const auto area = static_cast<std::uint32_t>(card_map::Area::Capture0) + 0x40 * static_cast<std::uint32_t>(below(4));
  for (std::uint32_t word = 0; word < 8 + axes_; ++word) host_.read(area + 4 * word);
  if (one_in(2)) host_.write(reg::kCaptureClear, static_cast<std::uint32_t>(below(16)));
  if (one_in(2)) look_at_queue();
}

// Cards without the queue refuse all of it. Sometimes the wrong capture is dropped.
inline void Traffic::look_at_queue() {
  for (std::uint64_t n = one_in(4) ? 20 : below(3); n != 0; --n) {
    const std::uint32_t queue = host_.read(reg::kCaptureQueue).value_or(0);
    queued += (queue & field::kCaptureQueueCaptures) != 0 ? 1U : 0U;
    lost += (queue & field::kCaptureQueueLost) != 0 ? 1U : 0U;
    for (std::uint32_t word = 0; word < 8 + axes_; ++word) {
      if (one_in(4)) host_.read(reg::kCaptureHeadFault + 4 * word);
    }
    const std::uint32_t oldest = (queue & field::kCaptureQueueOldest) >> field::kCaptureQueueOldestShift;
    host_.write(reg::kCaptureNext, one_in(10) ? static_cast<std::uint32_t>(below(16)) : oldest);
  }
}

// Near the axis's position.
inline void Traffic::set_soft_limits(unsigned axis) {
  host_.write(reg::kControl, field::kControlSnapshot);
  const std::uint32_t here = host_.read(reg::snap_position(axis)).value_or(0);
  host_.write(reg::soft_minus(axis), here - static_cast<std::uint32_t>(below(one_in(2) ? 10 : 200)));
  host_.write(reg::soft_plus(axis), here + static_cast<std::uint32_t>(below(one_in(2) ? 10 : 200)));
  host_.write(reg::kSoftLimits, static_cast<std::uint32_t>(one_in(3) ? below(256) : 1U << axis));
}

inline void Traffic::drives() {
  const auto few = [this] { return static_cast<std::uint32_t>(one_in(3) ? below(3) : 0); };
  host_.write(reg::kOutputRoles, static_cast<std::uint32_t>(odd_number(32)));
  if (one_in(2)) host_.write(reg::kHealthRoles, static_cast<std::uint32_t>(odd_number(32)));
  for (const std::uint32_t delay : {reg::kEnableDelay, reg::kBrakeReleaseDelay, reg::kStopDelay, reg::kBrakeSetDelay}) {
    if (one_in(2)) host_.write(delay, few());
  }
  if (one_in(3)) host_.write(reg::kDisableCauses, static_cast<std::uint32_t>(below(1U << 19) & below(1U << 19)));
  if (one_in(3)) host_.write(reg::kHealthCauses, static_cast<std::uint32_t>(below(1U << 19) & below(1U << 19)));
  if (one_in(2)) host_.write(reg::kChargePump, static_cast<std::uint32_t>(below(300)));
  host_.write(reg::kEnable, static_cast<std::uint32_t>(one_in(4) ? below(4) : below(2)));
  host_.write(reg::kEnableAxes, static_cast<std::uint32_t>(one_in(3) ? 0 : below(256)));
}

inline void Traffic::settings() {
  const auto time = [this] { return static_cast<std::uint32_t>(one_in(12) ? odd_number(16) & 0xFFFF : below(5)); };
  for (unsigned n = 0; n < axes_; ++n) {
    if (one_in(2)) host_.write(reg::step_length(n), time());
    if (one_in(2)) host_.write(reg::step_space(n), time());
    if (one_in(2)) host_.write(reg::dir_setup(n), time());
    if (one_in(2)) host_.write(reg::dir_hold(n), time());
    if (one_in(2)) host_.write(reg::mode(n), static_cast<std::uint32_t>(below(16)));
  }
  if (one_in(2)) host_.write(reg::kHoldLimit, static_cast<std::uint32_t>(one_in(2) ? 1 + below(300) : 0xFFFF));
  if (one_in(2)) host_.write(reg::kIrqEnable, static_cast<std::uint32_t>(below(1U << 18)));
  if (one_in(2))
    host_.write(reg::kGeometryWatermark, static_cast<std::uint32_t>(one_in(4) ? odd_number(16) & 0xFFFF : below(300)));
  if (one_in(2))
    host_.write(reg::kFeedWatermark, static_cast<std::uint32_t>(one_in(4) ? odd_number(16) & 0xFFFF : below(200)));
  if (one_in(2)) host_.write(reg::kStopReaction, static_cast<std::uint32_t>(below(256) | below(2) << 10));
  if (!pwm) return;
  if (one_in(2))
    host_.write(one_in(2) ? reg::kPwmPeriod0 : reg::kPwmPeriod1, static_cast<std::uint32_t>(99 + below(900)));
  if (one_in(2)) host_.write(reg::kPwmOutputs, static_cast<std::uint32_t>(below(16) << 16 | below(16)));
}

inline void Traffic::start() {
  constexpr std::uint64_t kWhole = std::uint64_t{1} << 40;
  for (unsigned n = 0; n < axes_; ++n) {
    std::uint64_t frequency = kWhole / (1 + below(60));
    if (one_in(8)) frequency = std::uint64_t{1} << (30 + below(11));
    if (one_in(10)) frequency = kWhole - 1 + below(3);
    if (one_in(10)) frequency = below(0x1FF) << 32;  // low word 0
    if (one_in(10)) frequency = 0;
    host_.write(reg::frequency_lo(n), static_cast<std::uint32_t>(frequency));
    host_.write(reg::frequency_hi(n), static_cast<std::uint32_t>(frequency >> 32));
    host_.write(reg::count(n), static_cast<std::uint32_t>(one_in(6) ? 0 : one_in(8) ? odd_number(20) : below(40)));
    host_.write(reg::direction(n), static_cast<std::uint32_t>(below(2)));
  }
  host_.write(reg::kLengthLo, static_cast<std::uint32_t>(one_in(6) ? 0 : one_in(8) ? odd_number(12) : below(600)));
  host_.write(reg::kLengthHi, 0);
  std::uint32_t mask = static_cast<std::uint32_t>(below(1U << axes_));
  if (one_in(8)) mask = static_cast<std::uint32_t>(below(256));
  host_.write(reg::kStart, mask);
  if (one_in(3)) host_.wait(below(900));
}

// Mostly the address of a register.
inline std::uint32_t Traffic::any_address() {
  if (one_in(8)) return static_cast<std::uint32_t>(below(card_map::kWindowBytes));
  const card_map::Register& entry = card_map::kRegisters[below(card_map::kRegisters.size())];
  return card_map::slot_address(entry, static_cast<std::uint32_t>(below(entry.count)));
}

inline void Traffic::read_anything() {
  const std::uint32_t address = any_address();
  if (one_in(2)) {
    host_.read(address);
  } else {
    host_.write_beside_read({reg::kControl, field::kControlSnapshot}, address);
  }
}

inline void Traffic::write_anything() {
  const std::uint32_t address = any_address();
  const auto strobes = static_cast<std::uint8_t>(one_in(3) ? below(16) : 0xF);
  host_.write(address, static_cast<std::uint32_t>(odd_number(32)), strobes);
  if (address >= reg::role(0) && address <= reg::role(63)) roles_given_.push_back(address);
}

inline void Traffic::disturb() {
  note_causes();
  if (one_in(3)) host_.set_pins(static_cast<std::uint32_t>(below(0x10000)));
  if (roles && one_in(3)) host_.set_pins(host_.pins() ^ std::uint32_t{1} << (4 + below(12)));
  if (emergency && one_in(20)) host_.press_emergency_stop(one_in(2));
  if (roles && one_in(4)) host_.write(reg::kLimitOverride, static_cast<std::uint32_t>(below(0x10000)));
  if (roles && one_in(4)) host_.read(one_in(2) ? reg::kRoles : reg::kRawInputs);
  switch (below(16)) {
    case 0:
      hold();
      break;
    case 1:
      set_ratio(any_ratio(), static_cast<std::uint32_t>(one_in(8) ? below(3) : 0x4000 + below(0xC001)));
      break;
    case 2:
      host_.write(reg::kSlew, static_cast<std::uint32_t>(1 + odd_number(28)));
      break;
    case 3:
      start();
      break;
    case 4:
      settings();
      break;
    case 5:
      host_.write(reg::kFault, static_cast<std::uint32_t>(below(1U << 19)));
      break;
    case 6:
      host_.write(reg::kRefusal, static_cast<std::uint32_t>(below(2)));
      break;
    case 7:
      abort();
      break;
    case 8:
      write_anything();
      break;
    case 9:
      host_.set_delays(static_cast<unsigned>(one_in(2) ? 0 : below(7)));
      break;
    case 10:
      recover();
      break;
    case 11:
      if (one_in(6)) reset(1 + below(5));
      break;
    default:
      read_anything();
      break;
  }
}

inline void Traffic::recover() {
  note_causes();
  host_.press_emergency_stop(false);
  if (enables) {
    host_.write(reg::kEnable, 0);
    host_.write(reg::kEnableAxes, 0);
  }
  const auto calm = [this] {
    host_.write(reg::kHold, 0);
    for (const std::uint32_t ratio : kRatios) host_.write(ratio, 0x10000);
    host_.write(reg::kSlew, 0xFFFFFFF);
    if (streams) host_.write(reg::kStreaming, 0);
  };
  if (roles) {
    host_.write(reg::kSoftLimits, 0);
    // Cycle start ends a hold of the button.
    for (const std::uint32_t address : roles_given_) host_.write(address, 0);
    write_role(reg::role(51), 2);
    host_.set_pins(0);
    host_.wait(140);
    host_.set_pins(2);
    host_.wait(140);
    host_.write(reg::role(51), 0);
    roles_given_.clear();
  }
  const bool calm_first = one_in(2);
  if (calm_first) calm();
  const bool abort_first = one_in(2);
  if (abort_first) abort();
  host_.wait(below(60));
  host_.write(reg::kFault, 0x7FFFF);
  host_.wait(below(60));
  if (!abort_first || one_in(3)) abort();
  if (!calm_first) calm();
  host_.write(reg::kRefusal, 1);
}

inline void Traffic::reset(std::uint64_t clocks) {
  host_.reset(clocks);
  number_ = 0;
}

inline bool Traffic::wait_idle(std::uint64_t clocks) {
  for (std::uint64_t waited = 0; waited <= clocks; waited += 50) {
    if ((status() & field::kStatusBusy) == 0) return true;
    host_.wait(50);
  }
  return false;
}

inline void Traffic::run(std::uint64_t sections, std::uint64_t calm) {
  for (; sections != 0; --sections) {
    if (roles && one_in(2)) machine_inputs();
    if (enables && one_in(3)) drives();
    if (one_in(5))
      starved();
    else if (streams && one_in(4))
      streamed();
    else if (commands_every != 0 && one_in(2))
      probing();
    else
      section(one_in(4));
    host_.wait(below(one_in(4) ? 6000 : 600));
    if (roles) look_at_inputs();
    if (roles && one_in(2)) look_at_captures();
    while (one_in(calm)) disturb();
    if (one_in(6)) {
      recover();
      settings();
    }
  }
}

}  // namespace trammel::test

#include "traffic_programs.hpp"
