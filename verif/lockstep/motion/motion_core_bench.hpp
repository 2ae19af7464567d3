// The motion core beside its golden model. Drives both with the same words, registers and pins, and compares every
// output in every cycle.
#pragma once

#include <Vdut.h>

#include <array>
#include <memory>
#include <type_traits>
#include <utility>

#include "motion_core_inside.hpp"
#include "programs.hpp"
#include "trammel/model/motion_core.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {

namespace reg = card_map::reg;

constexpr unsigned kAxes = TRAMMEL_AXES;
// The engines that are built in. Missing ones are never used, because checker and registers refuse them.
constexpr bool kArcs = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kAccumulator);
constexpr bool kChords = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kArcGenerator);
constexpr bool kDirectMode = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kDirectMode);
constexpr bool kClasses = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kClasses);
constexpr bool kPathCommands = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kPathCommands);
constexpr bool kStreaming = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kStreaming);
constexpr bool kSoftLimits = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kSoftLimits);
constexpr bool kMachineInputs = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kMachineInputs);
constexpr bool kEnables = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kEnables);
constexpr bool kEmergencyStop = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kEmergencyStop);
constexpr bool kPwm = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kPwm);
constexpr unsigned kOutputs = 3;
constexpr std::uint64_t kComparedSignals = 45 + kAxes;
using IdleLevel = std::remove_reference_t<decltype(Vdut::idle_level_i)>;
constexpr std::uint32_t kAllAxes = (1U << kAxes) - 1;

// The registers of direct mode as the loader reads them: the word at an address, two clocks late.
class LoaderRam {
 public:
  void clock(std::uint16_t address) {
    data_ = fetched_;
    fetched_ = words_[address];
  }
  std::uint32_t data() const { return data_; }
  void write(std::uint32_t address, std::uint32_t data) { words_[address >> 2] = data; }

 private:
  std::array<std::uint32_t, card_map::kWindowBytes / 4> words_{};
  std::uint32_t fetched_ = 0;
  std::uint32_t data_ = 0;
};

