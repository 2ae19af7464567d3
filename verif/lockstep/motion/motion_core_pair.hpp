// The motion core's RTL and its golden model as a pair. Both get the same words, registers and pins, every output is
// compared in every cycle, and the events that a test must reach are counted.
#pragma once

#include <Vdut.h>

#include <array>
#include <initializer_list>
#include <memory>
#include <type_traits>
#include <utility>

#include "motion_core_inside.hpp"
#include "programs.hpp"
#include "trammel/model/motion_core.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {

constexpr unsigned kAxes = TRAMMEL_AXES;
constexpr std::uint32_t kAllAxes = (1U << kAxes) - 1;
constexpr unsigned kOutputs = 3;
using IdleLevel = std::remove_reference_t<decltype(Vdut::idle_level_i)>;
// Comparisons that every cycle makes.
constexpr std::uint64_t kComparedSignals = 45 + kAxes;
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

// Clocks in which the model did this, since the pair was built. Most are events of one clock.
struct MotionCoreCounts {
  std::uint64_t steps = 0;        // the path makes a step, of one axis or several
  std::uint64_t moves = 0;        // a direct move begins
  std::uint64_t faults = 0;       // a stop begins
  std::uint64_t limits = 0;       // a step into an active limit
  std::uint64_t beyond = 0;       // the same with no overtravel left
  std::uint64_t soft_limits = 0;  // a soft limit is a cause of a stop
  std::uint64_t lost_places = 0;  // an axis loses its place, without a setting
  std::uint64_t waits = 0;        // motion waits for the drives
  std::uint64_t marks = 0;        // a MARK takes effect
  std::uint64_t halts = 0;        // the probe ends a path
  std::uint64_t missing = 0;      // the next period of a stream is missing
  std::uint64_t stale = 0;        // a line continues beyond its period
};

// For a derived class that makes the traffic: it sets inputs, adds commands to the queues, and calls clock().
class MotionCorePair {
 public:
  Checker& check() { return check_; }
  const MotionCoreCounts& counts() const { return counts_; }
  // The number of comparisons that check() must have made.
  std::uint64_t expected() const { return kComparedSignals * check_.cycles() + further_comparisons_; }

 protected:
  explicit MotionCorePair(std::uint64_t seed) : dice_(seed), geometry_(1024), feed_(1024), check_("motion_core", seed) {
    reset();
  }
  ~MotionCorePair() = default;

  const model::MotionCore& model() const { return *model_; }

