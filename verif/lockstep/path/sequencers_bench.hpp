// Both sequencers beside their models: programs come through the queues; time, engines and axes behave at random or
// as a test demands.
#pragma once

#include <Vdut.h>

#include "programs.hpp"
#include "sequencers_inside.hpp"
#include "trammel/model/probe.hpp"
#include "trammel/model/sequencer.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {

class SequencersBench {
 public:
  static constexpr unsigned kAxes = 4;
  static constexpr std::uint64_t kComparedSignals = 37;
  using Stretch = Programs::Stretch;

  explicit SequencersBench(std::uint64_t seed)
      : check_("sequencers", seed), dice_(seed), programs_(kAxes, dice_), geometry_(1024), feed_(1024) {
    programs_.chords = true;
    programs_.path_commands = true;
    programs_.pwm_every = 10;
    programs_.classes = true;
    programs_.probes = true;
    reset();
  }

  // How often external events come: in one of this many clocks.
  struct Pace {
    unsigned enable = 1;
    unsigned feed_tick = 1;  // in one of this many enabled clocks
    unsigned busy = 8;       // engine not ready, not done, or its state in use
    unsigned write = 1;      // a halfword into a queue
    unsigned cut = 2000;
    unsigned input = 100;   // the level of one input changes
    unsigned at_rest = 10;  // the ratio is 0
  };
  Pace pace;

  void random_pace() {
    pace.enable = 1 + dice_.below(dice_.chance(2) ? 1 : 6);
    pace.feed_tick = 1 + dice_.below(dice_.chance(2) ? 1 : 6);
    pace.busy = 2 + dice_.below(20);
    pace.write = 1 + dice_.below(dice_.chance(2) ? 1 : 10);
    pace.cut = dice_.chance(2) ? 100 + dice_.below(400) : 20'000;
    pace.input = 3 + dice_.below(dice_.chance(2) ? 30 : 1000);
    programs_.wrong_every = dice_.chance(4) ? 10 : 1000;
    programs_.longest = dice_.chance(2) ? 20 : 200;
  }

  void random_clock() {
    if (dice_.chance(3000)) random_pace();
    commands();
    random_mode();
    close();
    if (in_.cut && dice_.chance(2)) stand_for_ = 1 + dice_.below(20);
    if (stand_for_ != 0) --stand_for_;
    in_.shut = in_.closing || stand_for_ != 0;
    in_.missed_end = dice_.chance(30);
    if (in_.cut) check_.event("cut");
    if (dice_.chance(10 * pace.cut))
      reset();
    else
      clock();
  }

  // A cut, mostly with the gate shut for a while before it.
  void close() {
    in_.cut = in_.closing ? dice_.chance(40) : dice_.chance(pace.cut);
    const bool closes = in_.cut && !in_.closing && dice_.chance(2);
    if (closes) check_.event("the gate is shut");
    in_.closing = closes || (in_.closing && !in_.cut);
    if (closes) in_.cut = false;
  }

  // Starts again with another random sequence.
  void restart(std::uint64_t seed) {
    dice_ = Dice(seed);
    in_.shut = in_.closing = false;
    stand_for_ = rest_for_ = payload_taken_for_ = 0;
    reset();
  }

  // Short programs of all kinds, with a tick in every other clock.
  void short_programs(unsigned clocks) {
    pace = {1, 2, 3, 1, 0, 20};
    programs_.longest = 8;
    programs_.wrong_every = 20;
    for (unsigned i = 0; i < clocks; ++i) {
      commands();
      clock();
    }
  }

  // Interrupts all decisions of this clock, including a path's wrong end.
  void interrupt(bool by_reset) {
    in_.missed_end = true;
    in_.cut = !by_reset;
    if (by_reset)
      reset();
    else
      clock();
    in_.missed_end = in_.cut = false;
  }

  // Sometimes adds a stretch of commands or, at rest, a direct move.
  void commands() {
    // While no ticks may be taken, neither commands nor a START reach this block.
    const bool open = stand_for_ == 0;
    if (open && direct_step_ == 0 && geometry_.done() && dice_.chance(40)) add(programs_.stretch());
    // The commit of the last command shows in the queue two clocks later, and in `idle` after two more.
    rest_for_ = at_rest() ? rest_for_ + 1 : 0;
    if (open && rest_for_ > 8 && dice_.chance(100)) direct_step_ = 1;
    direct();
  }

