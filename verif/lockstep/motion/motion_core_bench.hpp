// The motion core beside its golden model, under random traffic and in directed scenarios.
#pragma once

#include <utility>

#include "motion_core_pair.hpp"

namespace trammel::lockstep {

namespace reg = card_map::reg;

class MotionCoreBench : public MotionCorePair {
 public:
  explicit MotionCoreBench(std::uint64_t seed)
      : MotionCorePair(seed), place_dice_(seed), raw_dice_(seed + 1), programs_(kAxes, dice_) {
    programs_.arcs = kArcs;
    programs_.eight_directions = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kAccumulator8);
    programs_.chords = kChords;
    programs_.path_commands = kPathCommands;
    programs_.probes = kPathCommands;
    programs_.pwm_every = kPwm ? 4 : 0;
    programs_.inputs = 32;
    programs_.classes = kClasses;
  }

  // One clock of random traffic, seldom a reset.
  void random_clock() {
    if (dice_.chance(10'000)) random_pace();
    if (!model().stop().closed && !starting() && geometry_.done() && dice_.chance(stretch_every_)) random_stretch();
    in_ = {};
    random_inputs();
    random_settings();
    // While a START is answered no word is written, so that the queues contain only what START finds.
    if (kDirectMode && !starting() && geometry_.done() && feed_.done() && dice_.chance(start_every_)) random_start();
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
    restart();
    write_settings({{reg::kSlew, 0x1000}, {reg::kOutputSafeCause, 0x10001}});
    geometry_.add({stored_command(card_map::Opcode::Output, 0, 0, {{"clear", 1}}), line(200, kOnePulse / 16),
                   Programs::mark(), line(2000, kOnePulse / 16)});
    feed_.add({piece(2200, kFullRate)});
    for (unsigned i = 0; i < 600; ++i) {
      in_.link_lost = i >= 150;
      in_.setting = {i == 160, reg::kOutputSafeCause, 0};
      clock();
    }
    restart();
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
      restart();
      geometry_.add({line(20, kOnePulse / 2)});
      feed_.add({piece(20, kHalfRate)});
      for (unsigned i = 0; i < 200; ++i) {
        in_.setting = {i == clocks, reg::kStreaming, card_map::field::kStreamingOn | 200U << 8};
        clock();
      }
    }
    in_ = {};
  }

  // The same around the begin of a line that waits for its piece: the card is at rest until the line has arrived.
  void streaming_set_before_the_piece() {
    for (unsigned clocks = 0; clocks < 40; ++clocks) {
      restart();
      geometry_.add({line(20, kOnePulse / 2)});
      for (unsigned i = 0; i < 200; ++i) {
        if (i == 60) feed_.add({piece(20, kHalfRate)});
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
      restart();
      write_settings({{reg::kStopReaction, card_map::field::kStopReactionEmergencyStop},
                      {reg::kSlew, 0x1000},
                      {reg::kEnableAxes, 0xFF}});
      geometry_.add({line(4000, kOnePulse / 16)});
      feed_.add({piece(4000, kFullRate)});
      for (unsigned i = 0; i < 300; ++i) {
        in_.emergency = i == 160 + at;
        clock();
      }
    }
    restart();
  }

  // A direct move waits for its drives, which are enabled in any of the clocks around its START and later.
  void direct_move_waits_for_drives() {
    for (unsigned at = 0; at < 120; ++at) {
      restart();
      write_settings({{reg::kEnableAxes, 0xFF}, {reg::kEnable, card_map::field::kEnableManual}});
      write_move(0, std::uint64_t{1} << 38, 20, 0);
      write_register(reg::kLengthLo, 80);
      write_register(reg::kLengthHi, 0);
      for (unsigned i = 0; i < 300; ++i) {
        in_.start = false;
        if (i == 10) start(1);
        in_.setting = {i == at, reg::kEnable, card_map::field::kEnableManual | card_map::field::kEnableOn};
        clock();
      }
    }
    restart();
  }

  // If the duty follows the speed, there are no pulses while a path waits for its drives, at any rate of its piece.
  void pulses_while_drives_wait() {
    restart();
    write_settings({{reg::kEnableAxes, 0xFF},
                    {reg::kEnable, card_map::field::kEnableManual},
                    {reg::kPwmPeriod0, 100},
                    {reg::kPwmOutputs, 1}});
    geometry_.add(
        {stored_command(card_map::Opcode::Output, 0, 0, {{"set", ~output_idle() & 0xFFFF}, {"clear", output_idle()}}),
         stored_command(card_map::Opcode::Pwm, 0, 0, {{"select", 0x10}, {"duty", 0xFFFF}, {"gain", 0xFFFF}}),
         line(4000, kOnePulse / 16)});
    feed_.add({piece(4000, kHalfRate)});
    for (unsigned i = 0; i < 3000; ++i) {
      in_.setting = {i == 2000, reg::kEnable, card_map::field::kEnableManual | card_map::field::kEnableOn};
      clock();
    }
    restart();
  }

  // If HEALTH_CAUSES requires the watchdog, the output that shows the card's health follows it.
  void health_follows_the_watchdog() {
    restart();
    write_settings({{reg::kHealthRoles, 1U << card_map::field::kHealthRolesHealthyShift},
                    {reg::kHealthCauses, card_map::field::kHealthCausesNoWatchdog}});
    run(10);
    write_settings({{reg::kWatchdog, 1}});
    run(10);
    write_settings({{reg::kWatchdog, 0}});
    run(10);
    restart();
  }

  // A HOLD around the start of a fixed piece whose path comes later takes effect at once.
  void holds_before_the_path() {
    for (unsigned clocks = 0; clocks < 90; clocks += 3) {
      restart();
      feed_.add({piece(20, kHalfRate, card_map::constant::kClassFixed)});
      for (unsigned i = 0; i < 220; ++i) {
        if (i == 100) geometry_.add({line(20, kOnePulse / 2)});
        in_.setting = {i == clocks, reg::kHold, 1};
        clock();
      }
    }
    restart();
  }

 private:
  // The rates of pieces in directed scenarios: a tick in almost every clock, and one in every other clock.
  static constexpr int128 kFullRate = ~std::uint64_t{0};
  static constexpr int128 kHalfRate = std::uint64_t{1} << 63;

  // A line of the first axis, which moves by `increment` in each tick.
  static Halfwords line(std::uint64_t ticks, std::int64_t increment) {
    return stored_command(card_map::Opcode::Line, 1, ticks, {}, {increment});
  }

  static Halfwords piece(std::uint64_t ticks, int128 rate, unsigned piece_class = 0) {
    return stored_command(card_map::Opcode::Feed, piece_class, ticks, {{"rate", rate}, {"floor", 1}});
  }

  // The first `clocks` clocks of a line of `ticks` with commands behind it; `second` is the second command.
  void commands_behind(unsigned ticks, unsigned clocks, const Halfwords& second) {
    restart();
    geometry_.add({line(ticks, kOnePulse / 2), programs_.output(), second, programs_.output(), Programs::mark()});
    feed_.add({piece(ticks, kFullRate)});
    run(clocks);
  }

  // Commands without a path before them.
  void commands_alone() {
    run(4);
    geometry_.add({Programs::mark(), programs_.output()});
    run(40);
  }

  // Queues a probing move of `ticks`, without a path if 0, and a line after its PROBE_END. Runs no clock of them.
  void probe_to_the_end(unsigned ticks) {
    restart();
    geometry_.add({stored_command(card_map::Opcode::Probe, 0, 0, {{"condition", 0x20}})});
    if (ticks != 0) geometry_.add({line(ticks, kOnePulse / 2)});
    if (ticks != 0) feed_.add({piece(ticks, kFullRate)});
    geometry_.add({Programs::probe_end(), line(20, kOnePulse / 2)});
    feed_.add({Programs::probe_end(), piece(20, kFullRate)});
  }

  void random_stretch() {
    const Programs::Stretch stretch = programs_.stretch();
    check().event("stretch of commands", stretch.geometry.size());
    geometry_.add(stretch.geometry);
    feed_.add(stretch.feed);
  }

  void random_inputs() {
    in_.abort = dice_.chance(abort_every_);
    if (dice_.chance(50)) levels_ = dice_.draw();
    in_.levels = kPathCommands ? levels_ : 0;
    in_.raw = in_.levels ^ (raw_dice_.draw() & raw_dice_.draw() & raw_dice_.draw());
    in_.quiet = raw_dice_.draw();
    if (kMachineInputs && dice_.chance(inputs_every_)) random_role();
    if (kMachineInputs) operator_continues();
    if (kMachineInputs && model().probe().busy() && dice_.chance(40)) roles_.probe = !roles_.probe;
    in_.roles = roles_;
    random_emergency();
    in_.probe_clear = kPathCommands && dice_.chance(50);
    if (in_.abort) check().event("abort");
    if (model().stop().fault != 0 ? dice_.chance(40) : dice_.chance(5000)) {
      in_.clear_fault = dice_.chance(3) ? dice_.draw() : ~0U;
      check().event("clear fault", in_.clear_fault);
    }
  }

  // As an operator does: removes what stopped the card, and presses cycle start after a hold. Otherwise most of the
  // clocks would pass without motion.
  void operator_continues() {
    if (model().stop().closed && dice_.chance(300)) roles_ = {};
    if (model().state().buttons.hold() && dice_.chance(200)) {
      roles_.feed_hold = false;
      roles_.cycle_start = !roles_.cycle_start;
    }
  }

  // At most one setting in a clock, and the two states of the link.
  void random_settings() {
    if (dice_.chance(200)) in_.setting = motion_setting();
    if (!in_.setting.set && place_dice_.chance(1000)) in_.setting = place_setting();
    if (place_dice_.chance(in_.link_lost ? 20 : 10'000)) in_.link_lost = !in_.link_lost;
    if (place_dice_.chance(in_.session_gone ? 300 : 3000)) in_.session_gone = !in_.session_gone;
    if (kSoftLimits && takes_ends() && !in_.setting.set && place_dice_.chance(400)) in_.setting = soft_limit_setting();
    if (kPwm && !in_.setting.set && place_dice_.chance(2000)) in_.setting = pwm_setting();
    if (in_.setting.set) check().event("setting", std::uint64_t{in_.setting.address} << 32 | in_.setting.data);
    if (dice_.chance(3000)) marks_near_a_carry();
  }

  // Makes the RTL count more MARKs than the model.
  void marks_near_a_carry() {
    if (kPathCommands) continue_rtl_marks_at(static_cast<std::uint32_t>(dice_.before_carry(32)));
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
    if (emergency_ && !was) check().event("emergency stop");
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
    check().event("roles", roles_wire(roles_));
  }

  // Sometimes only its address and data, without the event.
  model::Setting motion_setting() {
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
        {kMachineInputs ? reg::overtravel(axis) : reg::kHoldLimit, 1 + dice_.below(dice_.chance(2) ? 2 : 20)},
        {kStreaming ? reg::kStreaming : reg::kHoldLimit, kStreaming ? dice_.below(2) | dice_.below(4) << 8 : 7},
        {reg::kInputPolarity, kPathCommands ? dice_.draw() & 0xFFFF : 0},
        {reg::kOutputSafe, kPathCommands ? dice_.draw() : 0}};
    const auto& [address, data] = settings[dice_.below(std::size(settings))];
    return {!dice_.chance(4), address, data};
  }

  // Pulses short enough for the length of a path.
  model::Setting pwm_setting() {
    if (place_dice_.chance(3)) return {true, reg::kPwmOutputs, place_dice_.draw() & 0x00070007};
    const std::uint32_t period = place_dice_.chance(2) ? reg::kPwmPeriod0 : reg::kPwmPeriod1;
    return {true, period, 100 + place_dice_.below(1000)};
  }

  // Lost places are soon set again. They change no motion and use a random generator of their own, so that the
  // programs do not depend on them.
  model::Setting place_setting() {
    Dice& dice = place_dice_;
    const bool keeps = dice.chance(8);
    const std::uint32_t axes = dice.draw() & 0xFF;
    const std::uint32_t place = dice.below(4) | axes << card_map::field::kSetPlaceAxesShift;
    model::Setting setting{true, keeps ? reg::kKeepsPlace : reg::kSetPlace, keeps ? axes & dice.draw() : place};
    if (kPathCommands && dice.chance(3)) setting = {true, reg::kOutputSafeCause, dice.draw()};
    return kEnables && dice.chance(2) ? enable_setting() : setting;
  }

  // The ends are cleared in the first clocks after a reset. The card has no access that early: its registers take
  // longer to fill.
  bool takes_ends() const { return since_reset() >= 16; }

  // Near the axis's position; mostly switched off again, so that programs continue.
  model::Setting soft_limit_setting() {
    Dice& dice = place_dice_;
    const unsigned axis = dice.below(kAxes);
    const std::uint32_t here = model().position(axis);
    const std::pair<std::uint32_t, std::uint32_t> settings[] = {{reg::soft_minus(axis), here - dice.below(20)},
                                                                {reg::soft_plus(axis), here + dice.below(20)},
                                                                {reg::kSoftLimits, dice.draw() & 0xFF},
                                                                {reg::kSoftLimits, 0},
                                                                {reg::kSoftLimits, 0}};
    const auto& [address, data] = settings[dice.below(std::size(settings))];
    return {true, address, data};
  }

  // A unit of a delay is some thousand clocks: delays are mostly 0, and enable sequences are rare.
  model::Setting enable_setting() {
    Dice& dice = place_dice_;
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

  // The registers of direct mode of one axis; `frequency` in 2^-40 pulses per tick.
  void write_move(unsigned axis, std::uint64_t frequency, std::uint32_t count, std::uint32_t direction) {
    write_register(reg::frequency_lo(axis), static_cast<std::uint32_t>(frequency));
    write_register(reg::frequency_hi(axis), static_cast<std::uint32_t>(frequency >> 32));
    write_register(reg::count(axis), count);
    write_register(reg::direction(axis), direction);
  }

  // Mostly a possible move; otherwise one value is wrong.
  void random_start() {
    for (unsigned axis = 0; axis < kAxes; ++axis) {
      std::uint64_t frequency = dice_.log_uniform(40) + 1;
      if (dice_.chance(8)) frequency = std::uint64_t{1} << 40;
      if (dice_.chance(20))
        frequency = dice_.chance(2) ? 0 : (std::uint64_t{1} << 40) + 1 + dice_.below(2) * 0xFFFFFFFF;
      const unsigned count = dice_.chance(3) ? dice_.below(4) : dice_.below(100);
      write_move(axis, frequency, count, dice_.below(2));
    }
    write_register(reg::kLengthLo, dice_.chance(20) ? 0 : 1 + dice_.below(200));
    write_register(reg::kLengthHi, dice_.chance(1000) ? 1 : 0);
    start(dice_.chance(10) ? dice_.draw() : 1 + dice_.below(kAllAxes));
  }

  // Random generators of their own, so that the programs do not depend on these inputs.
  Dice place_dice_;
  Dice raw_dice_;
  Programs programs_;
  std::uint32_t levels_ = 0;
  model::InputRoles roles_;
  bool emergency_ = false;
  bool slow_ = false;
  unsigned inputs_every_ = 1000;  // average clocks between two changes of a role
  unsigned abort_every_ = 20'000;
  unsigned start_every_ = 5000;
  unsigned stretch_every_ = 10;
};

}  // namespace trammel::lockstep
