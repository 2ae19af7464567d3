#include "trammel/model/register_file.hpp"

namespace trammel::model {

namespace {

using card_map::Access;
using card_map::Area;
using card_map::Reason;
namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint32_t kByteInWord = 3;
// After a reset, accesses wait for this many clocks until the registers are filled: one clock per RAM word written.
std::uint64_t fill_clocks(std::uint32_t engines, std::uint32_t axes) {
  const bool inputs = card_map::has_engine(engines, card_map::engine::kMachineInputs);
  if (card_map::has_engine(engines, card_map::engine::kCaptures)) return axes > 4 ? 615 : 451;
  if (axes > 4) return inputs || card_map::has_engine(engines, card_map::engine::kEnables) ? 483 : 257;
  return inputs ? 355 : 257;
}

// The value of register ROLES.
std::uint32_t roles_word(const InputRoles& roles) {
  std::uint32_t word = roles.limit_minus << field::kRolesLimitMinusShift;
  word |= std::uint32_t{roles.limit_plus} << field::kRolesLimitPlusShift;
  word |= std::uint32_t{roles.drive_fault} << field::kRolesDriveFaultShift;
  if (roles.feed_hold) word |= field::kRolesFeedHold;
  if (roles.cycle_start) word |= field::kRolesCycleStart;
  if (roles.tool_setter) word |= field::kRolesToolSetter;
  if (roles.probe) word |= field::kRolesProbe;
  return word;
}

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

RegisterFile::RegisterFile(const Config& config) : config_(config) {
  state_.snapshot = SnapshotWriter(config.axes);
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
  const card_map::CardShape shape{config_.engines, config_.axes,    config_.ports,
                                  config_.inputs,  config_.outputs, config_.captures};
  card_map::put_descriptors(shape, [&](std::uint32_t address, std::uint32_t word) { stored(address) = word; });
}

void RegisterFile::reset() { *this = RegisterFile(config_); }

// The last word needs one clock more.
bool RegisterFile::filling() const { return state_.time + 1 < fill_clocks(config_.engines, config_.axes); }

void RegisterFile::clock(const Inputs& in) {
  const bool irq = interrupt(in);
  const bool asked = state_.snapshot_asked;
  const bool enable_set = state_.out.setting.set && state_.out.setting.address == reg::kIrqEnable;
  const Setting setting = state_.out.setting;
  if (state_.snapshot.strobe()) take_values(in);
  step_link();
  step_loader(in);
  clear_events();
  refuse_checked(in);
  step_access(in);
  step_queue(in, setting);
  step_snapshot(in, asked);
  if (enable_set) state_.irq_enable = setting.data;
  state_.out.irq = irq;
  ++state_.time;
}

void RegisterFile::clear_events() {
  state_.out.ack = false;
  state_.out.error = false;
  state_.out.data = 0;
  state_.out.setting.set = false;
  state_.out.clear_fault = 0;
  state_.out.stream_write = false;
  state_.out.abort = false;
  state_.out.probe_clear = false;
  state_.out.flush = false;
  state_.out.start = false;
  state_.snapshot_asked = false;
}

std::uint32_t RegisterFile::status(const Inputs& in) const {
  bool refused = false;
  for (const std::uint32_t refusal : state_.refusal) refused = refused || refusal != 0;
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
  if (state_.snapshot.busy()) status |= field::kStatusSnapshot;
  if (in.incomplete) status |= field::kStatusIncomplete;
  if (in.stopping) status |= field::kStatusStopping;
  if (in.geometry_low) status |= field::kStatusGeometryLow;
  if (in.feed_low) status |= field::kStatusFeedLow;
  if (in.underrun) status |= field::kStatusUnderrun;
  if (in.probed) status |= field::kStatusProbed;
  if (in.probe_missed) status |= field::kStatusProbeMissed;
  if (in.waiting) status |= field::kStatusWaiting;
  if (in.stale) status |= field::kStatusStale;
  if (in.button_hold) status |= field::kStatusButtonHold;
  if (in.settled) status |= field::kStatusSettled;
  if (in.enabled) status |= field::kStatusEnabled;
  if (in.enable_waits) status |= field::kStatusEnableWaits;
  return status;
}

bool RegisterFile::interrupt(const Inputs& in) const {
  // IRQ_ENABLE has the bits of STATUS, except that its bit for busy means idle.
  return state_.irq_enable != 0 && ((status(in) ^ field::kStatusBusy) & state_.irq_enable) != 0;
}

std::uint32_t RegisterFile::live(const Inputs& in) const {
  switch (state_.address) {
    case reg::kStatus:
      return status_for(in, state_.refusal[state_.port] != 0);
    case reg::kFault:
      return in.fault;
    case reg::kRefusal:
      return state_.refusal[state_.port];
    case reg::kGeometryRoom:
      return in.geometry_room;
    case reg::kFeedRoom:
      return in.feed_room;
    case reg::kGeometryBegun:
      return in.geometry_begun;
    case reg::kInputs:
      return in.inputs;
    case reg::kRawInputs:
      return in.raw_inputs;
    case reg::kRoles:
      return roles_word(in.roles);
    case reg::kOutputs:
      return in.outputs;
    case reg::kMarks:
      return in.marks;
    case reg::kFeedBegun:
      return in.feed_begun;
    case reg::kStaleTicks:
      return in.stale_ticks;
    case reg::kLimitState:
      return in.limit_state;
    case reg::kPlace:
      return in.place;
    case reg::kCaptureState:
      return in.capture_state;
    case reg::kCaptureQueue:
      return state_.queue.word();
    case reg::kUnderruns:
      return in.underruns;
    default:
      // A live register without a case here. If the RTL lacks its branch too, it shows UNDERRUNS: a mismatch.
      return 0;
  }
}

Reason RegisterFile::judge(const Inputs& in) const {
  if (state_.slot.entry == nullptr || (state_.address & kByteInWord) != 0) return Reason::UnknownAddress;
  const card_map::Register& entry = *state_.slot.entry;
  if (!card_map::has_engine(config_.engines, entry.engine)) return Reason::UnknownAddress;
  if (entry.only_present_axes && state_.slot.index >= config_.axes) return Reason::UnknownAddress;
  if (!state_.write) return entry.access == Access::Command ? Reason::WriteOnly : Reason::None;
  return judge_write(in);
}

Reason RegisterFile::judge_write(const Inputs& in) const {
  const card_map::Register& entry = *state_.slot.entry;
  if (!writable(entry.access)) return Reason::ReadOnly;
  if (state_.partial) return Reason::PartialWrite;
  const std::uint32_t meaning = card_map::bits_with_meaning(entry, config_.engines);
  if ((state_.word & ~meaning) != 0 || !in_limits(entry, state_.word)) return Reason::BadValue;
  const bool owned_by_another = in.incomplete && state_.stream_owner != state_.port;
  if (state_.address == reg::kStream && (in.direct || owned_by_another)) return Reason::Busy;
  return Reason::None;
}

void RegisterFile::step_access(const Inputs& in) {
  switch (state_.stage) {
    case Stage::Idle:
      if (in.request) begin(in);
      break;
    case Stage::Decode:
      state_.stage = Stage::Wait;
      break;
    case Stage::Wait: {
      state_.reason = judge(in);
      const bool needs_ram =
          state_.write || state_.reason == Reason::UnknownAddress || !reads_live(state_.slot.entry->access);
      const bool ram_taken = state_.time < fill_clocks(config_.engines, config_.axes) || state_.snapshot.busy();
      if (!needs_ram || !ram_taken) {
        state_.stage = Stage::Act;
        // One clock before the other events, so that the checker's refusal comes with the answer. With an abort it is
        // not needed.
        const std::uint32_t orders = state_.word & (field::kControlFlush | field::kControlAbort);
        state_.out.flush = state_.write && state_.reason == Reason::None && state_.address == reg::kControl &&
                           orders == field::kControlFlush;
      }
      break;
    }
    case Stage::Act:
      act(in);
      break;
    case Stage::Respond:
      finish(false, state_.answer);
      break;
    case Stage::Sent:
      state_.stage = Stage::Judge;
      break;
    case Stage::Judge:
      state_.word_refused = state_.word_refused || in.checker_refuse;
      if (in.checker_ready) finish(state_.word_refused);
      break;
    case Stage::Load:
      if (!in.start_done) break;
      if (in.start_error) refuse(in.start_reason);
      finish(in.start_error);
      break;
  }
}

void RegisterFile::begin(const Inputs& in) {
  state_.write = in.write;
  state_.partial = in.partial;
  state_.port = in.port;
  state_.address = in.address;
  state_.of_session = in.of_session;
  state_.new_session = in.new_session;
  state_.slot = card_map::find_register(state_.address & ~kByteInWord);
  if (state_.write) {
    state_.word = in.data;
    state_.out.stream_word = state_.word;
    state_.out.start_mask = static_cast<std::uint8_t>(state_.word);
  }
  state_.stage = Stage::Decode;
}

void RegisterFile::act(const Inputs& in) {
  if (state_.reason != Reason::None) {
    refuse(static_cast<std::uint8_t>(state_.reason));
    finish(true);
    return;
  }
  if (!state_.write) {
    state_.answer = reads_live(state_.slot.entry->access) ? live(in) : read(state_.address);
    state_.stage = Stage::Respond;
    return;
  }
  if (state_.address == reg::kStream) {
    state_.out.stream_write = true;
    state_.stream_owner = state_.port;
    state_.word_refused = false;
    state_.stage = Stage::Sent;
    return;
  }
  if (state_.address == reg::kStart) {
    state_.out.start = true;
    state_.stage = Stage::Load;
    return;
  }
  take_effect();
  finish(false);
}

void RegisterFile::take_effect() {
  if (state_.slot.entry->access == Access::Setting) {
    stored(state_.address) = state_.word;
    state_.out.setting = {true, state_.address, state_.word};
  }
  if (state_.address == reg::kSetPlace || state_.address == reg::kCaptureClear || state_.address == reg::kCaptureNext)
    state_.out.setting = {true, state_.address, state_.word};
  if (state_.address == reg::kControl) {
    state_.out.abort = (state_.word & field::kControlAbort) != 0;
    state_.out.probe_clear = (state_.word & field::kControlProbeClear) != 0;
    state_.snapshot_asked = (state_.word & field::kControlSnapshot) != 0;
  }
  if (state_.address == reg::kFault) state_.out.clear_fault = state_.word;
  if (state_.address == reg::kRefusal && state_.word != 0) state_.refusal[state_.port] = 0;
}

void RegisterFile::finish(bool error, std::uint32_t data) {
  state_.out.ack = true;
  state_.out.error = error;
  state_.out.data = data;
  state_.stage = Stage::Idle;
}

// The first refusal of a port stays until it is cleared.
void RegisterFile::refuse(std::uint8_t reason, std::uint8_t number) {
  std::uint32_t& refusal = state_.refusal[state_.port];
  if (refusal != 0) return;
  refusal =
      state_.address << field::kRefusalAddressShift | std::uint32_t{number} << field::kRefusalCommandShift | reason;
}

// A refusal by the checker belongs to the access that caused it: a word of the stream, or a flush that is answered in
// this clock.
void RegisterFile::refuse_checked(const Inputs& in) {
  if (in.checker_refuse) refuse(in.checker_reason, in.checker_number);
}

void RegisterFile::step_snapshot(const Inputs& in, bool host) {
  if (const std::optional<std::uint32_t> word = state_.snapshot.word()) {
    const std::size_t place = written_at(*word);
    state_.stored[static_cast<std::uint32_t>(state_.snapshot.area()) / 4 + place] = state_.latched[place];
  }
  SnapshotWriter::Requests requests;
  requests.host = host;
  requests.stop = in.stop;
  requests.rest = in.rest;
  requests.probe = in.probe;
  requests.mark = in.mark;
  requests.captures = in.captures;
  state_.snapshot.clock(requests);
  state_.out.strobe = state_.snapshot.strobe();
}

void RegisterFile::step_queue(const Inputs& in, const Setting& setting) {
  if (!card_map::has_engine(config_.engines, card_map::engine::kCaptureFifo)) return;
  constexpr Area kAreas[] = {Area::Capture0, Area::Capture1, Area::Capture2, Area::Capture3};
  const unsigned unit = CaptureFifo::unit_of(in.passed);
  const std::uint32_t* area = unit < 4 ? &stored(static_cast<std::uint32_t>(kAreas[unit])) : nullptr;
  state_.queue.clock({in.passed, in.edges, setting}, area);
}

// All registers that are not live.
std::uint32_t RegisterFile::read(std::uint32_t address) const {
  constexpr auto kHead = static_cast<std::uint32_t>(Area::CaptureHead);
  const bool of_head = address >= kHead && address < kHead + 4 * CaptureFifo::kWords;
  return of_head ? state_.queue.oldest((address - kHead) / 4) : stored(address);
}

// The position in its area of the `word`th word written: the time, the positions from the last one down, then the
// words below the time.
std::size_t RegisterFile::written_at(std::uint32_t word) const {
  const std::size_t time = in_area(reg::time_lo(Area::Snap));
  if (word < 2) return time - word;
  const std::size_t below =
      word - 2 < config_.axes ? in_area(reg::position(Area::Snap, config_.axes - 1)) : time - 2 + config_.axes;
  return below - (word - 2);
}

void RegisterFile::take_values(const Inputs& in) {
  state_.latched[in_area(reg::fault(Area::Snap))] = in.fault;
  state_.latched[in_area(reg::status(Area::Snap))] = status(in) & ~field::kStatusSnapshot;
  // REST holds the ticks left in the place of ratio and rate.
  const bool rest = state_.snapshot.area() == Area::Rest;
  state_.latched[in_area(reg::ratio(Area::Snap))] = rest ? static_cast<std::uint32_t>(in.ticks_left >> 32) : in.ratio;
  state_.latched[in_area(reg::rate(Area::Snap))] = rest ? static_cast<std::uint32_t>(in.ticks_left) : in.rate;
  state_.latched[in_area(reg::feed_begun(Area::Snap))] = in.feed_begun;
  state_.latched[in_area(reg::geometry_begun(Area::Snap))] = in.geometry_begun;
  state_.latched[in_area(reg::time_hi(Area::Snap))] = static_cast<std::uint32_t>(state_.time >> 32);
  state_.latched[in_area(reg::time_lo(Area::Snap))] = static_cast<std::uint32_t>(state_.time);
  for (std::uint32_t n = 0; n < config_.axes; ++n)
    state_.latched[in_area(reg::position(Area::Snap, n))] = in.position[n];
}

// Passes on the answer of this clock. Units follow the clock counter as the card sees it, two clocks late.
void RegisterFile::step_link() {
  LinkWatch::Inputs link;
  link.ack = state_.out.ack;
  link.error = state_.out.error;
  link.write = state_.write;
  link.address = state_.address;
  link.port = state_.port;
  link.of_session = state_.of_session;
  link.new_session = state_.new_session;
  link.setting = state_.out.setting;
  link.unit = link_unit(state_.time);
  state_.link.clock(link);
}

void RegisterFile::step_loader(const Inputs& in) {
  state_.out.loader_valid = state_.loader_read.valid;
  state_.out.loader_data = state_.loader_read.data;
  state_.loader_read = {state_.loading, state_.stored[in.loader_address]};
  state_.loading = (state_.loading || state_.out.start) && !in.start_done;
}

}  // namespace trammel::model
