#include "trammel/model/register_file.hpp"

namespace trammel::model {

namespace {

using card_map::Access;
using card_map::Reason;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint32_t kByteInWord = 3;
constexpr std::uint32_t kRamWords = 256;
constexpr std::uint32_t kResetWalk = kRamWords + 1;  // one word a clock, and the last one's own clock
constexpr std::uint32_t kSnapshotWords = 6;          // beside the positions

bool writable(Access access) {
  return access == Access::ClearOnes || access == Access::Setting || access == Access::Command;
}

bool in_limits(const card_map::Register& entry, std::uint32_t word) {
  if (entry.limited == 0) return true;
  std::uint32_t mask = entry.limited;
  std::uint32_t value = word & mask;
  for (; (mask & 1) == 0; mask >>= 1) value >>= 1;
  return value >= entry.minimum && value <= entry.maximum;
}

}  // namespace

RegisterFile::RegisterFile(const Config& config) : config_(config) {
  for (const card_map::Register& entry : card_map::kRegisters) {
    for (std::uint32_t i = 0; i < entry.count; ++i) stored(entry.address + i * entry.stride) = entry.reset;
  }
  stored(reg::kAxes) = config_.axes;
  stored(reg::kClockHz) = config_.clock_hz;
  stored(reg::kGeometryDepth) = config_.geometry_depth;
  stored(reg::kFeedDepth) = config_.feed_depth;
  show_settings();
  walk_ = kResetWalk;
}

void RegisterFile::reset() { *this = RegisterFile(config_); }

void RegisterFile::clock(const Inputs& in) {
  const bool walking = walk_ != 0;
  const std::uint32_t access_address = address_;
  const std::uint32_t fault = (out_.fault & ~clearing_[1]) | in.fault;
  const bool irq = interrupt(in);
  step_loader(in);
  clearing_ = {out_.clear_fault, clearing_[0]};
  clear_pulses();
  if (snapshot_pending_) take_snapshot(in);
  if (write_pending_) effect();
  step_access(in);
  settle_refusal(in, access_address);
  out_.fault = fault;
  out_.irq = irq;
  if (walking) --walk_;
  ++time_;
}

bool RegisterFile::quiet(const Inputs& in) const {
  const bool pulses = out_.ack || out_.stream_write || out_.abort || out_.flush || out_.start || out_.clear_fault != 0;
  const bool underway = snapshot_pending_ || write_pending_ || walk_ != 0 || clearing_[0] != 0 || clearing_[1] != 0 ||
                        loading_ || loader_read_.valid || out_.loader_valid;
  const bool events = in.request || in.door_refuse || (in.fault & ~out_.fault) != 0;
  return stage_ == Stage::Idle && !pulses && !underway && !events && out_.irq == interrupt(in);
}

void RegisterFile::clear_pulses() {
  out_.ack = false;
  out_.error = false;
  out_.data = 0;
  out_.clear_fault = 0;
  out_.stream_write = false;
  out_.abort = false;
  out_.flush = false;
  out_.start = false;
}

std::uint32_t RegisterFile::status(const Inputs& in) const {
  std::uint32_t status = 0;
  if (in.busy) status |= field::kStatusBusy;
  if (in.direct) status |= field::kStatusDirect;
  if (in.path_active) status |= field::kStatusPathActive;
  if (in.feed_active) status |= field::kStatusFeedActive;
  if (in.ratio == 0) status |= field::kStatusHeld;
  if (in.ended) status |= field::kStatusEnded;
  if (out_.fault != 0) status |= field::kStatusFaulted;
  if (refusal_ != 0) status |= field::kStatusRefused;
  if (walk_ != 0) status |= field::kStatusSnapshot;
  if (in.incomplete) status |= field::kStatusIncomplete;
  return status;
}

bool RegisterFile::interrupt(const Inputs& in) const {
  // IRQ_ENABLE has the bits of STATUS, but its bit for busy means idle.
  const std::uint32_t causes = status(in) ^ field::kStatusBusy;
  return (causes & stored(reg::kIrqEnable)) != 0;
}

std::uint32_t RegisterFile::live(const Inputs& in) const {
  switch (address_) {
    case reg::kStatus:
      return status(in);
    case reg::kFault:
      return out_.fault;
    case reg::kRefusal:
      return refusal_;
    case reg::kGeometryRoom:
      return in.geometry_room;
    case reg::kFeedRoom:
      return in.feed_room;
    default:
      return std::uint32_t{in.running_feed} << field::kRunningFeedShift | in.running_geometry;
  }
}

Reason RegisterFile::judge(bool direct) const {
  if (slot_.entry == nullptr || (address_ & kByteInWord) != 0) return Reason::UnknownAddress;
  const card_map::Register& entry = *slot_.entry;
  if (entry.only_present_axes && slot_.index >= config_.axes) return Reason::UnknownAddress;
  if (!write_) return entry.access == Access::Command ? Reason::WriteOnly : Reason::None;
  if (!writable(entry.access)) return Reason::ReadOnly;
  if (partial_) return Reason::PartialWrite;
  if ((word_ & ~entry.mask) != 0 || !in_limits(entry, word_)) return Reason::BadValue;
  if (address_ == reg::kStream && direct) return Reason::Busy;
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
      reason_ = judge(in.direct);
      const bool past_walk = slot_.entry != nullptr && slot_.entry->access == Access::Live;
      if (walk_ == 0 || past_walk) stage_ = Stage::Act;
      break;
    }
    case Stage::Act:
      act(in);
      break;
    case Stage::Respond:
      finish(false, answer_);
      break;
    case Stage::Send:
      if (in.door_ready) {
        out_.stream_write = true;
        stage_ = Stage::Sent;
      }
      break;
    case Stage::Sent:
      word_refused_ = false;
      stage_ = Stage::Judge;
      break;
    case Stage::Judge:
      word_refused_ = word_refused_ || in.door_refuse;
      if (in.door_ready) finish(word_refused_);
      break;
    case Stage::Load:
      if (!in.start_done) break;
      if (in.start_error) own_refusal_ = in.start_reason;
      finish(in.start_error);
      break;
  }
}