  void clock() {
    surroundings();
    apply();
    const std::uint32_t begun[] = {model_.outputs().feed_begun, model_.outputs().geometry_begun};
    const bool geometry_reads = model_.geometry_read();
    const bool feed_reads = model_.feed_read();
    const model::Probe::Inputs probe_in = probe_inputs();
    dut_.clock();
    drops_ += model_.geometry_drops(in_) ? 1U : 0U;
    model_.clock(in_);
    probe_.clock(probe_in);
    chain_[1].clock(dut_->snapshot_i, begun[1], chain_[0]);
    chain_[0].clock(dut_->snapshot_i, begun[0]);
    geometry_.offer(dice_.chance(pace.write));
    geometry_.clock(geometry_reads, in_.cut);
    feed_.offer(dice_.chance(pace.write));
    feed_.clock(feed_reads, in_.cut);
    cut_before_ = in_.cut || in_.halt;
    halts_ += in_.halt ? 1U : 0U;
    if (in_.cut) direct_step_ = 0;
    compare();
    ends_ += model_.outputs().swap ? 1U : 0U;
    in_.direct_load = {};
    in_.direct_go = false;
    in_.setting = {};
    in_.arrives = in_.arrived = false;
    missing_ += model_.streaming().missing ? 1U : 0U;
    late_ += model_.outputs().swap && stale_before_ ? 1U : 0U;
    stale_before_ = model_.outputs().stale;
  }

  void add(const Stretch& stretch) {
    check_.event("stretch of commands", stretch.geometry.size());
    geometry_.add(stretch.geometry);
    feed_.add(stretch.feed);
  }

  // Position streaming: a period of `ticks` ticks, the next one after `clocks` clocks, two more, and an END or a cut.
  void stream(unsigned ticks, unsigned stale_periods, unsigned clocks) {
    const auto period = [&] { return stored_command(card_map::Opcode::Line, 7, ticks, {}, {kOnePulse, 1, -1}); };
    const auto run = [this](unsigned n) {
      for (; n != 0; --n) clock();
    };
    pace = {1, 1 + dice_.below(3), 1'000'000, 1, 1'000'000};
    reset();
    in_.setting = {true, card_map::reg::kStreaming, card_map::field::kStreamingOn | stale_periods << 8};
    run(10);
    const unsigned given = dice_.chance(2) ? ticks : 1;
    add({{period()}, {stored_command(card_map::Opcode::Feed, 0, given, {{"rate", int128{1} << 63}, {"floor", 1}})}});
    run(clocks);
    add({{period()}, {}});
    run(dice_.below(40));
    add({{period()}, {}});
    run(60 + 8 * ticks * (1 + stale_periods));
    const Halfwords end = stored_command(card_map::Opcode::End, 0, 0);
    if (dice_.chance(2)) add({{end}, {end}});
    run(60);
    in_.cut = true;
    clock();
    in_.cut = false;
    run(20);
  }

  // A program with a PROBE for a high level of input 0, which rises after `clocks` clocks.
  void probed(const Stretch& program, unsigned clocks) {
    pace = {1, 1 + dice_.below(2), 3, 1 + dice_.below(2), 1'000'000, 1'000'000, 1 + dice_.below(4)};
    levels_ = 0;
    add(program);
    for (unsigned i = 0; i < clocks; ++i) clock();
    levels_ = 1;
    for (unsigned i = 0; i < 400; ++i) clock();
  }

  // A WAIT_INPUT without a time-out whose count has wrapped to its end: it must still wait for its input.
  void wait_beyond_the_count() {
    const Halfwords wait = stored_command(card_map::Opcode::WaitInput, 0, 0, {{"condition", 0x20}});
    pace = {1, 1, 1'000'000, 1, 1'000'000, 1'000'000, 1};
    levels_ = 0;
    add({{wait}, {wait}});
    for (unsigned i = 0; i < 100; ++i) clock();
    // Neither a borrow nor the end is near.
    for (unsigned i = 0; i < 16 && fast_count(*dut_) != 8; ++i) clock();
    clear_slow_count(*dut_);
    for (unsigned i = 0; i < 40; ++i) clock();
    waited_ = model_.waits_for_input();
    levels_ = 1;
    for (unsigned i = 0; i < 40; ++i) clock();
  }

