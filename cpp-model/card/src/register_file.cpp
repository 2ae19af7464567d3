#include "trammel/model/register_file.hpp"

namespace trammel::model {

namespace {

using card_map::Access;
using card_map::Area;
using card_map::Reason;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint32_t kByteInWord = 3;
// From reset on accesses wait so long for the registers to be filled: a clock for each word of the RAM that is written.
constexpr std::uint64_t kFillClocks = 257;

bool writable(Access access) {
  return access == Access::ClearOnes || access == Access::Setting || access == Access::Command;
}

bool reads_live(Access access) { return access == Access::Live || access == Access::ClearOnes; }

bool in_limits(const card_map::Register& entry, std::uint32_t word) {
  if (entry.limited == 0) return true;
  std::uint32_t mask = entry.limited;
  std::uint32_t value = word & mask;
  for (; (mask & 1) == 0; mask >>= 1) value >>= 1;
  return value >= entry.minimum && value <= entry.maximum;
}

std::size_t in_area(std::uint32_t address) { return (address - static_cast<std::uint32_t>(Area::Snap)) / 4; }

}  // namespace

RegisterFile::RegisterFile(const Config& config) : config_(config), snapshot_(config.axes) {
  for (const card_map::Register& entry : card_map::kRegisters) {
    for (std::uint32_t i = 0; i < entry.count; ++i) stored(card_map::slot_address(entry, i)) = entry.reset;
  }
  stored(reg::kAxes) = config_.axes;
  stored(reg::kClockHz) = config_.clock_hz;
  stored(reg::kGeometryDepth) = config_.geometry_depth;
  stored(reg::kFeedDepth) = config_.feed_depth;
  stored(reg::kBuildId) = config_.build_id;
  stored(reg::kBuildFlags) = config_.build_dirty ? field::kBuildFlagsDirty : 0;
  stored(reg::kBoardId) = config_.board_id;
  const bool pins = card_map::has_engine(config_.engines, card_map::engine::kPathCommands);
  stored(reg::kPorts) = config_.ports | (pins ? config_.inputs << field::kPortsInputsShift : 0) |
                        (pins ? config_.outputs << field::kPortsOutputsShift : 0);
  for (std::uint32_t n = 0; n < config_.axes; ++n) {
    const bool first = (config_.idle_level >> n & 1) != 0;
    const bool second = (config_.idle_level >> (config_.axes + n) & 1) != 0;
    stored(reg::mode(n)) = (first ? field::kModeInvertFirst : 0) | (second ? field::kModeInvertSecond : 0);
  }
  const card_map::CardShape shape{config_.engines, config_.axes, config_.ports, config_.inputs, config_.outputs};
  card_map::put_descriptors(shape, [&](std::uint32_t address, std::uint32_t word) { stored(address) = word; });
}

void RegisterFile::reset() { *this = RegisterFile(config_); }

void RegisterFile::clock(const Inputs& in) {
  const bool irq = interrupt(in);
  const bool asked = snapshot_asked_;
  const bool enable_set = out_.setting.set && out_.setting.address == reg::kIrqEnable;
  const std::uint32_t enable = out_.setting.data;
  if (snapshot_.strobe()) take_values(in);
  step_loader(in);
  clear_events();
  refuse_checked(in);
  step_access(in);
  step_snapshot(in, asked);
  if (enable_set) irq_enable_ = enable;
  out_.irq = irq;
  ++time_;
}

bool RegisterFile::quiet(const Inputs& in) const {
  const bool events = out_.ack || out_.setting.set || out_.stream_write || out_.abort || out_.probe_clear ||
                      out_.flush || out_.start || out_.clear_fault != 0 || snapshot_asked_;
  const bool underway = snapshot_.busy() || loading_ || loader_read_.valid || out_.loader_valid;
  const bool asked = in.request || in.checker_refuse || in.stop || in.probe || in.mark;
  return stage_ == Stage::Idle && !events && !underway && !asked && out_.irq == interrupt(in);
}

void RegisterFile::clear_events() {
  out_.ack = false;
  out_.error = false;
  out_.data = 0;
  out_.setting.set = false;
  out_.clear_fault = 0;
  out_.stream_write = false;
  out_.abort = false;
  out_.probe_clear = false;
  out_.flush = false;
  out_.start = false;
  snapshot_asked_ = false;
}

std::uint32_t RegisterFile::status(const Inputs& in) const {
  bool refused = false;
  for (const std::uint32_t refusal : refusal_) refused = refused || refusal != 0;
  return status_for(in, refused);
}

std::uint32_t RegisterFile::status_for(const Inputs& in, bool refused) const {
  std::uint32_t status = 0;
  if (in.busy) status |= field::kStatusBusy;
  if (in.direct) status |= field::kStatusDirect;
  if (in.path_active) status |= field::kStatusPathActive;
  if (in.feed_active) status |= field::kStatusFeedActive;
  if (in.ratio == 0) status |= field::kStatusHeld;
  if (in.ended) status |= field::kStatusEnded;
  if (in.fault != 0) status |= field::kStatusFaulted;
  if (refused) status |= field::kStatusRefused;
  if (snapshot_.busy()) status |= field::kStatusSnapshot;
  if (in.incomplete) status |= field::kStatusIncomplete;
  if (in.stopping) status |= field::kStatusStopping;
  if (in.geometry_low) status |= field::kStatusGeometryLow;
  if (in.feed_low) status |= field::kStatusFeedLow;
  if (in.underrun) status |= field::kStatusUnderrun;
  if (in.probed) status |= field::kStatusProbed;
  if (in.probe_missed) status |= field::kStatusProbeMissed;
  if (in.waiting) status |= field::kStatusWaiting;
  if (in.stale) status |= field::kStatusStale;
  return status;
}

bool RegisterFile::interrupt(const Inputs& in) const {
  // IRQ_ENABLE has the bits of STATUS, but its bit for busy means idle.
  return ((status(in) ^ field::kStatusBusy) & irq_enable_) != 0;
}

std::uint32_t RegisterFile::live(const Inputs& in) const {
  switch (address_) {
    case reg::kStatus:
      return status_for(in, refusal_[port_] != 0);
    case reg::kFault:
      return in.fault;
    case reg::kRefusal:
      return refusal_[port_];
    case reg::kGeometryRoom:
      return in.geometry_room;
    case reg::kFeedRoom:
      return in.feed_room;
    case reg::kGeometryBegun:
      return in.geometry_begun;
    case reg::kInputs:
      return in.inputs;
    case reg::kOutputs:
      return in.outputs;
    case reg::kMarks:
      return in.marks;
    case reg::kFeedBegun:
      return in.feed_begun;
    case reg::kStaleTicks:
      return in.stale_ticks;
    default:
      return in.underruns;
  }
}

Reason RegisterFile::judge(const Inputs& in) const {
  if (slot_.entry == nullptr || (address_ & kByteInWord) != 0) return Reason::UnknownAddress;
  const card_map::Register& entry = *slot_.entry;
  if (!card_map::has_engine(config_.engines, entry.engine)) return Reason::UnknownAddress;
  if (entry.only_present_axes && slot_.index >= config_.axes) return Reason::UnknownAddress;
  if (!write_) return entry.access == Access::Command ? Reason::WriteOnly : Reason::None;
  return judge_write(in);
}

Reason RegisterFile::judge_write(const Inputs& in) const {
  const card_map::Register& entry = *slot_.entry;
  if (!writable(entry.access)) return Reason::ReadOnly;
  if (partial_) return Reason::PartialWrite;
  const std::uint32_t meaning = card_map::bits_with_meaning(entry, config_.engines);
  if ((word_ & ~meaning) != 0 || !in_limits(entry, word_)) return Reason::BadValue;
  const bool owned_by_another = in.incomplete && stream_owner_ != port_;
  if (address_ == reg::kStream && (in.direct || owned_by_another)) return Reason::Busy;
  return Reason::None;
}

void RegisterFile::step_access(const Inputs& in) {
  switch (stage_) {
    case Stage::Idle:
      if (in.request) begin(in);
      break;
    case Stage::Decode:
      stage_ = Stage::Wait;
      break;
    case Stage::Wait: {
      reason_ = judge(in);
      const bool needs_ram = write_ || reason_ == Reason::UnknownAddress || !reads_live(slot_.entry->access);
      const bool ram_taken = time_ < kFillClocks || snapshot_.busy();
      if (!needs_ram || !ram_taken) {
        stage_ = Stage::Act;
        // A clock before the rest, so that the checker's refusal comes with the answer; an abort makes it idle.
        const std::uint32_t orders = word_ & (field::kControlFlush | field::kControlAbort);
        out_.flush = write_ && reason_ == Reason::None && address_ == reg::kControl && orders == field::kControlFlush;
      }
      break;
    }
    case Stage::Act:
      act(in);
      break;
    case Stage::Respond:
      finish(false, answer_);
      break;
    case Stage::Sent:
      stage_ = Stage::Judge;
      break;
    case Stage::Judge:
      word_refused_ = word_refused_ || in.checker_refuse;
      if (in.checker_ready) finish(word_refused_);
      break;
    case Stage::Load:
      if (!in.start_done) break;
      if (in.start_error) refuse(in.start_reason);
      finish(in.start_error);
      break;
  }
}

void RegisterFile::begin(const Inputs& in) {
  write_ = in.write;
  partial_ = in.partial;
  port_ = in.port;
  address_ = in.address;
  slot_ = card_map::find_register(address_ & ~kByteInWord);
  if (write_) {
    word_ = in.data;
    out_.stream_word = word_;
    out_.start_mask = static_cast<std::uint8_t>(word_);
  }
  stage_ = Stage::Decode;
}

void RegisterFile::act(const Inputs& in) {
  if (reason_ != Reason::None) {
    refuse(static_cast<std::uint8_t>(reason_));
    finish(true);
    return;
  }
  if (!write_) {
    answer_ = reads_live(slot_.entry->access) ? live(in) : stored(address_);
    stage_ = Stage::Respond;
    return;
  }
  if (address_ == reg::kStream) {
    out_.stream_write = true;
    stream_owner_ = port_;
    word_refused_ = false;
    stage_ = Stage::Sent;
    return;
  }
  if (address_ == reg::kStart) {
    out_.start = true;
    stage_ = Stage::Load;
    return;
  }
  take_effect();
  finish(false);
}

void RegisterFile::take_effect() {
  if (slot_.entry->access == Access::Setting) {
    stored(address_) = word_;
    out_.setting = {true, address_, word_};
  }
  if (address_ == reg::kControl) {
    out_.abort = (word_ & field::kControlAbort) != 0;
    out_.probe_clear = (word_ & field::kControlProbeClear) != 0;
    snapshot_asked_ = (word_ & field::kControlSnapshot) != 0;
  }
  if (address_ == reg::kFault) out_.clear_fault = word_;
  if (address_ == reg::kRefusal && word_ != 0) refusal_[port_] = 0;
}

void RegisterFile::finish(bool error, std::uint32_t data) {
  out_.ack = true;
  out_.error = error;
  out_.data = data;
  stage_ = Stage::Idle;
}

// The first refusal of a port stays until it is cleared.
void RegisterFile::refuse(std::uint8_t reason, std::uint8_t number) {
  std::uint32_t& refusal = refusal_[port_];
  if (refusal != 0) return;
  refusal = address_ << field::kRefusalAddressShift | std::uint32_t{number} << field::kRefusalCommandShift | reason;
}

// A refusal by the checker belongs to the access that brought it: a word of the stream, or a flush that is answered in
// this clock.
void RegisterFile::refuse_checked(const Inputs& in) {
  if (in.checker_refuse) refuse(in.checker_reason, in.checker_number);
}

void RegisterFile::step_snapshot(const Inputs& in, bool host) {
  if (const std::optional<std::uint32_t> word = snapshot_.word()) {
    const std::size_t place = written_at(*word);
    stored_[static_cast<std::uint32_t>(snapshot_.area()) / 4 + place] = latched_[place];
  }
  SnapshotWriter::Requests requests;
  requests.host = host;
  requests.stop = in.stop;
  requests.probe = in.probe;
  requests.mark = in.mark;
  snapshot_.clock(requests);
  out_.strobe = snapshot_.strobe();
}

// The place in its area of the word that is written as the `word`th: the time, the positions from the last one down,
// then what stands below the time.
std::size_t RegisterFile::written_at(std::uint32_t word) const {
  const std::size_t time = in_area(reg::time_lo(Area::Snap));
  if (word < 2) return time - word;
  const std::size_t below =
      word - 2 < config_.axes ? in_area(reg::position(Area::Snap, config_.axes - 1)) : time - 2 + config_.axes;
  return below - (word - 2);
}

void RegisterFile::take_values(const Inputs& in) {
  latched_[in_area(reg::fault(Area::Snap))] = in.fault;
  latched_[in_area(reg::status(Area::Snap))] = status(in) & ~field::kStatusSnapshot;
  latched_[in_area(reg::ratio(Area::Snap))] = in.ratio;
  latched_[in_area(reg::rate(Area::Snap))] = in.rate;
  latched_[in_area(reg::feed_begun(Area::Snap))] = in.feed_begun;
  latched_[in_area(reg::geometry_begun(Area::Snap))] = in.geometry_begun;
  latched_[in_area(reg::time_hi(Area::Snap))] = static_cast<std::uint32_t>(time_ >> 32);
  latched_[in_area(reg::time_lo(Area::Snap))] = static_cast<std::uint32_t>(time_);
  for (std::uint32_t n = 0; n < config_.axes; ++n) latched_[in_area(reg::position(Area::Snap, n))] = in.position[n];
}

void RegisterFile::step_loader(const Inputs& in) {
  out_.loader_valid = loader_read_.valid;
  out_.loader_data = loader_read_.data;
  loader_read_ = {loading_, stored_[in.loader_address]};
  loading_ = (loading_ || out_.start) && !in.start_done;
}

}  // namespace trammel::model