void RegisterFile::begin(const Inputs& in) {
  write_ = in.write;
  partial_ = in.partial;
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
    own_refusal_ = static_cast<std::uint8_t>(reason_);
    finish(true);
    return;
  }
  const Access access = slot_.entry->access;
  if (!write_) {
    answer_ = access == Access::Live || access == Access::ClearOnes ? live(in) : stored(address_);
    stage_ = Stage::Respond;
    return;
  }
  if (address_ == reg::kStream) {
    stage_ = Stage::Send;
    return;
  }
  if (address_ == reg::kStart) {
    out_.start = true;
    stage_ = Stage::Load;
    return;
  }
  write_pending_ = true;
  finish(false);
}

void RegisterFile::effect() {
  write_pending_ = false;
  if (slot_.entry->access == Access::Setting) {
    stored(address_) = word_;
    show_settings();
  }
  if (address_ == reg::kControl) {
    out_.abort = (word_ & field::kControlAbort) != 0;
    out_.flush = (word_ & field::kControlFlush) != 0;
    snapshot_pending_ = (word_ & field::kControlSnapshot) != 0;
  }
  if (address_ == reg::kFault) out_.clear_fault = word_;
  if (address_ == reg::kRefusal) clear_refusal_ = word_ != 0;
}

void RegisterFile::take_snapshot(const Inputs& in) {
  snapshot_pending_ = false;
  stored(reg::kSnapTimeLo) = static_cast<std::uint32_t>(time_);
  stored(reg::kSnapTimeHi) = static_cast<std::uint32_t>(time_ >> 32);
  stored(reg::kSnapStatus) = status(in);
  stored(reg::kSnapRate) = in.rate;
  stored(reg::kSnapRatio) = in.ratio;
  stored(reg::kSnapRunning) = std::uint32_t{in.running_feed} << field::kRunningFeedShift | in.running_geometry;
  for (std::uint32_t n = 0; n < config_.axes; ++n) stored(reg::snap_position(n)) = in.position[n];
  walk_ = kSnapshotWords + config_.axes;
}

void RegisterFile::finish(bool error, std::uint32_t data) {
  out_.ack = true;
  out_.error = error;
  out_.data = data;
  stage_ = Stage::Idle;
}

void RegisterFile::settle_refusal(const Inputs& in, std::uint32_t access_address) {
  std::uint32_t refusal = 0;
  if (own_refusal_ != 0) refusal = own_refusal_;
  if (in.door_refuse) refusal = std::uint32_t{in.door_number} << field::kRefusalCommandShift | in.door_reason;
  if (clear_refusal_) refusal_ = 0;
  if (refusal != 0 && refusal_ == 0) refusal_ = access_address << field::kRefusalAddressShift | refusal;
  own_refusal_ = 0;
  clear_refusal_ = false;
}

void RegisterFile::step_loader(const Inputs& in) {
  out_.loader_valid = loader_read_.valid;
  out_.loader_data = loader_read_.data;
  loader_read_ = {loading_, stored_[in.loader_address]};
  loading_ = (loading_ || out_.start) && !in.start_done;
}

void RegisterFile::show_settings() {
  out_.hold = stored(reg::kHold) != 0;
  out_.ratio = stored(reg::kRatio);
  out_.slew = stored(reg::kSlew);
  out_.hold_limit = stored(reg::kHoldLimit);
  for (std::uint32_t n = 0; n < config_.axes; ++n) {
    out_.step_length[n] = static_cast<std::uint16_t>(stored(reg::step_length(n)));
    out_.step_space[n] = static_cast<std::uint16_t>(stored(reg::step_space(n)));
    out_.dir_setup[n] = static_cast<std::uint16_t>(stored(reg::dir_setup(n)));
    out_.dir_hold[n] = static_cast<std::uint16_t>(stored(reg::dir_hold(n)));
    out_.mode[n] = static_cast<std::uint8_t>(stored(reg::mode(n)));
  }
}

}  // namespace trammel::model