  // STREAMING, and arriving halfwords, at any clock: the mode changes only at rest.
  void random_mode() {
    const bool on = dice_.chance(2);
    in_.setting = {dice_.chance(mode_every_), dice_.chance(8) ? card_map::reg::kHold : card_map::reg::kStreaming,
                   (on ? card_map::field::kStreamingOn : 0) | dice_.below(4) << 8};
    in_.arrives = dice_.chance(20);
    in_.arrived = dice_.chance(10);
  }

  bool at_rest() const {
    return !probe_.busy() && model_.outputs().idle && geometry_.done() && feed_.done() && geometry_.outputs().empty &&
           feed_.outputs().empty && direct_step_ == 0 && !model_.outputs().direct && model_.outputs().feed_clear;
  }

  Checker& check() { return check_; }
  const model::Sequencer::Outputs& outputs() const { return model_.outputs(); }
  std::uint64_t swaps() const { return ends_; }
  std::uint64_t missing() const { return missing_; }
  std::uint64_t late() const { return late_; }
  bool waited() const { return waited_; }
  std::uint64_t halts() const { return halts_; }
  std::uint64_t drops() const { return drops_; }
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + more_; }

 private:
  // One clock of reset, with random other inputs.
  void reset() {
    check_.event("reset");
    dut_->rst_i = 1;
    surroundings();
    apply();
    dut_.clock();
    dut_->rst_i = 0;
    model_ = model::Sequencer();
    probe_ = model::Probe();
    payload_taken_for_ = 0;
    cut_before_ = true;
    geometry_.reset();
    feed_.reset();
    chain_[0] = chain_[1] = {};
    direct_step_ = 0;
    feed_ticks_ = 0;
    in_.direct_load = {};
    in_.direct_go = in_.shut = in_.closing = false;
    compare();
  }

  // The loader: the halfwords of the length, and 8 clocks later go.
  void direct() {
    if (direct_step_ == 0) return;
    ++direct_step_;
    if (direct_step_ == 2) length_ = dice_.chance(2) ? 1 + dice_.below(4) : 1 + dice_.below(200);
    if (direct_step_ >= 3 && direct_step_ < 6) {
      in_.direct_load = halfword(model::load_target::kTicks, length_, direct_step_ - 3);
    } else if (direct_step_ == 6) {
      const unsigned axis = dice_.below(8);
      namespace target = model::load_target;
      in_.direct_load = halfword(dice_.chance(2) ? target::increment(axis) : target::count(axis), dice_.word(), 0);
    } else if (direct_step_ == 15) {
      check_.event("direct move", length_);
      in_.direct_go = true;
      in_.direct_mask = static_cast<std::uint8_t>(1 + dice_.below((1U << kAxes) - 1));
    } else if (direct_step_ > 20 && !model_.outputs().direct) {
      direct_step_ = 0;
    }
  }

  // Ticks come three clocks after their enable, and not after a clear.
  void surroundings() {
    in_.geometry_empty = geometry_.outputs().empty;
    in_.geometry_word = geometry_.outputs().word;
    in_.feed_empty = feed_.outputs().empty;
    in_.feed_word = feed_.outputs().word;
    in_.enable = dice_.chance(pace.enable);
    in_.feed_tick = (feed_ticks_ & 1) != 0;
    feed_ticks_ >>= 1;
    if (model_.outputs().feed_enable && dice_.chance(pace.feed_tick)) feed_ticks_ |= 4;
    if (model_.outputs().feed_clear) feed_ticks_ = 0;
    // A direct move does not wait for an engine.
    in_.engine_ready = model_.outputs().direct || !dice_.chance(pace.busy);
    // In use from the clock after an arc's tick, at least as long as the tick is on its way.
    if (model_.outputs().engine != card_map::engine::kLines && model_.outputs().tick)
      payload_taken_for_ = 4 + dice_.below(pace.busy);
    else if (payload_taken_for_ != 0)
      --payload_taken_for_;
    // A silence ends when the engine has been done for a while.
    in_.engine_done = !dice_.chance(model_.outputs().silent ? 40 : pace.busy);
    // The arc generator uses the axes' shadows from its start until it has been over for a while.
    if (model_.outputs().swap && model_.outputs().engine == card_map::engine::kArcGenerator)
      in_.shadows_free = false;
    else if (cut_before_ || (!model_.engine_taken() && dice_.chance(pace.busy)))
      in_.shadows_free = true;
    // A path on lines begins when the previous engine has finished; a cut finishes it.
    if (cut_before_ || (model_.outputs().swap && model_.outputs().engine == card_map::engine::kLines))
      payload_taken_for_ = 0;
    in_.payload_ready = payload_taken_for_ == 0 && in_.shadows_free;
    in_.axes_live = dice_.chance(2);
    probe();
    // A piece that lacks queued ticks; mostly there is none.
    if (dice_.chance(in_.wait ? 30 : 300)) in_.wait = !in_.wait;
  }

  // The probe, with inputs that change from time to time.
  void probe() {
    if (dice_.chance(pace.input)) levels_ ^= 1U << dice_.below(32);
    at_rest_ = dice_.chance(pace.at_rest);
    clear_ = dice_.chance(40);
    const model::Probe::Inputs in = probe_inputs();
    in_.halt = probe_.halt();
    in_.drop = probe_.drops();
    in_.probe_taken = probe_.takes(in);
    in_.met = probe_.met(levels_);
    in_.stays = probe_.stays(in);
  }

  model::Probe::Inputs probe_inputs() const {
    model::Probe::Inputs in;
    in.cut = in_.cut;
    in.levels = levels_;
    in.waits = model_.probe_waits();
    in.ends = model_.probe_ends();
    in.at_rest = at_rest_;
    in.clear = clear_;
    in.load = model_.load();
    return in;
  }

  void apply() {
    dut_->cut_i = in_.cut;
    dut_->setting_i = wire(in_.setting);
    dut_->arrival_i = static_cast<IData>(in_place(bus::arrival::kDrop, in_.arrived) |
                                         in_place(bus::arrival::kGeometryWrite, in_.arrives));
    dut_->drop_i = in_.drop;
    dut_->halt_i = in_.halt;
    namespace probe = bus::probe;
    dut_->probe_i = static_cast<CData>(in_place(probe::kMet, in_.met) | in_place(probe::kTaken, in_.probe_taken) |
                                       in_place(probe::kStays, in_.stays));
    dut_->geometry_empty_i = in_.geometry_empty;
    dut_->geometry_word_i = in_.geometry_word;
    dut_->feed_empty_i = in_.feed_empty;
    dut_->feed_word_i = in_.feed_word;
    dut_->direct_load_i = load_wire(in_.direct_load);
    dut_->direct_go_i = in_.direct_go;
    dut_->direct_mask_i = in_.direct_mask;
    dut_->enable_i = in_.enable;
    dut_->wait_i = in_.wait;
    dut_->shut_i = in_.shut;
    dut_->closing_i = in_.closing;
    dut_->feed_tick_i = in_.feed_tick;
    using namespace bus::engines;
    dut_->engines_i =
        static_cast<CData>(in_place(kReady, in_.engine_ready) | in_place(kPayloadReady, in_.payload_ready) |
                           in_place(kShadowsFree, in_.shadows_free) | in_place(kDone, in_.engine_done) |
                           in_place(kMissedEnd, in_.missed_end) | in_place(kLive, in_.axes_live));
    dut_->snapshot_i = dice_.snapshot();
  }

  void compare() {
    check_.next_cycle();
    const auto& out = model_.outputs();
    check_.compare("geometry_read_o", dut_->geometry_read_o, model_.geometry_read());
    const auto move = [this](const bus::Field& field) { return get(dut_->move_o, field); };
    check_.compare("move_o, taking", move(bus::move::kTaking), model_.engine_taken());
    check_.compare("feed_read_o", dut_->feed_read_o, model_.feed_read());
    check_.compare("move_o, direct", move(bus::move::kDirect), out.direct);
    check_.compare("feed_enable_o", dut_->feed_enable_o, out.feed_enable);
    check_.compare("feed_clear_o", dut_->feed_clear_o, out.feed_clear);
    check_.compare("tick_o", dut_->tick_o, out.tick);
    check_.compare("move_o, swap", move(bus::move::kSwap), out.swap);
    check_.compare("feed_swap_o", dut_->feed_swap_o, out.feed_swap);
    check_.compare("load_o, valid", get(dut_->load_o, bus::load_bus::kValid), model_.load().valid);
    check_.compare("feed_load_o, valid", get(dut_->feed_load_o, bus::feed_load::kValid), model_.feed_load().valid);
    const auto path = [this](const bus::Field& field) { return get(dut_->path_o, field); };
    const auto command = [this](const bus::Field& field) { return get(dut_->commands_o, field); };
    check_.compare("mismatch", path(bus::path::kMismatch), out.mismatch);
    check_.compare("incomplete", path(bus::path::kIncomplete), out.incomplete);
    const bool dropping = in_.drop;  // combinational: the value of the last clock
    check_.compare("take mark", command(bus::commands::kTakeMark), model_.takes_mark(dropping));
    check_.compare("take PWM", command(bus::commands::kTakePwm), model_.takes_pwm(dropping));
    check_.compare("take output", command(bus::commands::kTakeOutput), model_.takes_output(dropping));
    check_.compare("probe waits", command(bus::commands::kProbeWaits), model_.probe_waits());
    check_.compare("probe ends", command(bus::commands::kProbeEnds), model_.probe_ends());
    const auto state = [this](const bus::Field& field) { return get(dut_->geometry_state_o, field); };
    namespace geometry = bus::geometry_state;
    check_.compare("waiting", state(geometry::kWaiting), model_.waits_for_input());
    check_.compare("over", command(bus::commands::kOver), out.over);
    check_.compare("path active", state(geometry::kPathActive), out.path_active);
    check_.compare("feed_active_o", dut_->feed_active_o, out.feed_active);
    check_.compare("moving_o", dut_->moving_o, out.moving);
    check_.compare("class_o", dut_->class_o, out.piece_class);
    check_.compare("slew_shift_o", dut_->slew_shift_o, out.slew_shift);
    check_.compare("silent_o", dut_->silent_o, out.silent);
    check_.compare("ended", state(geometry::kEnded), out.ended);
    check_.compare("idle_o", dut_->idle_o, out.idle);
    check_.compare("geometry begun", state(geometry::kGeometryBegun), out.geometry_begun);
    check_.compare("feed_begun_o", dut_->feed_begun_o, out.feed_begun);
    check_.compare("streaming", path(bus::path::kStreaming), model_.streaming().on);
    check_.compare("missing", path(bus::path::kMissing), model_.streaming().missing);
    check_.compare("stale", state(geometry::kStale), out.stale);
    check_.compare("stale ticks", state(geometry::kStaleTicks), model_.streaming().ticks);
    check_.compare("spent_o", dut_->spent_o, out.spent);
    check_.compare("unfinished", path(bus::path::kUnfinished), model_.unfinished());
    still_ = out.tick || out.swap ? 0 : still_ + 1;
    if (still_ > 3) more("left", model_.unfinished() ? path(bus::path::kLeft) : 0, model_.ticks_to_come());
    // Values that are valid with an event.
    const std::uint64_t beside = out.swap ? std::uint64_t{out.engine} << 8 | out.active : 0;
    check_.compare("move_o, axes and engine", out.swap ? move(bus::move::kEngine) << 8 | move(bus::move::kAxes) : 0,
                   beside);
    if (model_.load().valid) more("load_o", dut_->load_o, load_wire(model_.load()));
    if (model_.feed_load().valid) more("feed_load_o", dut_->feed_load_o, feed_wire(model_.feed_load()));
    if (chain_[1].known()) more("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), chain_[1].word());
  }

  void more(const char* signal, std::uint64_t rtl, std::uint64_t model) {
    check_.compare(signal, rtl, model);
    ++more_;
  }

  Simulated<Vdut> dut_;
  model::Sequencer model_;
  model::Sequencer::Inputs in_;
  model::Probe probe_;
  Checker check_;
  Dice dice_;
  Programs programs_;
  QueueWriter geometry_;
  QueueWriter feed_;
  SnapshotWord chain_[2];
  unsigned still_ = 0;       // clocks without a tick or a swap
  unsigned feed_ticks_ = 0;  // ticks on their way, bit 0 comes next
  unsigned payload_taken_for_ = 0;
  bool cut_before_ = false;   // a cut came in the last clock
  unsigned stand_for_ = 0;    // clocks for which a fault lasts
  unsigned direct_step_ = 0;  // step of a direct move; 0: none
  unsigned rest_for_ = 0;     // clocks at rest
  std::uint64_t length_ = 0;
  std::uint64_t ends_ = 0;
  std::uint64_t missing_ = 0;
  std::uint64_t late_ = 0;
  bool stale_before_ = false;
  bool waited_ = false;
  unsigned mode_every_ = 200;
  std::uint32_t levels_ = 0;
  bool at_rest_ = false;
  bool clear_ = false;
  std::uint64_t halts_ = 0;
  std::uint64_t drops_ = 0;
  std::uint64_t more_ = 0;
};

}  // namespace trammel::lockstep