class MotionCoreBench {
 public:
  explicit MotionCoreBench(std::uint64_t seed)
      : check_("motion_core", seed),
        dice_(seed),
        place_dice_(seed),
        raw_dice_(seed + 1),
        programs_(kAxes, dice_),
        geometry_(1024),
        feed_(1024) {
    programs_.arcs = kArcs;
    programs_.eight_directions = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kAccumulator8);
    programs_.chords = kChords;
    programs_.path_commands = kPathCommands;
    programs_.probes = kPathCommands;
    programs_.pwm_every = kPwm ? 4 : 0;
    programs_.inputs = 32;
    programs_.classes = kClasses;
    reset();
  }

  void random_clock() {
    if (dice_.chance(10'000)) random_pace();
    const bool closed = model_->stop().closed;
    if (!closed && !starting_ && geometry_.done() && dice_.chance(stretch_every_)) {
      const Programs::Stretch stretch = programs_.stretch();
      check_.event("stretch of commands", stretch.geometry.size());
      geometry_.add(stretch.geometry);
      feed_.add(stretch.feed);
    }
    in_ = {};
    in_.abort = dice_.chance(abort_every_);
    if (dice_.chance(50)) levels_ = dice_.draw();
    in_.levels = kPathCommands ? levels_ : 0;
    in_.raw = in_.levels ^ (raw_dice_.draw() & raw_dice_.draw() & raw_dice_.draw());
    in_.quiet = raw_dice_.draw();
    if (kMachineInputs && dice_.chance(inputs_every_)) random_role();
    if (kMachineInputs && model_->probe().busy() && dice_.chance(40)) roles_.probe = !roles_.probe;
    in_.roles = roles_;
    random_emergency();
    in_.probe_clear = kPathCommands && dice_.chance(50);
    if (in_.abort) check_.event("abort");
    if (model_->stop().fault != 0 ? dice_.chance(40) : dice_.chance(5000)) {
      in_.clear_fault = dice_.chance(3) ? dice_.draw() : ~0U;
      check_.event("clear fault", in_.clear_fault);
    }
    if (dice_.chance(200)) random_setting();
    if (!in_.setting.set && place_dice_.chance(1000)) random_place();
    if (place_dice_.chance(in_.link_lost ? 20 : 10'000)) in_.link_lost = !in_.link_lost;
    if (place_dice_.chance(in_.session_gone ? 300 : 3000)) in_.session_gone = !in_.session_gone;
    if (kSoftLimits && !in_.setting.set && place_dice_.chance(400)) random_soft_limit();
    if (kPwm && !in_.setting.set && place_dice_.chance(2000)) random_pwm();
    if (dice_.chance(3000)) marks_near_a_carry();
    // While a START is answered no word is written, so that the queues contain only what START finds.
    if (kDirectMode && !starting_ && geometry_.done() && feed_.done() && dice_.chance(start_every_)) random_start();
    if (dice_.chance(50 * abort_every_))
      reset();
    else
      clock();
  }

  // OUTPUT and MARK wait for the end of paths of every length around their decoding. An abort and a reset come in
  // every clock of the commands, of their effect, and of later decoding.
  void commands_around_ends() {
    for (unsigned ticks = 1; ticks < 60; ++ticks) {
      commands_behind(ticks, 100, Programs::mark());
      commands_behind(ticks, 100, programs_.output());
    }
    for (const unsigned ticks : {1U, 20U}) {
      for (unsigned clocks = 0; clocks < 80; ++clocks) {
        commands_behind(ticks, clocks, Programs::mark());
        in_.abort = true;
        clock();
        in_.abort = false;
        commands_alone();
        commands_behind(ticks, clocks, Programs::mark());
        reset();
        commands_alone();
      }
    }
  }

  // During the ramp of a stop a MARK takes effect, after an OUTPUT that switched an output off. An output that the
  // cause switched on stays on, although OUTPUT_SAFE_CAUSE no longer names it.
  void mark_behind_a_cause() {
    reset();
    in_ = {};
    write_every_ = 1;
    for (const auto& [address, data] : {std::pair{reg::kSlew, 0x1000U}, std::pair{reg::kOutputSafeCause, 0x10001U}}) {
      in_.setting = {true, address, data};
      clock();
    }
    in_.setting = {};
    geometry_.add({stored_command(card_map::Opcode::Output, 0, 0, {{"clear", 1}}),
                   stored_command(card_map::Opcode::Line, 1, 200, {}, {kOnePulse / 16}), Programs::mark(),
                   stored_command(card_map::Opcode::Line, 1, 2000, {}, {kOnePulse / 16})});
    feed_.add({stored_command(card_map::Opcode::Feed, 0, 2200, {{"rate", int128{~std::uint64_t{0}}}, {"floor", 1}})});
    for (unsigned i = 0; i < 600; ++i) {
      in_.link_lost = i >= 150;
      in_.setting = {i == 160, reg::kOutputSafeCause, 0};
      clock();
    }
    reset();
    in_ = {};
  }

  // A probe's edge at each clock around the start of PROBE_END, with a line after it; cleared at once or late.
  void edges_around_the_end() {
    for (const unsigned ticks : {0U, 3U}) {
      for (unsigned edge = 0; edge < 110; ++edge) {
        for (const unsigned clear : {0U, 40U}) {
          probe_to_the_end(ticks);
          for (unsigned i = 0; i < 220; ++i) {
            in_.levels = i < edge ? 0 : 1;
            in_.probe_clear = i == edge + clear;
            clock();
          }
        }
      }
    }
    in_ = {};
  }

  // STREAMING is switched on at each clock around the one in which the first command ends the card's rest.
  void streaming_set_around_the_begin() {
    for (unsigned clocks = 0; clocks < 40; ++clocks) {
      reset();
      in_ = {};
      write_every_ = 1;
      geometry_.add({stored_command(card_map::Opcode::Line, 1, 20, {}, {kOnePulse / 2})});
      feed_.add({stored_command(card_map::Opcode::Feed, 0, 20, {{"rate", int128{1} << 63}, {"floor", 1}})});
      for (unsigned i = 0; i < 200; ++i) {
        in_.setting = {i == clocks, reg::kStreaming, card_map::field::kStreamingOn | 200U << 8};
        clock();
      }
    }
    in_ = {};
  }

  // The emergency stop disables the drives in motion, at a tick in every clock, although its reaction is a ramp:
  // ticks that are owed stay owed.
  void drives_disabled_in_motion() {
    for (unsigned at = 0; at < 40; ++at) {
      reset();
      in_ = {};
      write_every_ = 1;
      for (const auto& [address, data] : {std::pair{reg::kStopReaction, card_map::field::kStopReactionEmergencyStop},
                                          std::pair{reg::kSlew, 0x1000U}, std::pair{reg::kEnableAxes, 0xFFU}}) {
        in_.setting = {true, address, data};
        clock();
      }
      in_.setting = {};
      geometry_.add({stored_command(card_map::Opcode::Line, 1, 4000, {}, {kOnePulse / 16})});
      feed_.add({stored_command(card_map::Opcode::Feed, 0, 4000, {{"rate", int128{~std::uint64_t{0}}}, {"floor", 1}})});
      for (unsigned i = 0; i < 300; ++i) {
        in_.emergency = i == 160 + at;
        clock();
      }
    }
    reset();
    in_ = {};
  }

  // If the duty follows the speed, there are no pulses while a path waits for its drives, at any rate of its piece.
  void pulses_while_drives_wait() {
    reset();
    in_ = {};
    write_every_ = 1;
    for (const auto& [address, data] :
         {std::pair{reg::kEnableAxes, 0xFFU}, std::pair{reg::kEnable, card_map::field::kEnableManual},
          std::pair{reg::kPwmPeriod0, 100U}, std::pair{reg::kPwmOutputs, 1U}}) {
      in_.setting = {true, address, data};
      clock();
    }
    in_.setting = {};
    geometry_.add(
        {stored_command(card_map::Opcode::Output, 0, 0, {{"set", ~output_idle_ & 0xFFFF}, {"clear", output_idle_}}),
         stored_command(card_map::Opcode::Pwm, 0, 0, {{"select", 0x10}, {"duty", 0xFFFF}, {"gain", 0xFFFF}}),
         stored_command(card_map::Opcode::Line, 1, 4000, {}, {kOnePulse / 16})});
    feed_.add({stored_command(card_map::Opcode::Feed, 0, 4000, {{"rate", int128{1} << 63}, {"floor", 1}})});
    for (unsigned i = 0; i < 3000; ++i) {
      in_.setting = {i == 2000, reg::kEnable, card_map::field::kEnableManual | card_map::field::kEnableOn};
      clock();
    }
    reset();
    in_ = {};
  }

  // A HOLD around the start of a fixed piece whose path comes later takes effect at once.
  void holds_before_the_path() {
    for (unsigned clocks = 0; clocks < 90; clocks += 3) {
      reset();
      in_ = {};
      write_every_ = 1;
      feed_.add({stored_command(card_map::Opcode::Feed, card_map::constant::kClassFixed, 20,
                                {{"rate", int128{1} << 63}, {"floor", 1}})});
      for (unsigned i = 0; i < 220; ++i) {
        if (i == 100) geometry_.add({stored_command(card_map::Opcode::Line, 1, 20, {}, {kOnePulse / 2})});
        in_.setting = {i == clocks, reg::kHold, 1};
        clock();
      }
    }
    reset();
    in_ = {};
  }

  Checker& check() { return check_; }
  std::uint64_t steps() const { return steps_; }
  std::uint64_t moves() const { return moves_; }
  std::uint64_t faults() const { return faults_; }
  std::uint64_t limits() const { return limits_; }
  std::uint64_t soft_limits() const { return soft_limits_; }
  std::uint64_t lost_places() const { return lost_places_; }
  std::uint64_t waits() const { return waits_; }  // clocks in which motion waits for the drives
  std::uint64_t beyond() const { return beyond_; }
  std::uint64_t marks() const { return marks_; }
  std::uint64_t missing() const { return missing_; }
  std::uint64_t stale() const { return stale_; }
  std::uint64_t halts() const { return halts_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  void commands_behind(unsigned ticks, unsigned clocks, const Halfwords& second) {
    reset();
    in_ = {};
    write_every_ = 1;
    geometry_.add({stored_command(card_map::Opcode::Line, 1, ticks, {}, {kOnePulse / 2}), programs_.output(), second,
                   programs_.output(), Programs::mark()});
    feed_.add({stored_command(card_map::Opcode::Feed, 0, ticks, {{"rate", int128{~std::uint64_t{0}}}, {"floor", 1}})});
    for (unsigned i = 0; i < clocks; ++i) clock();
  }

  void probe_to_the_end(unsigned ticks) {
    reset();
    in_ = {};
    write_every_ = 1;
    const auto line = [](unsigned n) { return stored_command(card_map::Opcode::Line, 1, n, {}, {kOnePulse / 2}); };
    const auto piece = [](unsigned n) {
      return stored_command(card_map::Opcode::Feed, 0, n, {{"rate", int128{~std::uint64_t{0}}}, {"floor", 1}});
    };
    const Halfwords probe = stored_command(card_map::Opcode::Probe, 0, 0, {{"condition", 0x20}});
    geometry_.add({probe});
    if (ticks != 0) geometry_.add({line(ticks)});
    if (ticks != 0) feed_.add({piece(ticks)});
    geometry_.add({Programs::probe_end(), line(20)});
    feed_.add({Programs::probe_end(), piece(20)});
  }

  void commands_alone() {
    for (unsigned i = 0; i < 4; ++i) clock();
    geometry_.add({Programs::mark(), programs_.output()});
    for (unsigned i = 0; i < 40; ++i) clock();
  }

  // Makes the RTL count more MARKs than the model.
  void marks_near_a_carry() {
    if constexpr (kPathCommands) {
      const auto marks = static_cast<std::uint32_t>(dice_.before_carry(32));
      const std::uint32_t more = marks - model_->commands().marks() - marks_ahead_;
      marks_ahead_ += more;
      add_marks(*dut_, more);
    }
  }

  void random_pace() {
    abort_every_ = dice_.chance(3) ? 200 + dice_.below(500) : 20'000;
    start_every_ = dice_.chance(2) ? 100 : 2000;
    write_every_ = 1 + dice_.below(dice_.chance(2) ? 1 : 10);
    stretch_every_ = dice_.chance(3) ? 1000 : 10;
    programs_.wrong_every = dice_.chance(3) ? 10 : 1000;
    programs_.longest = dice_.chance(2) ? 20 : 300;
    // Slow drives cause step faults; mostly they are quick.
    slow_ = dice_.chance(4);
    // Mostly rare input changes, so that the programs run; sometimes frequent ones.
    inputs_every_ = dice_.chance(3) ? 100 : 20'000;
  }

  // The emergency stop's cause, and its latch, which changes only outputs; from the second random generator.
  void random_emergency() {
    const bool was = emergency_;
    if (kEmergencyStop && place_dice_.chance(emergency_ ? 20 : 100'000)) emergency_ = !emergency_;
    if (kEmergencyStop && place_dice_.chance(latched_ ? 30 : 3000)) latched_ = !latched_;
    if (emergency_ && !was) check_.event("emergency stop");
    in_.emergency = emergency_;
  }

  // Changes one role; no role stays active for long.
  void random_role() {
    const auto axis = static_cast<std::uint8_t>(1U << dice_.below(kAxes));
    const auto turn = [&](std::uint8_t& mask) { mask = mask != 0 ? std::uint8_t{0} : axis; };
    const auto turn_one = [](bool& level) { level = !level; };
    switch (dice_.below(10)) {
      case 0:
        turn(roles_.drive_fault);
        break;
      case 1:
        turn_one(roles_.feed_hold);
        break;
      case 2:
      case 3:
        turn_one(roles_.cycle_start);
        break;
      case 4:
        turn_one(roles_.tool_setter);
        break;
      case 5:
        turn_one(roles_.probe);
        break;
      case 6:
        roles_ = {};
        break;
      case 7:
        turn(roles_.limit_minus);
        roles_.limit_plus = roles_.limit_minus;
        break;
      default:
        turn(dice_.chance(2) ? roles_.limit_minus : roles_.limit_plus);
        break;
    }
    check_.event("roles", roles_wire(roles_));
  }

  void random_setting() {
    const unsigned axis = dice_.below(kAxes);
    const std::uint32_t time = slow_ ? dice_.below(100) : dice_.below(1U << dice_.below(4));
    constexpr std::uint32_t ratios[] = {reg::kRatioFeed, reg::kRatioRapid, reg::kRatioFixed};
    const std::pair<std::uint32_t, std::uint32_t> settings[] = {
        {reg::step_length(axis), time},
        {reg::step_space(axis), time},
        {reg::dir_setup(axis), time},
        {reg::dir_hold(axis), time},
        {reg::mode(axis), dice_.below(16)},
        {reg::kHoldLimit, 1 + dice_.below(dice_.chance(2) ? 300 : 0xFFFF)},
        {reg::kHold, dice_.chance(8) ? 1U : 0U},
        {kClasses ? ratios[dice_.below(3)] : reg::kRatioFeed,
         !dice_.chance(4) ? 0x10000 : static_cast<std::uint32_t>(dice_.log_uniform(16))},
        {reg::kSlew, !dice_.chance(4) ? 0xFFF'FFFF : 1 + static_cast<std::uint32_t>(dice_.log_uniform(27))},
        {reg::kStopReaction, dice_.chance(2) ? 0x7ECFF : dice_.below(256) | (dice_.draw() & 0x7AC00)},
        {kMachineInputs ? reg::kStopCauses : reg::kHoldLimit,
         kMachineInputs ? dice_.draw() & dice_.draw() & 0x6FFFF : 9},
        {kMachineInputs ? reg::kLimitOverride : reg::kHoldLimit, kMachineInputs ? dice_.draw() & 0xFFFF : 11},
        {kMachineInputs ? reg::overtravel(axis) : reg::kHoldLimit, dice_.below(20) + 1},
        {kStreaming ? reg::kStreaming : reg::kHoldLimit, kStreaming ? dice_.below(2) | dice_.below(4) << 8 : 7},
        {reg::kInputPolarity, kPathCommands ? dice_.draw() & 0xFFFF : 0},
        {reg::kOutputSafe, kPathCommands ? dice_.draw() : 0}};
    const auto& [address, data] = settings[dice_.below(std::size(settings))];
    in_.setting = {!dice_.chance(4), address, data};
    if (in_.setting.set) check_.event("setting", std::uint64_t{address} << 32 | data);
  }

  // Pulses short enough for the length of a path.
  void random_pwm() {
    const bool outputs = place_dice_.chance(3);
    in_.setting = {true,
                   outputs                 ? reg::kPwmOutputs
                   : place_dice_.chance(2) ? reg::kPwmPeriod0
                                           : reg::kPwmPeriod1,
                   outputs ? place_dice_.draw() & 0x00070007 : 100 + place_dice_.below(1000)};
    check_.event("setting", std::uint64_t{in_.setting.address} << 32 | in_.setting.data);
  }

  // Lost places are soon set again. They change no motion and use a random generator of their own, so that the
  // programs do not depend on them.
  void random_place() {
    Dice& dice = place_dice_;
    const bool keeps = dice.chance(8);
    const std::uint32_t axes = dice.draw() & 0xFF;
    const std::uint32_t place = dice.below(4) | axes << card_map::field::kSetPlaceAxesShift;
    in_.setting = {true, keeps ? reg::kKeepsPlace : reg::kSetPlace, keeps ? axes & dice.draw() : place};
    if (kPathCommands && dice.chance(3)) in_.setting = {true, reg::kOutputSafeCause, dice.draw()};
    if (kEnables && dice.chance(2)) in_.setting = enable_setting(dice);
    check_.event("setting", std::uint64_t{in_.setting.address} << 32 | in_.setting.data);
  }

  // Near the axis's position; mostly switched off again, so that programs continue.
  void random_soft_limit() {
    Dice& dice = place_dice_;
    const unsigned axis = dice.below(kAxes);
    const std::uint32_t here = model_->position(axis);
    const std::pair<std::uint32_t, std::uint32_t> settings[] = {{reg::soft_minus(axis), here - dice.below(20)},
                                                                {reg::soft_plus(axis), here + dice.below(20)},
                                                                {reg::kSoftLimits, dice.draw() & 0xFF},
                                                                {reg::kSoftLimits, 0},
                                                                {reg::kSoftLimits, 0}};
    const auto& [address, data] = settings[dice.below(std::size(settings))];
    in_.setting = {true, address, data};
    check_.event("setting", std::uint64_t{address} << 32 | data);
  }

  // A unit of a delay is some thousand clocks: delays are mostly 0, and enable sequences are rare.
  static model::Setting enable_setting(Dice& dice) {
    switch (dice.below(8)) {
      case 0:
        return {true, reg::kOutputRoles, dice.draw() & dice.draw()};
      case 1:
        return {true, reg::kHealthRoles, dice.draw() & dice.draw()};
      case 2:
        return {true, reg::kEnable, dice.below(4) & dice.below(4)};
      case 3:
        return {true, reg::kEnableAxes, !dice.chance(4) ? 0 : dice.draw() & 0xFF};
      case 4:
        return {true, dice.chance(2) ? reg::kBrakeReleaseDelay : reg::kStopDelay, dice.chance(6) ? 1U : 0U};
      case 5:
        return {true, reg::kDisableCauses, dice.draw() & dice.draw() & 0x7FFFF};
      case 6:
        return {true, reg::kHealthCauses, dice.draw() & dice.draw() & 0x7FFFF};
      default:
        return {true, reg::kChargePump, dice.below(2000)};
    }
  }

  // Mostly a possible move; otherwise one value is wrong.
  void random_start() {
    for (unsigned axis = 0; axis < kAxes; ++axis) {
      std::uint64_t frequency = dice_.log_uniform(40) + 1;
      if (dice_.chance(8)) frequency = std::uint64_t{1} << 40;
      if (dice_.chance(20))
        frequency = dice_.chance(2) ? 0 : (std::uint64_t{1} << 40) + 1 + dice_.below(2) * 0xFFFFFFFF;
      write_register(reg::frequency_lo(axis), static_cast<std::uint32_t>(frequency));
      write_register(reg::frequency_hi(axis), static_cast<std::uint32_t>(frequency >> 32));
      write_register(reg::count(axis), dice_.chance(3) ? dice_.below(4) : dice_.below(100));
      write_register(reg::direction(axis), dice_.below(2));
    }
    write_register(reg::kLengthLo, dice_.chance(20) ? 0 : 1 + dice_.below(200));
    write_register(reg::kLengthHi, dice_.chance(1000) ? 1 : 0);
    starting_ = true;
    in_.start = true;
    mask_ = dice_.chance(10) ? dice_.draw() : 1 + dice_.below(kAllAxes);
    check_.event("START", mask_ & 0xFF);
  }

  void write_register(std::uint32_t address, std::uint32_t data) {
    rtl_ram_.write(address, data);
    model_ram_.write(address, data);
  }

  // One clock of reset, with random other inputs; the pins have the levels of the strap.
  void reset() {
    idle_level_ = dice_.draw() & ((1U << 2 * kAxes) - 1);
    output_idle_ = static_cast<std::uint16_t>(dice_.below(1U << kOutputs));
    check_.event("reset", idle_level_);
    dut_->rst_i = 1;
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    const model::PathCommands::Config pins{kOutputs, output_idle_};
    model_ = std::make_unique<model::MotionCore>(kAxes, idle_level_, TRAMMEL_ENGINES, pins);
    geometry_.reset();
    feed_.reset();
    starting_ = false;
    marks_ahead_ = 0;
    valid_ = 0;
    chain_.fill({});
    compare();
  }

  void clock() {
    // The host waits for START's answer, and the stream is refused while a direct move runs.
    const bool streams = !starting_ && !model_->loader().go && !model_->sequencer().outputs().direct;
    const model::HalfwordQueue::Inputs& geometry = geometry_.offer(streams && dice_.chance(write_every_));
    const model::HalfwordQueue::Inputs& feed = feed_.offer(streams && dice_.chance(write_every_));
    in_.arrival = {false, geometry.commit, geometry.write, feed.commit, feed.write, geometry.word};
    apply();
    advance_chain();
    const bool cut = model_->stop().cut;
    const bool geometry_reads = model_->sequencer().geometry_read();
    const bool feed_reads = model_->sequencer().feed_read();
    const auto rtl_address = static_cast<std::uint16_t>(get(dut_->start_answer_o, bus::start_answer::kAddress));
    const std::uint16_t model_address = model_->loader().address;
    dut_.clock();
    model_->clock(in_);
    rtl_ram_.clock(rtl_address);
    model_ram_.clock(model_address);
    geometry_.clock(geometry_reads, cut);
    feed_.clock(feed_reads, cut);
    compare();
    note_events();
    steps_ += model_->outputs().path_step != 0 ? 1U : 0U;
    marks_ += model_->commands().mark() ? 1U : 0U;
    halts_ += model_->probe().halt() ? 1U : 0U;
    if (model_->probe().halt()) check_.event("halt by the probe");
    moves_ += model_->loader().go ? 1U : 0U;
    faults_ += model_->stop().stop ? 1U : 0U;
    limits_ += model_->state().limits.causes().limit ? 1U : 0U;
    soft_limits_ += model_->state().soft_limits.cause() ? 1U : 0U;
    const std::uint8_t valid = model_->state().place.state().valid;
    lost_places_ += (valid_ & ~valid) != 0 && !in_.setting.set ? 1U : 0U;
    valid_ = valid;
    waits_ += model_->waits_for_drives() && model_->wants_drives() ? 1U : 0U;
    beyond_ += model_->state().limits.causes().beyond ? 1U : 0U;
    missing_ += model_->sequencer().streaming().missing ? 1U : 0U;
    stale_ += model_->sequencer().outputs().stale ? 1U : 0U;
  }

  void note_events() {
    const auto& s = model_->sequencer().outputs();
    if (model_->stop().cut) check_.event("cut, with fault", model_->stop().fault);
    if (s.swap)
      check_.event(s.engine != card_map::engine::kLines ? "arc begins"
                   : s.direct                           ? "direct move begins"
                                                        : "line begins",
                   s.active);
    if (s.feed_swap) check_.event("piece begins");
    if (model_->loader().done) starting_ = false;
  }

  // From the far end: RATIO, RATE, FEED_BEGUN, GEOMETRY_BEGUN, POSITION of each axis; RATIO passes on only 20 bits.
  // REST has the ticks left in the place of RATIO and RATE.
  void advance_chain() {
    const model::Sequencer& sequencer_model = model_->sequencer();
    const auto& sequencer = sequencer_model.outputs();
    for (std::size_t i = chain_.size(); i-- > 0;) {
      const std::uint64_t left = model_->settled() ? sequencer_model.ticks_to_come() : 0;
      const bool rest = get(dut_->snapshot_i, bus::snapshot::kRest) != 0;
      const std::uint32_t values[] = {rest ? static_cast<std::uint32_t>(left >> 32) : model_->time().ratio,
                                      rest ? static_cast<std::uint32_t>(left) : model_->feed().rate,
                                      sequencer.feed_begun, sequencer.geometry_begun};
      const std::uint32_t value = i < 4 ? values[i] : model_->position(static_cast<unsigned>(i - 4));
      if (i == 0)
        chain_[i].clock(dut_->snapshot_i, value);
      else
        chain_[i].clock(dut_->snapshot_i, value, chain_[i - 1]);
    }
  }

  void apply() {
    in_.geometry_empty = geometry_.outputs().empty;
    in_.geometry_word = geometry_.outputs().word;
    in_.feed_empty = feed_.outputs().empty;
    in_.feed_word = feed_.outputs().word;
    in_.start_mask = static_cast<std::uint8_t>(mask_);
    in_.loader_data = model_ram_.data();
    dut_->idle_level_i = static_cast<IdleLevel>(idle_level_);
    dut_->output_idle_i = static_cast<CData>(output_idle_);
    put_inputs(dut_->inputs_i, in_.levels, in_.raw, in_.quiet);
    dut_->setting_i = wire(in_.setting);
    dut_->roles_i = roles_wire(in_.roles);
    dut_->emergency_stop_i = in_.emergency;
    dut_->latched_i = latched_;
    dut_->abort_i = in_.abort;
    dut_->probe_clear_i = in_.probe_clear;
    dut_->clear_fault_i = in_.clear_fault;
    dut_->session_gone_i = in_.session_gone;
    dut_->link_lost_i = in_.link_lost;
    dut_->geometry_empty_i = in_.geometry_empty;
    dut_->geometry_word_i = in_.geometry_word;
    dut_->feed_empty_i = in_.feed_empty;
    dut_->feed_word_i = in_.feed_word;
    dut_->arrival_i = arrival_wire(in_.arrival, in_.full);
    using namespace bus::start;
    dut_->start_i = in_place(kStart, in_.start) | in_place(kMask, in_.start_mask) | in_place(kData, rtl_ram_.data());
    dut_->snapshot_i = dice_.snapshot() & ~bus::in_place({20, 12}, ~std::uint64_t{0});
  }

  std::uint64_t observed(unsigned axis, const bus::Field& field) {
    return get(dut_->observe_o, up(field, bus::axis_observe::kWidth * axis));
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_->outputs();
    const auto& stop = model_->stop();
    check_.compare("geometry_read_o", dut_->geometry_read_o, model_->sequencer().geometry_read());
    check_.compare("feed_read_o", dut_->feed_read_o, model_->sequencer().feed_read());
    const auto answer = [this](const bus::Field& field) { return get(dut_->start_answer_o, field); };
    check_.compare("start, done", answer(bus::start_answer::kDone), model_->loader().done);
    check_.compare("cut_o", dut_->cut_o, stop.cut);
    check_.compare("closed_o", dut_->closed_o, stop.closed);
    check_.compare("stop_o", dut_->stop_o, stop.stop);
    check_.compare("rest_o", dut_->rest_o, model_->rests(in_));
    check_.compare("busy_o", dut_->busy_o, out.busy);
    compare_states();
    compare_axes();
    const auto& commands = model_->commands();
    check_.compare("output_o", dut_->output_o, model_->output_pins(latched_));
    check_.compare("mark_o", dut_->mark_o, commands.mark());
    check_.compare("probe_o", dut_->probe_o, model_->probe_asks(in_));
    check_.compare("step_o", dut_->step_o, out.step);
    check_.compare("dir_o", dut_->dir_o, out.dir);
    check_.compare("start, error with done", answer(bus::start_answer::kDone) & answer(bus::start_answer::kError),
                   model_->loader().done && model_->loader().error);
    if (model_->loader().done && model_->loader().error)
      more("start, reason", answer(bus::start_answer::kReason), model_->loader().reason);
    if (chain_.back().known())
      more("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), chain_.back().word());
  }

  void compare_states() {
    const auto& s = model_->sequencer().outputs();
    namespace time = bus::time_state;
    const auto in_time = [this](const bus::Field& field) { return get(dut_->time_state_o, field); };
    check_.compare("fault", in_time(time::kFault), model_->stop().fault);
    check_.compare("feed active", in_time(time::kFeedActive), s.feed_active);
    check_.compare("limit state", in_time(time::kLimitState), model_->limit_state());
    check_.compare("place", in_time(time::kPlace), model_->state().place.place());
    check_.compare("enabled", in_time(time::kEnabled), model_->state().drives.enabled());
    check_.compare("enable waits", in_time(time::kEnableWaits), model_->waits_for_drives() && model_->wants_drives());
    check_.compare("button hold", in_time(time::kButtonHold), model_->state().buttons.hold());
    check_.compare("stopping", in_time(time::kStopping), model_->stop().stopping);
    check_.compare("settled", in_time(time::kSettled), model_->settled());
    check_.compare("held", in_time(time::kHeld), model_->time().ratio == 0);
    check_.compare("feed begun", in_time(time::kFeedBegun), s.feed_begun);
    check_.compare("tick", in_time(time::kTick), s.tick);
    check_.compare("feed swap", in_time(time::kFeedSwap), s.feed_swap);
    check_.compare("ratio", in_time(time::kRatio), model_->time().ratio);
    check_.compare("rate", in_time(time::kRate), model_->feed().rate);
    namespace geometry = bus::geometry_state;
    const auto in_geometry = [this](const bus::Field& field) { return get(dut_->geometry_state_o, field); };
    check_.compare("direct", in_geometry(geometry::kDirect), s.direct);
    check_.compare("path active", in_geometry(geometry::kPathActive), s.path_active);
    check_.compare("ended", in_geometry(geometry::kEnded), s.ended);
    check_.compare("geometry begun", in_geometry(geometry::kGeometryBegun), s.geometry_begun);
    check_.compare("path swap", in_geometry(geometry::kPathSwap), s.swap);
    const auto& commands = model_->commands();
    check_.compare("inputs", get(dut_->pins_state_o, bus::pins_state::kInputs), in_.levels);
    check_.compare("outputs", get(dut_->pins_state_o, bus::pins_state::kOutputs),
                   kPathCommands ? model_->output_levels(latched_) : 0);
    check_.compare("marks", get(dut_->pins_state_o, bus::pins_state::kMarks), commands.marks() + marks_ahead_);
    check_.compare("waiting", in_geometry(geometry::kWaiting), model_->sequencer().waits_for_input());
    check_.compare("probe missed", get(dut_->pins_state_o, bus::pins_state::kProbeMissed), model_->probe().missed());
    check_.compare("probed", get(dut_->pins_state_o, bus::pins_state::kProbed), model_->probe().probed());
    check_.compare("stale", in_geometry(geometry::kStale), s.stale);
    check_.compare("stale ticks", in_geometry(geometry::kStaleTicks), model_->sequencer().streaming().ticks);
  }

  void compare_axes() {
    using namespace bus::axis_observe;
    check_.compare("path tick", dut_->path_tick_o, model_->engines().path_tick);
    std::uint64_t steps = 0;
    std::uint64_t dirs = 0;
    for (unsigned axis = 0; axis < kAxes; ++axis) {
      steps |= observed(axis, kStep) << axis;
      dirs |= observed(axis, kDir) << axis;
      check_.compare("position", observed(axis, kPosition), model_->position(axis));
    }
    check_.compare("path step", steps, model_->outputs().path_step);
    check_.compare("path dir", dirs, model_->outputs().path_dir);
  }

  void more(const char* signal, std::uint64_t rtl, std::uint64_t model) {
    check_.compare(signal, rtl, model);
    ++more_;
  }

  Simulated<Vdut> dut_;
  std::unique_ptr<model::MotionCore> model_;
  model::MotionCore::Inputs in_;
  Checker check_;
  Dice dice_;
  Dice place_dice_;
  Dice raw_dice_;
  Programs programs_;
  QueueWriter geometry_;
  QueueWriter feed_;
  LoaderRam rtl_ram_;
  LoaderRam model_ram_;
  std::array<SnapshotWord, 4 + kAxes> chain_;
  std::uint32_t idle_level_ = 0;
  std::uint16_t output_idle_ = 0;
  std::uint32_t levels_ = 0;
  model::InputRoles roles_;
  bool emergency_ = false;
  bool latched_ = false;  // the emergency stop's latch
  std::uint32_t mask_ = 0;
  std::uint32_t marks_ahead_ = 0;  // MARKs that the RTL counts more than the model
  bool starting_ = false;
  bool slow_ = false;
  unsigned inputs_every_ = 1000;  // average clocks between two changes of a role
  unsigned abort_every_ = 20'000;
  unsigned start_every_ = 5000;
  unsigned stretch_every_ = 10;
  unsigned write_every_ = 1;  // one halfword in this many clocks
  std::uint64_t steps_ = 0;
  std::uint64_t moves_ = 0;
  std::uint64_t faults_ = 0;
  std::uint64_t limits_ = 0;
  std::uint64_t soft_limits_ = 0;
  std::uint64_t lost_places_ = 0;
  std::uint64_t waits_ = 0;
  std::uint8_t valid_ = 0;  // axes with a valid place, one clock ago
  std::uint64_t beyond_ = 0;
  std::uint64_t marks_ = 0;
  std::uint64_t missing_ = 0;
  std::uint64_t stale_ = 0;  // clocks
  std::uint64_t halts_ = 0;
  std::uint64_t more_ = 0;
};

}  // namespace trammel::lockstep
