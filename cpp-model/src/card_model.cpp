#include "trammel/model/card_model.hpp"

#include <stdexcept>

namespace trammel::model {

namespace {

// Clocks that the host side stays awake behind its last activity: settings reach the shapers' own registers.
constexpr int kAwake = 4;
// From a path's take to its step before the shaper.
constexpr std::uint64_t kTakeToStep = 4;

}  // namespace

bool CardModel::Outputs::operator==(const Outputs& o) const {
  return step == o.step && dir == o.dir && irq == o.irq && tick == o.tick && path_tick == o.path_tick &&
         path_swap == o.path_swap && feed_swap == o.feed_swap && path_step == o.path_step && path_dir == o.path_dir &&
         geometry_room == o.geometry_room && feed_room == o.feed_room && status == o.status && fault == o.fault &&
         running == o.running && ratio == o.ratio && rate == o.rate;
}

CardModel::CardModel(const Config& config)
    : config_(config),
      registers_({config.axes, config.geometry_depth, config.feed_depth, config.clock_hz}),
      door_(config.axes),
      geometry_queue_(config.geometry_depth),
      feed_queue_(config.feed_depth),
      loader_(config.axes),
      hold_timer_(registers_.outputs().hold_limit),
      axes_(config.axes) {
  if (config.axes < 1 || config.axes > kMaxAxes) throw std::invalid_argument("a card has 1 to 8 axes");
  reset();
}

void CardModel::reset() {
  port_ = Axi4LitePort();
  registers_.reset();
  CommandDoor::Inputs door_reset;
  door_reset.reset = true;
  door_.clock(door_reset);
  geometry_queue_ = HalfwordQueue(config_.geometry_depth);
  feed_queue_ = HalfwordQueue(config_.feed_depth);
  loader_ = DirectLoader(config_.axes);
  sequencer_ = Sequencer();
  time_base_ = TimeBase();
  feed_ = FeedGenerator();
  prescaler_ = PulseGenerator();
  accumulator_ = DeviationAccumulator();
  router_ = ArcRouter();
  hold_timer_ = HoldTimer(registers_.outputs().hold_limit);
  busy_timer_ = BusyTimer();
  axes_.assign(config_.axes, Axis());
  any_live_ = faulted_ = running_ = false;
  cycles_ = 0;
  awake_ = kAwake;
  accepted_ = command_ = path_taken_ = arc_taken_ = 0;
  geometry_numbers_.clear();
  takes_ = {};
  shown_position_ = {};
  axis_state_ = AxisBits{};
  restless_ = 0;
  refresh_settings();
  show();
}

void CardModel::refresh_settings() {
  const RegisterFile::Outputs& set = registers_.outputs();
  for (std::size_t n = 0; n < axes_.size(); ++n) {
    StepShaper::Inputs& shaper = axis_in_[n].shaper;
    shaper.step_length = set.step_length[n];
    shaper.step_space = set.step_space[n];
    shaper.dir_setup = set.dir_setup[n];
    shaper.dir_hold = set.dir_hold[n];
    shaper.mode = set.mode[n];
  }
  time_in_ = {set.ratio, set.slew, set.hold};
}

// All that the register file sees of the card, as it stands in front of this edge.
void CardModel::gather_register_inputs() {
  RegisterFile::Inputs& in = register_in_;
  const Axi4LitePort::Outputs& port = port_.outputs();
  in.request = port.request;
  in.write = port.write;
  in.partial = port.partial;
  in.address = port.address;
  in.data = port.data;
  const Sequencer::Outputs& s = sequencer_.outputs();
  in.busy = busy_timer_.busy();
  in.direct = s.direct;
  in.path_active = s.path_active;
  in.feed_active = s.feed_active;
  in.ended = s.ended;
  in.geometry_room = geometry_queue_.outputs().room;
  in.feed_room = feed_queue_.outputs().room;
  in.running_geometry = s.geometry_number;
  in.running_feed = s.feed_number;
  in.rate = feed_.outputs().rate;
  in.ratio = time_base_.outputs().ratio;
  for (std::size_t n = 0; n < axes_.size(); ++n) in.position[n] = axes_[n].shaper().outputs().position;
  in.fault = faults_now();
  const CommandDoor::Outputs& door = door_.outputs();
  in.incomplete = door.partial;
  in.door_ready = door.ready;
  in.door_refuse = door.refuse;
  in.door_reason = door.reason;
  in.door_number = door.number;
  const DirectLoader::Outputs& loader = loader_.outputs();
  in.start_done = loader.done;
  in.start_error = loader.error;
  in.start_reason = loader.reason;
  in.loader_address = loader.address;
}

std::uint32_t CardModel::faults_now() const {
  const Sequencer::Outputs& s = sequencer_.outputs();
  return axis_state_.fault | (s.mismatch ? card_map::field::kFaultTickMismatch : 0) |
         (s.incomplete ? card_map::field::kFaultPathIncomplete : 0);
}

// The few signals at which the register file looks in every clock.
std::uint32_t CardModel::watched() const {
  const Sequencer::Outputs& s = sequencer_.outputs();
  return faults_now() | (busy_timer_.busy() ? 1U << 16 : 0) | (s.ended ? 1U << 17 : 0) |
         (door_.outputs().partial ? 1U << 18 : 0);
}

Sequencer::Inputs CardModel::sequencer_inputs() const {
  Sequencer::Inputs in;
  const DirectLoader::Outputs& loader = loader_.outputs();
  in.abort = registers_.outputs().abort;
  in.geometry_empty = geometry_queue_.outputs().empty;
  in.geometry_word = geometry_queue_.outputs().word;
  in.feed_empty = feed_queue_.outputs().empty;
  in.feed_word = feed_queue_.outputs().word;
  in.direct_word = loader.word;
  in.direct_axis = loader.axis;
  in.direct_increment = loader.increment;
  in.direct_steps = loader.steps;
  in.direct_length = loader.length;
  in.direct_go = loader.go;
  in.direct_mask = loader.mask;
  in.enable = time_base_.outputs().enable;
  in.feed_tick = feed_.outputs().tick;
  in.axes_live = any_live_;
  in.prescaler_step = prescaler_.outputs().step;
  in.engine_ready = accumulator_.outputs().ready;
  in.engine_at_end = accumulator_.outputs().at_end;
  in.faulted = faulted_;
  return in;
}

// Axes and what feeds them, from the sequencer's outputs in front of the edge; each consumer before its producer.
void CardModel::clock_axes() {
  const Sequencer::Outputs& s = sequencer_.outputs();
  const LoadBus& load = sequencer_.load();
  const RegisterFile::Outputs& set = registers_.outputs();
  any_live_ = axis_state_.live != 0;
  faulted_ = set.fault != 0 || axis_state_.fault != 0;
  busy_timer_.clock(running_);
  running_ = !s.idle || s.direct || axis_state_.busy != 0;

  ext_step_ = router_.step();
  const bool common = s.tick || s.swap || set.abort || set.clear_fault != 0 || awake_ != 0;
  std::uint32_t due = common ? ~0U : load.increment | load.steps | ext_step_ | restless_;
  for (unsigned n = 0; due != 0 && n < axes_.size(); ++n, due >>= 1) {
    if ((due & 1) == 0) continue;
    const std::uint32_t bit = 1U << n;
    Axis& axis = axes_[n];
    Axis::Inputs& in = axis_in_[n];
    PulseGenerator::Inputs& generator = in.generator;
    generator.clear = set.abort;
    generator.tick = s.tick;
    generator.swap = s.swap;
    generator.active = (s.active & bit) != 0;
    generator.counted = generator.mirror = s.direct;
    generator.load_increment = (load.increment & bit) != 0;
    generator.load_count = (load.steps & bit) != 0;
    generator.word = load.word;
    in.ext_step = (ext_step_ & bit) != 0;
    in.ext_dir = (router_.dir() & bit) != 0;
    in.shaper.hold_tick = hold_timer_.tick();
    in.shaper.clear_fault = (set.clear_fault & bit) != 0;
    axis.clock(in);
    axis_state_.show(bit, axis.outputs());
    AxisBits::set(restless_, bit, !axis.quiet());
    if (steps_ != nullptr) report_pin_step(n);
  }
  hold_timer_.clock(set.hold_limit);

  const bool plane = (load.deviation & 0x100) != 0;
  const bool path_tick = sequencer_.path_tick();
  if (ext_step_ != 0 || plane || !accumulator_.quiet()) router_.clock(plane, load.word, accumulator_.outputs());
  if (path_tick || s.arc_start || load.deviation != 0 || set.abort || !accumulator_.quiet()) {
    accumulator_.clock({false, load.deviation, load.word, s.arc_start, path_tick, set.abort});
  }
  if (s.tick || s.swap || load.prescale || set.abort || !prescaler_.quiet()) {
    prescaler_.clock({set.abort, s.tick, s.swap, s.prescaler, false, false, load.prescale, false, load.word});
  }
}

void CardModel::clock_time() {
  const Sequencer::Outputs& s = sequencer_.outputs();
  const LoadBus& load = sequencer_.feed_load();
  feed_.clock({s.feed_clear, s.feed_enable, load.feed, load.word, s.feed_swap});
  time_base_.clock(time_in_);
}

// Door and queues. The queues take the door's outputs in front of the edge, the door the queues' rooms.
void CardModel::clock_commands(bool geometry_read, bool feed_read) {
  const RegisterFile::Outputs& set = registers_.outputs();
  const CommandDoor::Outputs door = door_.outputs();
  if (awake_ != 0) {
    CommandDoor::Inputs in;
    in.write = set.stream_write;
    in.word = set.stream_word;
    in.flush = set.flush;
    in.clear = set.abort;
    in.geometry_room = geometry_queue_.outputs().room;
    in.feed_room = feed_queue_.outputs().room;
    door_.clock(in);
  }
  if (awake_ != 0 || geometry_read || !geometry_queue_.quiet()) {
    geometry_queue_.clock(
        {false, set.abort, door.geometry_write, door.halfword, door.geometry_commit, door.drop, geometry_read});
  }
  if (awake_ != 0 || feed_read || !feed_queue_.quiet()) {
    feed_queue_.clock({false, set.abort, door.feed_write, door.halfword, door.feed_commit, door.drop, feed_read});
  }
}

void CardModel::clock_host(const Inputs& in) {
  const RegisterFile::Outputs& set = registers_.outputs();
  Axi4LitePort::Inputs bus;
  bus.awvalid = in.awvalid;
  bus.awaddr = in.awaddr;
  bus.wvalid = in.wvalid;
  bus.wdata = in.wdata;
  bus.wstrb = in.wstrb;
  bus.bready = in.bready;
  bus.arvalid = in.arvalid;
  bus.araddr = in.araddr;
  bus.rready = in.rready;
  bus.ack = set.ack;
  bus.error = set.error;
  bus.data = set.data;
  port_.clock(bus);
  registers_.clock(register_in_);
  refresh_settings();
  if (!registers_.quiet(register_in_) || !door_.quiet() || !port_.quiet(bus)) awake_ = kAwake;
}

void CardModel::clock(const Inputs& in) {
  const bool reset_now = reset_due_;
  reset_due_ = in.rst;
  if (reset_now) {
    reset();
    return;
  }
  ++cycles_;
  const std::uint32_t watch = watched();
  if (watch != watched_ || in.awvalid || in.wvalid || in.arvalid || in.bready || in.rready) awake_ = kAwake;
  watched_ = watch;
  if (awake_ != 0) gather_register_inputs();

  const Sequencer::Inputs sequencer_in = sequencer_inputs();
  const bool geometry_read = sequencer_.geometry_read();
  const bool feed_read = sequencer_.feed_read();
  if (sequencer_in.abort) {
    accepted_ = 0;
    geometry_numbers_.clear();
  }
  loader_.clock({false, busy_timer_.busy() || !sequencer_.go(), registers_.outputs().start,
                 registers_.outputs().start_mask, registers_.outputs().loader_data});
  clock_axes();
  clock_time();
  clock_commands(geometry_read, feed_read);
  sequencer_.clock(sequencer_in);
  if (awake_ != 0) {
    --awake_;
    clock_host(in);
  } else {
    registers_.advance(1);
  }
  record();
  show();
}

void CardModel::show() {
  const Sequencer::Outputs& s = sequencer_.outputs();
  out_.step = axis_state_.step;
  out_.dir = axis_state_.dir;
  out_.irq = registers_.outputs().irq;
  out_.tick = s.tick;
  out_.path_tick = sequencer_.path_tick();
  out_.path_swap = s.swap;
  out_.feed_swap = s.feed_swap;
  out_.path_step = axis_state_.path_step;
  out_.path_dir = axis_state_.path_dir;
  out_.geometry_room = geometry_queue_.outputs().room;
  out_.feed_room = feed_queue_.outputs().room;
  out_.status = (busy_timer_.busy() ? 1U : 0) | (s.direct ? 2U : 0) | (s.path_active ? 4U : 0) |
                (s.feed_active ? 8U : 0) | (s.ended ? 16U : 0) | (door_.outputs().partial ? 32U : 0);
  out_.fault = registers_.outputs().fault;
  out_.running = static_cast<std::uint32_t>(s.geometry_number) | static_cast<std::uint32_t>(s.feed_number) << 8;
  out_.ratio = time_base_.outputs().ratio;
  out_.rate = feed_.outputs().rate;
}

void CardModel::record() {
  const CommandDoor::Outputs& door = door_.outputs();
  if (awake_ != 0 && (door.geometry_commit || door.feed_commit)) {
    if (door.geometry_commit) geometry_numbers_.push_back(accepted_);
    ++accepted_;
  }
  if (sequencer_.path_tick()) ++arc_taken_;
  // The last tick of a path is its own, though the next one begins in the same clock.
  if (sequencer_.took()) takes_[++take_index_ % takes_.size()] = {cycles_, command_, ++path_taken_};
  if (axis_state_.path_step != 0 && steps_ != nullptr) report_path_steps(axis_state_.path_step);
  if (sequencer_.began_command() && !geometry_numbers_.empty()) {
    command_ = geometry_numbers_.front();
    geometry_numbers_.pop_front();
    path_taken_ = arc_taken_ = 0;
  }
  if (sequencer_.began_direct()) command_ = path_taken_ = 0;
}

void CardModel::report_path_steps(std::uint32_t steps) {
  Take take;
  for (const Take& candidate : takes_) {
    if (candidate.cycle + kTakeToStep == cycles_) take = candidate;
  }
  for (unsigned n = 0; n < axes_.size(); ++n) {
    if ((steps >> n & 1) == 0) continue;
    const int direction = (axis_state_.path_dir >> n & 1) != 0 ? -1 : 1;
    if ((ext_step_ >> n & 1) != 0)
      steps_->path_step(command_, arc_taken_, n, direction);
    else
      steps_->path_step(take.command, take.tick, n, direction);
  }
}

void CardModel::report_pin_step(unsigned axis) {
  const std::uint32_t position = axes_[axis].shaper().outputs().position;
  if (position == shown_position_[axis]) return;
  steps_->pin_step(cycles_, axis, static_cast<std::int32_t>(position - shown_position_[axis]));
  shown_position_[axis] = position;
}

}  // namespace trammel::model
