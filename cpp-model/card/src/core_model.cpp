#include "trammel/model/core_model.hpp"

#include <stdexcept>

#include "trammel/card_map.hpp"

namespace trammel::model {

namespace {

// Halfwords, at least the length of the longest command. A queue with less room may have none for the next command.
constexpr std::uint16_t kMaxGeometryCommand = 64;
constexpr std::uint16_t kMaxFeedCommand = 32;

const CardConfig& checked(const CardConfig& config) {
  if (config.axes < 1 || config.axes > card_map::kMaxAxes) throw std::invalid_argument("a card has 1 to 8 axes");
  if (config.ports < 1 || config.ports > 4) throw std::invalid_argument("a card has 1 to 4 ports");
  if (config.inputs < 1 || config.inputs > 32) throw std::invalid_argument("a card has 1 to 32 inputs");
  if (config.outputs < 1 || config.outputs > 16) throw std::invalid_argument("a card has 1 to 16 outputs");
  constexpr std::uint32_t kOnEveryCard = RegisterFile::kMinEngines;
  if ((config.engines & kOnEveryCard) != kOnEveryCard || (config.engines & ~RegisterFile::kMaxEngines) != 0)
    throw std::invalid_argument("no card has these engines");
  if (card_map::has_engine(config.engines, card_map::engine::kMachineInputs) &&
      !card_map::has_engine(config.engines, card_map::engine::kPathCommands))
    throw std::invalid_argument("machine inputs need path commands");
  if (card_map::has_engine(config.engines, card_map::engine::kCaptures) &&
      (!card_map::has_engine(config.engines, card_map::engine::kMachineInputs) || config.captures < 1 ||
       config.captures > Captures::kUnits))
    throw std::invalid_argument("captures need machine inputs, and are 1 to 4");
  if (card_map::has_engine(config.engines, card_map::engine::kCaptureFifo) &&
      !card_map::has_engine(config.engines, card_map::engine::kCaptures))
    throw std::invalid_argument("the queue of captures needs captures");
  if (card_map::has_engine(config.engines, card_map::engine::kEnables) &&
      !card_map::has_engine(config.engines, card_map::engine::kPathCommands))
    throw std::invalid_argument("enables need path commands");
  if (card_map::has_engine(config.engines, card_map::engine::kPwm) &&
      !card_map::has_engine(config.engines, card_map::engine::kPathCommands))
    throw std::invalid_argument("PWM needs path commands");
  return config;
}

RegisterFile::Config register_config(const CardConfig& config) {
  RegisterFile::Config result;
  result.axes = config.axes;
  result.geometry_depth = config.geometry_depth;
  result.feed_depth = config.feed_depth;
  result.clock_hz = config.clock_hz;
  result.engines = config.engines;
  result.build_id = config.build_id;
  result.build_dirty = config.build_dirty;
  result.board_id = config.board_id;
  result.ports = config.ports;
  result.idle_level = config.idle_level;
  result.inputs = config.inputs;
  result.outputs = config.outputs;
  result.captures = config.captures;
  return result;
}

PathCommands::Config outputs_of(const CardConfig& config) { return {config.outputs, config.output_idle}; }

Captures captures_of(const CardConfig& config) {
  return Captures(card_map::has_engine(config.engines, card_map::engine::kCaptures) ? config.captures : 0);
}

CardInputs inputs_of(const CardConfig& config) { return {config.axes, config.inputs, config.engines}; }

}  // namespace

bool CoreModel::Outputs::operator==(const Outputs& o) const {
  return step == o.step && dir == o.dir && output == o.output && irq == o.irq && tick == o.tick &&
         path_tick == o.path_tick && path_swap == o.path_swap && feed_swap == o.feed_swap && path_step == o.path_step &&
         path_dir == o.path_dir && geometry_room == o.geometry_room && feed_room == o.feed_room && status == o.status &&
         fault == o.fault && geometry_begun == o.geometry_begun && feed_begun == o.feed_begun && ratio == o.ratio &&
         rate == o.rate;
}

CoreModel::CoreModel(const Config& config)
    : config_(checked(config)),
      state_{RegisterFile(register_config(config)),
             CommandChecker(config.axes, config.engines),
             HalfwordQueue(config.geometry_depth),
             HalfwordQueue(config.feed_depth),
             QueueWatermarks(config.geometry_depth, config.feed_depth),
             inputs_of(config),
             EmergencyStop(config.emergency_stop_level),
             MotionCore(config.axes, config.idle_level, config.engines, outputs_of(config)),
             captures_of(config)} {
  reset(!config.emergency_stop_level);
}

void CoreModel::reset(bool emergency_stop) {
  state_.registers.reset();
  state_.checker = CommandChecker(config_.axes, config_.engines);
  state_.geometry_queue = HalfwordQueue(config_.geometry_depth);
  state_.feed_queue = HalfwordQueue(config_.feed_depth);
  state_.watermarks = QueueWatermarks(config_.geometry_depth, config_.feed_depth);
  state_.inputs = inputs_of(config_);
  state_.emergency_stop.reset(emergency_stop);
  state_.motion = MotionCore(config_.axes, config_.idle_level, config_.engines, outputs_of(config_));
  state_.captures = captures_of(config_);
  state_.cycles = 0;
  state_.record.reset(output_pins());
  state_.answer = {};
  show();
}

MotionCore::Inputs CoreModel::motion_inputs() const {
  const RegisterFile::Outputs& set = state_.registers.outputs();
  MotionCore::Inputs in;
  in.setting = set.setting;
  in.abort = set.abort;
  in.clear_fault = set.clear_fault;
  in.session_gone = state_.registers.link().gone();
  in.link_lost = state_.registers.link().lost();
  in.probe_clear = set.probe_clear;
  in.geometry_empty = state_.geometry_queue.outputs().empty;
  in.feed_empty = state_.feed_queue.outputs().empty;
  in.geometry_word = state_.geometry_queue.outputs().word;
  in.feed_word = state_.feed_queue.outputs().word;
  const CommandChecker::Outputs& checker = state_.checker.outputs();
  in.arrival = {checker.drop,        checker.geometry_commit, checker.geometry_write,
                checker.feed_commit, checker.feed_write,      checker.halfword};
  in.full =
      state_.geometry_queue.outputs().room < kMaxGeometryCommand || state_.feed_queue.outputs().room < kMaxFeedCommand;
  in.start = set.start;
  in.start_mask = set.start_mask;
  in.loader_data = set.loader_data;
  in.levels = state_.inputs.levels();
  in.raw = state_.inputs.raw();
  in.quiet = state_.inputs.quiet();
  in.roles = state_.inputs.roles();
  const bool cleared = (set.clear_fault & card_map::field::kFaultEmergencyStop) != 0;
  in.emergency = state_.emergency_stop.stops(cleared) && !state_.registers.filling();
  return in;
}

Captures::Inputs CoreModel::capture_inputs() const {
  Captures::Inputs in;
  if (state_.captures.units() == 0) return in;
  in.raw = state_.inputs.raw();
  in.levels = state_.inputs.levels();
  in.quiet = state_.inputs.quiet();
  in.setting = state_.registers.outputs().setting;
  return in;
}

EmergencyStop::Inputs CoreModel::emergency_inputs(bool pin) const {
  return {pin, (state_.registers.outputs().clear_fault & card_map::field::kFaultEmergencyStop) != 0};
}

QueueWatermarks::Inputs CoreModel::watermark_inputs() const {
  return {state_.registers.outputs().setting, state_.geometry_queue.outputs().room, state_.feed_queue.outputs().room};
}

CommandChecker::Inputs CoreModel::checker_inputs(bool cut) const {
  const RegisterFile::Outputs& set = state_.registers.outputs();
  CommandChecker::Inputs in;
  in.write = set.stream_write;
  in.word = set.stream_word;
  in.flush = set.flush;
  in.clear = cut;
  in.closed = state_.motion.stop().closed;
  in.geometry_room = state_.geometry_queue.outputs().room;
  in.feed_room = state_.feed_queue.outputs().room;
  return in;
}

// Copies the present state of the card to the inputs of the register file.
void CoreModel::show_registers() {
  RegisterFile::Inputs& in = state_.shown;
  const Sequencer::Outputs& s = state_.motion.sequencer().outputs();
  in.busy = state_.motion.outputs().busy;
  in.direct = s.direct;
  in.path_active = s.path_active;
  in.feed_active = s.feed_active;
  in.ended = s.ended;
  in.stopping = state_.motion.stop().stopping;
  in.underrun = state_.motion.underrun().shown;
  in.underruns = state_.motion.underrun().underruns;
  in.stale = s.stale;
  in.limit_state = state_.motion.limit_state();
  in.place = state_.motion.state().place.place();
  in.button_hold = state_.motion.state().buttons.hold();
  in.enabled = state_.motion.state().drives.enabled();
  in.enable_waits = state_.motion.waits_for_drives() && state_.motion.wants_drives();
  in.stale_ticks = state_.motion.sequencer().streaming().ticks;
  in.incomplete = state_.checker.outputs().partial;
  in.geometry_room = state_.geometry_queue.outputs().room;
  in.feed_room = state_.feed_queue.outputs().room;
  in.geometry_low = state_.watermarks.outputs().geometry_low;
  in.feed_low = state_.watermarks.outputs().feed_low;
  in.geometry_begun = s.geometry_begun;
  in.feed_begun = s.feed_begun;
  in.rate = state_.motion.feed().rate;
  in.ratio = state_.motion.time().ratio;
  for (unsigned n = 0; n < config_.axes; ++n) in.position[n] = state_.motion.position(n);
  in.fault = state_.motion.stop().fault;
  in.stop = state_.motion.stop().stop;
  in.mark = state_.motion.commands().mark();
  in.settled = state_.motion.settled();
  in.ticks_left = in.settled ? state_.motion.sequencer().ticks_to_come() : 0;
  in.probed = state_.motion.probe().probed();
  in.probe_missed = state_.motion.probe().missed();
  in.waiting = state_.motion.sequencer().waits_for_input();
  in.inputs = state_.inputs.levels();
  in.raw_inputs = state_.inputs.raw();
  in.roles = state_.inputs.roles();
  in.passed = state_.captures.passed();
  in.edges = state_.captures.edges();
  in.capture_state = state_.captures.word();
  in.outputs = output_levels();
  in.marks = state_.motion.commands().marks();
  in.checker_ready = state_.checker.outputs().ready;
  in.checker_refuse = state_.checker.outputs().refuse;
  in.checker_reason = state_.checker.outputs().reason;
  in.checker_number = state_.checker.outputs().number;
  const DirectLoader::Outputs& loader = state_.motion.loader();
  in.start_done = loader.done;
  in.start_error = loader.error;
  in.start_reason = loader.reason;
  in.loader_address = loader.address;
}

void CoreModel::show() {
  show_registers();
  const Sequencer::Outputs& s = state_.motion.sequencer().outputs();
  const MotionCore::Outputs& m = state_.motion.outputs();
  state_.answer = {state_.registers.outputs().ack, state_.registers.outputs().error, state_.registers.outputs().data};
  state_.out.step = m.step;
  state_.out.dir = m.dir;
  state_.out.output = output_pins();
  state_.out.irq = state_.registers.outputs().irq;
  state_.out.tick = s.tick;
  state_.out.path_tick = state_.motion.engines().path_tick;
  state_.out.path_swap = s.swap;
  state_.out.feed_swap = s.feed_swap;
  state_.out.path_step = m.path_step;
  state_.out.path_dir = m.path_dir;
  state_.out.geometry_room = state_.geometry_queue.outputs().room;
  state_.out.feed_room = state_.feed_queue.outputs().room;
  state_.out.status = state_.registers.status(state_.shown);
  state_.out.fault = state_.motion.stop().fault;
  state_.out.geometry_begun = s.geometry_begun;
  state_.out.feed_begun = s.feed_begun;
  state_.out.ratio = state_.motion.time().ratio;
  state_.out.rate = state_.motion.feed().rate;
}

void CoreModel::record(bool cut) {
  if (cut) state_.record.cut();
  const CommandChecker::Outputs& checker = state_.checker.outputs();
  if (checker.geometry_commit || checker.feed_commit) state_.record.accepted(state_.checker.counts_in_geometry());
  // Positions change only while an axis is busy.
  if (state_.motion.outputs().axis_busy != 0) {
    for (unsigned n = 0; n < config_.axes; ++n) state_.record.pin(state_.cycles, n, state_.motion.position(n));
  }
  if (state_.motion.engines().path_tick) state_.record.arc_tick();
  if (state_.motion.chord_tick()) state_.record.chord_tick(state_.cycles);
  // A tick belongs to the path that takes it, even if the next path begins in the same clock. On an arc in chords
  // feed ticks make no step.
  const Sequencer& s = state_.motion.sequencer();
  if (s.outputs().tick) state_.record.tick(state_.cycles);
  const MotionCore::Outputs& m = state_.motion.outputs();
  for (std::uint32_t n = 0, left = m.path_step; left != 0; ++n, left >>= 1) {
    if ((left & 1) == 0) continue;
    const bool backwards = (m.path_dir >> n & 1) != 0;
    if ((m.engine_step >> n & 1) != 0)
      state_.record.arc_step(state_.cycles, n, backwards);
    else
      state_.record.line_step(state_.cycles, n, backwards);
  }
  state_.record.outputs(state_.cycles, output_pins());
  if (s.record().command) state_.record.command_begins();
  if (s.record().direct) state_.record.direct_begins();
}

}  // namespace trammel::model
