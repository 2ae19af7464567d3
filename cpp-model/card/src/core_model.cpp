#include "trammel/model/core_model.hpp"

#include <stdexcept>

#include "trammel/card_map.hpp"

namespace trammel::model {

namespace {

// Clocks that the register file stays awake after its last activity.
constexpr int kAwake = 2;
// A queue with less room than this, in halfwords, may have none for the next command.
constexpr std::uint16_t kMaxGeometry = 64;
constexpr std::uint16_t kMaxFeed = 32;

const CardConfig& checked(const CardConfig& config) {
  if (config.axes < 1 || config.axes > card_map::kMaxAxes) throw std::invalid_argument("a card has 1 to 8 axes");
  if (config.ports < 1 || config.ports > 4) throw std::invalid_argument("a card has 1 to 4 ports");
  if (config.inputs < 1 || config.inputs > 16 || config.outputs < 1 || config.outputs > 16)
    throw std::invalid_argument("a card has 1 to 16 inputs and outputs");
  constexpr std::uint32_t kMin = RegisterFile::kMinEngines;
  if ((config.engines & kMin) != kMin || (config.engines & ~RegisterFile::kMaxEngines) != 0)
    throw std::invalid_argument("no card has these engines");
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
  return result;
}

PathCommands::Config pins_of(const CardConfig& config) { return {config.inputs, config.outputs, config.output_idle}; }

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
      registers_(register_config(config)),
      checker_(config.axes, register_config(config).engines),
      geometry_queue_(config.geometry_depth),
      feed_queue_(config.feed_depth),
      watermarks_(config.geometry_depth, config.feed_depth),
      motion_(config.axes, config.idle_level, config.clock_all, config.engines, pins_of(config)) {
  reset();
}

void CoreModel::reset() {
  registers_.reset();
  checker_ = CommandChecker(config_.axes, register_config(config_).engines);
  geometry_queue_ = HalfwordQueue(config_.geometry_depth);
  feed_queue_ = HalfwordQueue(config_.feed_depth);
  watermarks_ = QueueWatermarks(config_.geometry_depth, config_.feed_depth);
  motion_ = MotionCore(config_.axes, config_.idle_level, config_.clock_all, config_.engines, pins_of(config_));
  cycles_ = 0;
  record_.reset(motion_.commands().outputs());
  answer_ = {};
  awake_ = kAwake;
  show();
}

void CoreModel::clock(const Inputs& in) {
  const bool reset_now = reset_due_;
  reset_due_ = in.rst;
  if (reset_now) return reset();
  ++cycles_;
  const bool cut = motion_.stop().cut;
  const MotionCore::Inputs motion_in = motion_inputs(in.pins);
  const QueueWatermarks::Inputs watermark_in = watermark_inputs();
  clock_commands(cut);
  clock_registers(in, motion_.probe_trips(motion_in));
  if (config_.clock_all || watermark_in.setting.set || !watermarks_.quiet(watermark_in))
    watermarks_.clock(watermark_in);
  motion_.clock(motion_in);
  record(cut);
  show();
}

// The register file looks at a few signals in every clock, at all others only while it is at work.
void CoreModel::clock_registers(const Inputs& in, bool probe) {
  if (in.request || probe) awake_ = kAwake;
  if (awake_ == 0 && !config_.clock_all) return registers_.advance(1);
  register_in_.request = in.request;
  register_in_.write = in.write;
  register_in_.partial = in.partial;
  register_in_.port = in.port;
  register_in_.address = in.address;
  register_in_.data = in.data;
  register_in_.probe = probe;
  const bool quiet = registers_.quiet(register_in_);
  registers_.clock(register_in_);
  register_in_.request = false;
  awake_ = quiet && awake_ != 0 ? awake_ - 1 : quiet ? 0 : kAwake;
}

// What the register file looks at in every clock.
std::uint64_t CoreModel::watched() const {
  const Sequencer::Outputs& s = motion_.sequencer().outputs();
  const StopControl::Outputs& stop = motion_.stop();
  const CommandChecker::Outputs& checker = checker_.outputs();
  const bool flags[] = {motion_.outputs().busy,
                        s.direct,
                        s.path_active,
                        s.feed_active,
                        s.ended,
                        stop.stopping,
                        checker.partial,
                        checker.refuse,
                        stop.stop,
                        motion_.time().ratio == 0,
                        motion_.commands().mark(),
                        watermarks_.outputs().geometry_low,
                        watermarks_.outputs().feed_low,
                        motion_.underrun().shown,
                        s.stale,
                        motion_.probe().probed(),
                        motion_.probe().missed(),
                        motion_.sequencer().waits_for_input()};
  std::uint64_t bits = stop.fault;
  for (const bool flag : flags) bits = bits << 1 | (flag ? 1 : 0);
  return bits;
}

void CoreModel::run(std::uint64_t clocks, std::uint16_t pins) {
  Inputs none;
  none.pins = pins;
  while (clocks != 0) {
    const std::uint64_t gone = jump(clocks, pins);
    if (gone == 0) clock(none);
    clocks -= gone == 0 ? 1 : gone;
  }
}

std::uint64_t CoreModel::jump(std::uint64_t limit, std::uint16_t pins) {
  if (reset_due_ || awake_ != 0 || !checker_.quiet()) return 0;
  if (!geometry_queue_.quiet() || !feed_queue_.quiet() || !watermarks_.quiet(watermark_inputs())) return 0;
  const std::uint64_t gone = motion_.jump(limit, motion_inputs(pins), cycles_, record_);
  if (gone == 0) return 0;
  cycles_ += gone;
  registers_.advance(gone);
  show();
  return gone;
}

MotionCore::Inputs CoreModel::motion_inputs(std::uint16_t pins) const {
  const RegisterFile::Outputs& set = registers_.outputs();
  MotionCore::Inputs in;
  in.setting = set.setting;
  in.abort = set.abort;
  in.clear_fault = set.clear_fault;
  in.probe_clear = set.probe_clear;
  in.geometry_empty = geometry_queue_.outputs().empty;
  in.feed_empty = feed_queue_.outputs().empty;
  in.geometry_word = geometry_queue_.outputs().word;
  in.feed_word = feed_queue_.outputs().word;
  const CommandChecker::Outputs& checker = checker_.outputs();
  in.arrival = {checker.drop,        checker.geometry_commit, checker.geometry_write,
                checker.feed_commit, checker.feed_write,      checker.halfword};
  in.full = geometry_queue_.outputs().room < kMaxGeometry || feed_queue_.outputs().room < kMaxFeed;
  in.start = set.start;
  in.start_mask = set.start_mask;
  in.loader_data = set.loader_data;
  in.pins = pins;
  return in;
}

QueueWatermarks::Inputs CoreModel::watermark_inputs() const {
  return {registers_.outputs().setting, geometry_queue_.outputs().room, feed_queue_.outputs().room};
}

// The queues take the checker's outputs as they stood before the edge, the checker the queues' rooms.
void CoreModel::clock_commands(bool cut) {
  const RegisterFile::Outputs& set = registers_.outputs();
  const CommandChecker::Outputs was = checker_.outputs();
  CommandChecker::Inputs in;
  in.write = set.stream_write;
  in.word = set.stream_word;
  in.flush = set.flush;
  in.clear = cut;
  in.closed = motion_.stop().closed;
  in.geometry_room = geometry_queue_.outputs().room;
  in.feed_room = feed_queue_.outputs().room;
  const bool all = config_.clock_all || cut;
  const bool quiet = checker_.quiet();
  if (all || in.write || in.flush || !quiet) checker_.clock(in);
  const Sequencer& s = motion_.sequencer();
  if (all || !quiet || s.geometry_read() || !geometry_queue_.quiet())
    geometry_queue_.clock(
        {false, cut, was.geometry_write, was.halfword, was.geometry_commit, was.drop, s.geometry_read()});
  if (all || !quiet || s.feed_read() || !feed_queue_.quiet())
    feed_queue_.clock({false, cut, was.feed_write, was.halfword, was.feed_commit, was.drop, s.feed_read()});
}

// What the register file sees of the card, as it stands now.
void CoreModel::gather() {
  RegisterFile::Inputs& in = register_in_;
  const Sequencer::Outputs& s = motion_.sequencer().outputs();
  in.busy = motion_.outputs().busy;
  in.direct = s.direct;
  in.path_active = s.path_active;
  in.feed_active = s.feed_active;
  in.ended = s.ended;
  in.stopping = motion_.stop().stopping;
  in.underrun = motion_.underrun().shown;
  in.underruns = motion_.underrun().underruns;
  in.stale = s.stale;
  in.stale_ticks = motion_.sequencer().streaming().ticks;
  in.incomplete = checker_.outputs().partial;
  in.geometry_room = geometry_queue_.outputs().room;
  in.feed_room = feed_queue_.outputs().room;
  in.geometry_low = watermarks_.outputs().geometry_low;
  in.feed_low = watermarks_.outputs().feed_low;
  in.geometry_begun = s.geometry_begun;
  in.feed_begun = s.feed_begun;
  in.rate = motion_.feed().rate;
  in.ratio = motion_.time().ratio;
  for (unsigned n = 0; n < config_.axes; ++n) in.position[n] = motion_.position(n);
  in.fault = motion_.stop().fault;
  in.stop = motion_.stop().stop;
  in.mark = motion_.commands().mark();
  in.probed = motion_.probe().probed();
  in.probe_missed = motion_.probe().missed();
  in.waiting = motion_.sequencer().waits_for_input();
  in.inputs = motion_.commands().levels();
  in.outputs = motion_.commands().outputs();
  in.marks = motion_.commands().marks();
  in.checker_ready = checker_.outputs().ready;
  in.checker_refuse = checker_.outputs().refuse;
  in.checker_reason = checker_.outputs().reason;
  in.checker_number = checker_.outputs().number;
  const DirectLoader::Outputs& loader = motion_.loader();
  in.start_done = loader.done;
  in.start_error = loader.error;
  in.start_reason = loader.reason;
  in.loader_address = loader.address;
}

void CoreModel::show() {
  const Sequencer::Outputs& s = motion_.sequencer().outputs();
  const MotionCore::Outputs& m = motion_.outputs();
  answer_ = {registers_.outputs().ack, registers_.outputs().error, registers_.outputs().data};
  out_.step = m.step;
  out_.dir = m.dir;
  out_.output = motion_.commands().outputs();
  out_.irq = registers_.outputs().irq;
  out_.tick = s.tick;
  out_.path_tick = motion_.engines().path_tick;
  out_.path_swap = s.swap;
  out_.feed_swap = s.feed_swap;
  out_.path_step = m.path_step;
  out_.path_dir = m.path_dir;
  out_.geometry_room = geometry_queue_.outputs().room;
  out_.feed_room = feed_queue_.outputs().room;
  const std::uint64_t watched_now = watched();
  if (watched_now != watched_) awake_ = kAwake;
  watched_ = watched_now;
  if (awake_ != 0 || config_.clock_all) {
    gather();
    out_.status = registers_.status(register_in_);
  }
  out_.fault = motion_.stop().fault;
  out_.geometry_begun = s.geometry_begun;
  out_.feed_begun = s.feed_begun;
  out_.ratio = motion_.time().ratio;
  out_.rate = motion_.feed().rate;
}

void CoreModel::record(bool cut) {
  if (cut) record_.cut();
  const CommandChecker::Outputs& checker = checker_.outputs();
  if (checker.geometry_commit || checker.feed_commit) record_.accepted(checker_.counts_in_geometry());
  // Positions change only while an axis is busy.
  if (motion_.outputs().axis_busy != 0 || config_.clock_all) {
    for (unsigned n = 0; n < config_.axes; ++n) record_.pin(cycles_, n, motion_.position(n));
  }
  if (motion_.engines().path_tick) record_.arc_tick();
  if (motion_.chord_tick()) record_.chord_tick(cycles_);
  // The last tick of a path is its own, though the next one begins in the same clock. On an arc in chords feed ticks
  // make no step.
  const Sequencer& s = motion_.sequencer();
  if (s.outputs().tick) record_.tick(cycles_);
  const MotionCore::Outputs& m = motion_.outputs();
  for (std::uint32_t n = 0, left = m.path_step; left != 0; ++n, left >>= 1) {
    if ((left & 1) == 0) continue;
    const bool backwards = (m.path_dir >> n & 1) != 0;
    if ((m.engine_step >> n & 1) != 0)
      record_.arc_step(cycles_, n, backwards);
    else
      record_.line_step(cycles_, n, backwards);
  }
  record_.outputs(cycles_, motion_.commands().outputs());
  if (s.record().command) record_.command_begins();
  if (s.record().direct) record_.direct_begins();
}

}  // namespace trammel::model