  // One clock of reset, with the other inputs as they are; the pins have the levels of a random strap.
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
    reset_at_ = check_.cycles();
    marks_ahead_ = 0;
    places_ = 0;
    chain_.fill({});
    compare();
  }

  std::uint64_t since_reset() const { return check_.cycles() - reset_at_; }

  // One clock with the inputs `in_`; the queues and their writers add theirs.
  void clock() {
    // The host waits for START's answer, and the stream is refused while a direct move runs.
    const bool streams = !starting_ && !model_->loader().go && !model_->sequencer().outputs().direct;
    const model::HalfwordQueue::Inputs& geometry = geometry_.offer(streams && dice_.chance(write_every_));
    const model::HalfwordQueue::Inputs& feed = feed_.offer(streams && dice_.chance(write_every_));
    in_.arrival = {false, geometry.commit, geometry.write, feed.commit, feed.write, geometry.word};
    apply();
    clock_chain();
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
    count_events();
    if (model_->loader().done) starting_ = false;
  }

  // A reset, and then all inputs at rest and a halfword in every clock.
  void restart() {
    reset();
    in_ = {};
    write_every_ = 1;
  }

  // One setting in each clock.
  void write_settings(std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> settings) {
    for (const auto& [address, data] : settings) {
      in_.setting = {true, address, data};
      clock();
    }
    in_.setting = {};
  }

  void run(unsigned clocks) {
    for (unsigned i = 0; i < clocks; ++i) clock();
  }

  // A register of direct mode.
  void write_register(std::uint32_t address, std::uint32_t data) {
    rtl_ram_.write(address, data);
    model_ram_.write(address, data);
  }

  // START in the next clock, for the axes in `mask`. No halfword is written until it is answered.
  void start(std::uint32_t mask) {
    starting_ = true;
    in_.start = true;
    start_mask_ = static_cast<std::uint8_t>(mask);
    check_.event("START", start_mask_);
  }
  bool starting() const { return starting_; }

  // Lets the RTL's count of MARKs continue at `marks`; the model counts on from its own.
  void continue_rtl_marks_at(std::uint32_t marks) {
    if constexpr (kPathCommands) {
      const std::uint32_t more = marks - model_->commands().marks() - marks_ahead_;
      marks_ahead_ += more;
      add_marks(*dut_, more);
    }
  }

  // The levels of outputs that are off, by the strap of the last reset.
  std::uint16_t output_idle() const { return output_idle_; }

  // Protected, because the traffic sets all inputs and fills the queues. Traffic and pair draw from one random
  // generator, so that one seed repeats a run.
  model::MotionCore::Inputs in_;  // of the next clock
  bool latched_ = false;          // the emergency stop's latch, an input of the outputs alone
  unsigned write_every_ = 1;      // one halfword in this many clocks, on average
  Dice dice_;
  QueueWriter geometry_;
  QueueWriter feed_;

 private:
  void note_events() {
    const auto& s = model_->sequencer().outputs();
    if (model_->stop().cut) check_.event("cut, with fault", model_->stop().fault);
    if (s.swap)
      check_.event(s.engine != card_map::engine::kLines ? "arc begins"
                   : s.direct                           ? "direct move begins"
                                                        : "line begins",
                   s.active);
    if (s.feed_swap) check_.event("piece begins");
    if (model_->probe().halt()) check_.event("halt by the probe");
  }

  void count_events() {
    const auto count = [](std::uint64_t& counter, bool event) { counter += event ? 1U : 0U; };
    const model::MotionCore::State& state = model_->state();
    count(counts_.steps, model_->outputs().path_step != 0);
    count(counts_.moves, model_->loader().go);
    count(counts_.faults, model_->stop().stop);
    count(counts_.limits, state.limits.causes().limit);
    count(counts_.beyond, state.limits.causes().beyond);
    count(counts_.soft_limits, state.soft_limits.cause());
    const std::uint8_t places = state.place.state().valid;
    count(counts_.lost_places, (places_ & ~places) != 0 && !in_.setting.set);
    places_ = places;
    count(counts_.waits, model_->waits_for_drives() && model_->wants_drives());
    count(counts_.marks, model_->commands().mark());
    count(counts_.halts, model_->probe().halt());
    count(counts_.missing, model_->sequencer().streaming().missing);
    count(counts_.stale, model_->sequencer().outputs().stale);
  }

  // From the far end: RATIO, RATE, FEED_BEGUN, GEOMETRY_BEGUN, POSITION of each axis; RATIO passes on only 20 bits.
  // REST has the ticks left in the place of RATIO and RATE.
  void clock_chain() {
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
    in_.start_mask = start_mask_;
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
      compare_further("start, reason", answer(bus::start_answer::kReason), model_->loader().reason);
    if (chain_.back().known())
      compare_further("snapshot_o, word", get(dut_->snapshot_o, bus::snapshot::kWord), chain_.back().word());
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

  // A comparison that not every cycle makes.
  void compare_further(const char* signal, std::uint64_t rtl, std::uint64_t model) {
    check_.compare(signal, rtl, model);
    ++further_comparisons_;
  }

  Simulated<Vdut> dut_;
  std::unique_ptr<model::MotionCore> model_;
  Checker check_;
  LoaderRam rtl_ram_;
  LoaderRam model_ram_;
  std::array<SnapshotWord, 4 + kAxes> chain_;
  std::uint32_t idle_level_ = 0;
  std::uint16_t output_idle_ = 0;
  bool starting_ = false;       // START is not answered yet
  std::uint64_t reset_at_ = 0;  // clock of the last reset
  std::uint8_t start_mask_ = 0;
  std::uint32_t marks_ahead_ = 0;  // MARKs that the RTL counts more than the model
  std::uint8_t places_ = 0;        // axes with a valid place, one clock ago
  MotionCoreCounts counts_;
  std::uint64_t further_comparisons_ = 0;
};

}  // namespace trammel::lockstep
