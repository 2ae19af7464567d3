// The register file beside its golden model: random accesses of all ports, a random command checker and loader,
// stops, snapshots through a chain of latched words, and resets; every port in every cycle, data whenever it is
// valid.
#pragma once

#include <array>
#include <random>
#include <type_traits>
#include <utility>

#include "Vdut.h"
#include "register_file_inside.hpp"
#include "trammel/model/register_file.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace trammel::lockstep {

using model::RegisterFile;
using IdleLevel = std::remove_reference_t<decltype(Vdut::idle_level_i)>;
namespace reg = card_map::reg;

constexpr std::uint32_t kAxes = TRAMMEL_AXES;
constexpr std::uint32_t kPorts = TRAMMEL_PORTS;
constexpr std::uint32_t kFaultBits = 0x3FF;
constexpr std::uint64_t kComparedSignals = 20;
constexpr bool kMachineInputs = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kMachineInputs);
constexpr bool kStreaming = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kStreaming);
constexpr bool kPathCommands = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kPathCommands);
constexpr bool kCaptures = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kCaptures);
constexpr bool kCaptureFifo = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kCaptureFifo);
constexpr std::uint64_t kFilled = kCaptures        ? 700
                                  : kMachineInputs ? 500
                                                   : 300;  // clocks after reset, longer than the filling
// The words that the direct loader reads: from its first register to START.
constexpr std::uint32_t kFirstDirect = card_map::reg::frequency_lo(kAxes - 1) / 4;
constexpr std::uint32_t kDirectWords = card_map::reg::kStart / 4 - kFirstDirect;
// RATIO, RATE, FEED_BEGUN and GEOMETRY_BEGUN come before the positions on the snapshot chain.
constexpr std::size_t kBeforePositions = 4;

inline RegisterFile::Config configuration() {
  RegisterFile::Config config;
  config.axes = kAxes;
  config.ports = kPorts;
  config.engines = TRAMMEL_ENGINES;
  config.inputs = 7;
  config.outputs = 16;
  config.idle_level = 0x9C35 & ((1U << 2 * kAxes) - 1);
  config.geometry_depth = TRAMMEL_GEOMETRY_DEPTH;
  config.feed_depth = TRAMMEL_FEED_DEPTH;
  config.build_id = TRAMMEL_BUILD_ID;
  config.build_dirty = true;
  config.board_id = TRAMMEL_BOARD_ID;
  return config;
}

class Bench {
 public:
  explicit Bench(std::uint64_t seed, int state = state_seed())
      : checker_("register_file", seed), random_(seed), rtl_(state), model_(configuration()) {
    const RegisterFile::Config config = configuration();
    rtl_->clock_hz_i = config.clock_hz;
    rtl_->idle_level_i = static_cast<IdleLevel>(config.idle_level);
    reset();
    in_ = {};
    in_.ratio = 0x10000;
  }

  // One clock of reset, with random other inputs; pending requests are dropped.
  void reset() {
    in_.incomplete = false;
    in_.passed = 0;
    rtl_->rst_i = 1;
    drive();
    rtl_.clock();
    rtl_->rst_i = 0;
    model_.reset();
    checker_.event("reset");
    outstanding_ = false;
    checker_wait_ = 0;
    start_wait_ = 0;
    flushed_ = streamed_ = false;
    chain_.fill({});
    in_.request = in_.stop = in_.rest = in_.probe = in_.mark = in_.start_done = in_.checker_refuse = false;
    in_.captures = told_ = held_ = 0;
    in_.checker_ready = true;
    compare();
  }

  void clock() {
    drive();
    rtl_->eval();  // a unit that withdraws its request is not told in this clock
    more("captured", get(rtl_->capture_answer_o, trammel::bus::capture_answer::kCaptured),
         model_.captured(in_.captures));
    const std::uint64_t snapshot = rtl_->snapshot_o;
    for (std::size_t i = chain_.size(); i-- > 1;) chain_[i].clock(snapshot, latched_value(i), chain_[i - 1]);
    chain_[0].clock(snapshot, latched_value(0));
    rtl_.clock();
    model_.clock(in_);
    compare();
  }

  // The first clock of an access with all other inputs at rest.
  void ask(bool write, std::uint32_t address, std::uint32_t data) {
    in_.request = true;
    in_.write = write;
    in_.address = address;
    in_.data = data;
    in_.partial = false;
    checker_.event(write ? "write" : "read", address);
    clock();
    in_.request = false;
  }

  // A whole access; returns the data read.
  std::uint32_t access(bool write, std::uint32_t address, std::uint32_t data) {
    ask(write, address, data);
    while (!model_.outputs().ack) clock();
    access_refused_ = model_.outputs().error;
    const std::uint32_t answer = model_.outputs().data;
    clock();
    return answer;
  }

  // Unit 0 requests until it is told; with `mark`, a MARK comes in the first clock of the request.
  void capture(bool mark) {
    in_.captures = 1;
    in_.mark = mark;
    for (bool told = false; !told; in_.mark = false) {
      told = model_.captured(in_.captures) != 0;
      clock();
    }
    in_.captures = 0;
    for (std::uint32_t i = 0; i < 2 * kAxes + 40; ++i) clock();
  }

  void random_clock() {
    random_state();
    random_checker();
    random_loader();
    random_access();
    // Nothing moves before the registers are filled, so no stop comes. A stop is more likely in the clock of an
    // answer, to meet the events of a write.
    in_.stop = model_.time() > kFilled && chance(model_.outputs().ack ? 20 : 300);
    if (in_.stop) checker_.event("stop");
    if (chance(1000)) marks_every_ = chance(3) ? 5 + draw() % 20 : 300;
    in_.rest = model_.time() > kFilled && chance(300);
    if (in_.rest) checker_.event("rest");
    in_.mark = kPathCommands && model_.time() > kFilled && chance(marks_every_);
    if (in_.mark) checker_.event("mark");
    // Not during the stop's snapshot: the probe is off then.
    stopped_for_ = in_.stop ? 0 : stopped_for_ + 1;
    in_.probe = kPathCommands && model_.time() > kFilled && stopped_for_ > kAxes + 11 && chance(in_.rest ? 2 : 300);
    if (in_.probe) checker_.event("probe");
    random_captures();
    if (chance(reset_every())) {
      reset();
    } else {
      clock();
    }
  }

  // Sets the time of both to `clocks`.
  void skip_to(std::uint64_t clocks) {
    const std::uint64_t more = clocks - model_.time();
    model_.state().time += more;
    advance_time(*rtl_, more);
  }

  bool refused() const { return access_refused_; }
  bool link_lost() const { return model_.link().lost(); }
  Checker& checker() { return checker_; }
  std::uint64_t expected() const { return kComparedSignals * checker_.cycles() + more_; }

 private:
  std::uint32_t draw() { return static_cast<std::uint32_t>(random_()); }
  bool chance(std::uint32_t one_in) { return draw() % one_in == 0; }

  // More frequent while something is under way that a reset must stop, and in the clocks after another reset.
  std::uint32_t reset_every() const {
    const bool acts = in_.write && (in_.address == reg::kStream || in_.address == reg::kStart ||
                                    in_.address == reg::kFault || in_.address == reg::kControl);
    if (model_.time() < 8) return 20;
    return start_wait_ != 0 || (outstanding_ && acts) ? 60 : 3000;
  }

  std::uint32_t latched_value(std::size_t place) {
    if (place >= kBeforePositions) return in_.position[place - kBeforePositions];
    // REST has the ticks left in the place of the first two words.
    const bool rest = get(rtl_->snapshot_o, trammel::bus::snapshot::kRest) != 0;
    const std::uint32_t values[] = {rest ? static_cast<std::uint32_t>(in_.ticks_left >> 32) : in_.ratio,
                                    rest ? static_cast<std::uint32_t>(in_.ticks_left) : in_.rate, in_.feed_begun,
                                    in_.geometry_begun};
    return values[place];
  }

  // A unit requests until it is told, or withdraws the request. A capture that it hands on stays in its area until
  // the queue has taken it.
  void random_captures() {
    if (!kCaptures || model_.time() <= kFilled) return;
    in_.passed = static_cast<std::uint8_t>(in_.passed & ~model_.queued(in_.passed));
    if (kCaptureFifo && told_ != 0 && chance(2)) held_ = static_cast<std::uint8_t>(held_ | told_);
    const std::uint8_t passes = chance(4) ? held_ : 0;
    held_ = static_cast<std::uint8_t>(held_ & ~passes);
    in_.passed = static_cast<std::uint8_t>(in_.passed | passes);
    in_.edges = static_cast<std::uint8_t>(draw());
    in_.captures = static_cast<std::uint8_t>(in_.captures & ~told_);
    if (chance(200)) in_.captures = static_cast<std::uint8_t>(in_.captures & draw());
    if (chance(captures_every_)) in_.captures = static_cast<std::uint8_t>(in_.captures | 1U << draw() % 4);
    if (chance(3000)) captures_every_ = chance(3) ? 5 + draw() % 20 : 300;
    in_.captures = static_cast<std::uint8_t>(in_.captures & ~(held_ | in_.passed));
    told_ = model_.captured(in_.captures);
  }

  trammel::model::InputRoles random_roles() {
    const std::uint32_t bits = draw();
    return {static_cast<std::uint8_t>(draw()),
            static_cast<std::uint8_t>(draw()),
            static_cast<std::uint8_t>(draw()),
            (bits & 1) != 0,
            (bits & 2) != 0,
            (bits & 4) != 0,
            (bits & 8) != 0};
  }

  void random_state() {
    if (!chance(8)) return;
    const std::uint32_t bits = draw();
    in_.busy = (bits & 1) != 0;
    in_.direct = (bits & 0x0E) == 0;
    in_.path_active = (bits & 0x10) != 0;
    in_.feed_active = (bits & 0x20) != 0;
    in_.ended = (bits & 0x40) != 0;
    in_.incomplete = streamed_ && (bits & 0x80) != 0;
    in_.stopping = (bits & 0x100) != 0;
    in_.underrun = (bits & 0x200) != 0;
    in_.underruns = draw();
    in_.stale = kStreaming && (bits & 0x800) != 0;
    in_.stale_ticks = kStreaming ? draw() : 0;
    in_.limit_state = kMachineInputs ? draw() & 0xFFFFFFF : 0;
    in_.place = draw() & 0xFFFF;
    in_.button_hold = kMachineInputs && (bits & 0x1000) != 0;
    in_.geometry_room = static_cast<std::uint16_t>(draw());
    in_.feed_room = static_cast<std::uint16_t>(draw());
    in_.geometry_low = (bits & 0x200) != 0;
    in_.feed_low = (bits & 0x400) != 0;
    in_.geometry_begun = draw();
    in_.feed_begun = draw();
    in_.inputs = draw();
    in_.raw_inputs = draw();
    in_.capture_state = kCaptures ? draw() : 0;
    in_.roles = random_roles();
    in_.outputs = static_cast<std::uint16_t>(draw());
    in_.marks = draw();
    in_.probed = chance(2);
    in_.probe_missed = chance(2);
    in_.waiting = chance(2);
    in_.settled = chance(2);
    in_.enabled = (bits & 0x2000) != 0;
    in_.enable_waits = (bits & 0x4000) != 0;
    in_.ticks_left = (std::uint64_t{draw()} << 32 | draw()) >> 24;
    in_.rate = draw();
    in_.ratio = chance(3) ? 0 : draw() % 0x10001;
    in_.fault = chance(2) ? 0 : draw() & kFaultBits;
    for (std::uint32_t n = 0; n < kAxes; ++n) in_.position[n] = draw();
  }

  // The checker answers a word some clocks after its write, with ready; a flush may refuse an incomplete command.
  void random_checker() {
    in_.checker_refuse = flushed_ && chance(2);
    flushed_ = model_.outputs().flush;
    in_.checker_reason = static_cast<std::uint8_t>(1 + draw() % 15);
    in_.checker_number = static_cast<std::uint8_t>(draw());
    streamed_ = streamed_ || model_.outputs().stream_write;
    if (model_.outputs().stream_write) checker_wait_ = 2 + draw() % 6;
    in_.checker_ready = checker_wait_ < 2 || model_.outputs().stream_write;
    if (checker_wait_ == 1) in_.checker_refuse = chance(3);
    if (checker_wait_ != 0) --checker_wait_;
  }

  void random_loader() {
    if (model_.outputs().start) start_wait_ = 1 + draw() % 40;
    // The direct loader reads only its own registers, never words that a snapshot may be writing.
    in_.loader_address = static_cast<std::uint16_t>(kFirstDirect + draw() % kDirectWords);
    in_.start_done = start_wait_ == 1;
    in_.start_error = chance(2);
    in_.start_reason = chance(2) ? 8 : chance(2) ? 12 : 15;
    if (start_wait_ != 0) --start_wait_;
  }

  void random_access() {
    in_.request = false;
    if (model_.outputs().ack) {
      outstanding_ = false;
      refused_ = model_.outputs().error;
      return;
    }
    if (outstanding_ || chance(3)) return;
    outstanding_ = true;
    in_.request = true;
    in_.write = chance(2);
    in_.partial = chance(20);
    // A host that was refused often reads the reason.
    const bool looks = refused_ && chance(3);
    if (!looks) in_.port = static_cast<std::uint8_t>(draw() % kPorts);
    in_.write = in_.write && !looks;
    in_.address = looks ? reg::kRefusal : random_address();
    in_.data = random_data(in_.address);
    in_.of_session = !chance(10);
    in_.new_session = in_.of_session && chance(30);
    // Refusals are often cleared, so that first ones occur (a write of 0 clears nothing); snapshots are often
    // requested.
    if (!looks && chance(5)) write_register(reg::kRefusal, chance(3) ? 0 : 1U << draw() % 28);
    if (!looks && chance(20)) write_register(reg::kControl, card_map::field::kControlSnapshot);
    if (!looks && kCaptureFifo && chance(drops_every_)) write_register(reg::kCaptureNext, oldest());
    checker_.event(in_.write ? "write" : "read", in_.address);
  }

  // Mostly the number that drops the oldest capture. The queue is sometimes full and sometimes empty.
  std::uint32_t oldest() {
    if (chance(50)) drops_every_ = chance(2) ? 10 : 100;
    const std::uint32_t queue = model_.state().queue.word();
    return chance(5) ? draw() % 16
                     : (queue & card_map::field::kCaptureQueueOldest) >> card_map::field::kCaptureQueueOldestShift;
  }

  void write_register(std::uint32_t address, std::uint32_t data) {
    in_.write = true;
    in_.partial = false;
    in_.address = address;
    in_.data = data;
  }

  std::uint32_t random_address() {
    if (chance(20)) return draw() & 0xFFF;
    constexpr std::uint32_t kOften[] = {reg::kRefusal, reg::kControl, reg::kStream, reg::kStart};
    if (kCaptureFifo && chance(8)) return chance(2) ? reg::kCaptureQueue : reg::kCaptureHeadFault + 4 * (draw() % 16);
    if (chance(10)) return kOften[draw() % std::size(kOften)];
    const card_map::Register& entry = card_map::kRegisters[draw() % card_map::kRegisters.size()];
    const std::uint32_t stray = chance(40) ? 1 + draw() % 3 : 0;
    return card_map::slot_address(entry, draw() % entry.count) + stray;
  }

  // Mostly a value that the register accepts, including its limits.
  std::uint32_t random_data(std::uint32_t address) {
    const card_map::Slot slot = card_map::find_register(address & ~3u);
    if (slot.entry == nullptr || chance(8)) return draw();
    const card_map::Register& entry = *slot.entry;
    if (chance(10)) return 1u << draw() % 32;
    if (entry.limited != 0 && chance(3)) return (chance(2) ? entry.minimum : entry.maximum) + draw() % 3 - 1;
    if (entry.limited != 0 && entry.mask == entry.limited) return draw() % (entry.maximum + 1);
    return draw() & entry.mask;
  }

  void drive() {
    drive_access();
    drive_state();
    namespace stream = trammel::bus::stream_answer;
    rtl_->stream_answer_i = static_cast<IData>(
        in_place(stream::kPartial, in_.incomplete) | in_place(stream::kReady, in_.checker_ready) |
        in_place(stream::kRefuse, in_.checker_refuse) | in_place(stream::kNumber, in_.checker_number) |
        in_place(stream::kReason, in_.checker_reason));
    namespace start = trammel::bus::start_answer;
    rtl_->start_answer_i =
        static_cast<IData>(in_place(start::kDone, in_.start_done) | in_place(start::kError, in_.start_error) |
                           in_place(start::kReason, in_.start_reason) | in_place(start::kAddress, in_.loader_address));
    rtl_->stop_i = in_.stop;
    rtl_->rest_i = in_.rest;
    rtl_->probe_i = in_.probe;
    rtl_->mark_i = in_.mark;
    namespace capture = trammel::bus::capture;
    rtl_->capture_i = in_place(capture::kAsk, in_.captures) | in_place(capture::kPassed, in_.passed) |
                      in_place(capture::kEdge, in_.edges) | in_place(capture::kState, in_.capture_state);
    rtl_->snapshot_i = in_place(trammel::bus::snapshot::kWord, chain_.back().word());
  }

  void drive_access() {
    using namespace trammel::bus::register_access;
    rtl_->access_i = in_place(kRequest, in_.request) | in_place(kPort, in_.port) | in_place(kWrite, in_.write) |
                     in_place(kPartial, in_.partial) | in_place(kAddress, in_.address) | in_place(kData, in_.data) |
                     in_place(kOfSession, in_.of_session) | in_place(kNewSession, in_.new_session);
  }

  void drive_state() {
    rtl_->busy_i = in_.busy;
    namespace time = trammel::bus::time_state;
    put(rtl_->time_state_i, time::kFault, in_.fault);
    put(rtl_->time_state_i, time::kFeedBegun, in_.feed_begun);
    put(rtl_->time_state_i, time::kUnderruns, in_.underruns);
    put(rtl_->time_state_i, time::kUnderrun, in_.underrun);
    put(rtl_->time_state_i, time::kLimitState, in_.limit_state);
    put(rtl_->time_state_i, time::kPlace, in_.place);
    put(rtl_->time_state_i, time::kButtonHold, in_.button_hold);
    put(rtl_->time_state_i, time::kHeld, in_.ratio == 0);
    put(rtl_->time_state_i, time::kFeedActive, in_.feed_active);
    put(rtl_->time_state_i, time::kStopping, in_.stopping);
    put(rtl_->time_state_i, time::kSettled, in_.settled);
    put(rtl_->time_state_i, time::kEnabled, in_.enabled);
    put(rtl_->time_state_i, time::kEnableWaits, in_.enable_waits);
    namespace geometry = trammel::bus::geometry_state;
    namespace pins = trammel::bus::pins_state;
    put(rtl_->geometry_state_i, geometry::kGeometryBegun, in_.geometry_begun);
    put(rtl_->pins_state_i, pins::kInputs, in_.inputs);
    put(rtl_->pins_state_i, pins::kOutputs, in_.outputs);
    put(rtl_->pins_state_i, pins::kMarks, in_.marks);
    put(rtl_->geometry_state_i, geometry::kStaleTicks, in_.stale_ticks);
    put(rtl_->geometry_state_i, geometry::kStale, in_.stale);
    put(rtl_->pins_state_i, pins::kProbed, in_.probed);
    put(rtl_->pins_state_i, pins::kProbeMissed, in_.probe_missed);
    put(rtl_->geometry_state_i, geometry::kWaiting, in_.waiting);
    put(rtl_->geometry_state_i, geometry::kPathActive, in_.path_active);
    put(rtl_->geometry_state_i, geometry::kEnded, in_.ended);
    put(rtl_->geometry_state_i, geometry::kDirect, in_.direct);
    put_inputs(rtl_->inputs_i, 0, in_.raw_inputs, 0);
    rtl_->roles_i = roles_wire(in_.roles);
    namespace queues = trammel::bus::queue_state;
    rtl_->queue_state_i = in_place(queues::kGeometryLow, in_.geometry_low) | in_place(queues::kFeedLow, in_.feed_low) |
                          in_place(queues::kGeometryRoom, in_.geometry_room) |
                          in_place(queues::kFeedRoom, in_.feed_room);
  }

  void compare() {
    checker_.next_cycle();
    const RegisterFile::Outputs& out = model_.outputs();
    namespace answer = trammel::bus::register_answer;
    namespace setting = trammel::bus::setting_bus;
    namespace snapshot = trammel::bus::snapshot;
    namespace start = trammel::bus::start;
    checker_.compare("ack", get(rtl_->answer_o, answer::kAck), out.ack);
    checker_.compare("error", get(rtl_->answer_o, answer::kError), out.error);
    checker_.compare("data", get(rtl_->answer_o, answer::kData), out.data);
    checker_.compare("status_o", rtl_->status_o, model_.status(in_));
    checker_.compare("irq_o", rtl_->irq_o, out.irq);
    checker_.compare("clear_fault_o", rtl_->clear_fault_o, out.clear_fault);
    namespace capture = trammel::bus::capture_answer;
    checker_.compare("captured", get(rtl_->capture_answer_o, capture::kCaptured), model_.captured(in_.captures));
    checker_.compare("queued", get(rtl_->capture_answer_o, capture::kQueued), model_.queued(in_.passed));
    checker_.compare("full", get(rtl_->capture_answer_o, capture::kFull), model_.state().queue.full());
    checker_.compare("session_gone_o", rtl_->session_gone_o, model_.link().gone());
    checker_.compare("link_lost_o", rtl_->link_lost_o, model_.link().lost());
    checker_.compare("abort_o", rtl_->abort_o, out.abort);
    checker_.compare("probe_clear_o", rtl_->probe_clear_o, out.probe_clear);
    checker_.compare("flush_o", rtl_->flush_o, out.flush);
    checker_.compare("filling_o", rtl_->filling_o, model_.filling());
    checker_.compare("stream_write_o", rtl_->stream_write_o, out.stream_write);
    checker_.compare("start", get(rtl_->start_o, start::kStart), out.start);
    checker_.compare("setting_o, set", get(rtl_->setting_o, setting::kSet), out.setting.set);
    checker_.compare("snapshot_o, strobe", get(rtl_->snapshot_o, snapshot::kStrobe), out.strobe);
    checker_.compare("snapshot_o, shift at rest", get(rtl_->snapshot_o, snapshot::kShift) & ~(rtl_->status_o >> 8), 0U);
    if (out.setting.set) more("setting_o", rtl_->setting_o, wire(out.setting));
    if (out.stream_write) more("setting_o, word", get(rtl_->setting_o, setting::kData), out.stream_word);
    if (out.start) more("start_o, mask", get(rtl_->start_o, start::kMask), out.start_mask);
    if (out.loader_valid) more("start_o, data", get(rtl_->start_o, start::kData), out.loader_data);
  }

  void more(const char* signal, std::uint64_t rtl, std::uint64_t model) {
    checker_.compare(signal, rtl, model);
    ++more_;
  }

  Checker checker_;
  std::mt19937_64 random_;
  Simulated<Vdut> rtl_;
  RegisterFile model_;
  RegisterFile::Inputs in_;
  std::array<SnapshotWord, kBeforePositions + kAxes> chain_;
  std::uint64_t more_ = 0;
  bool flushed_ = false;
  bool streamed_ = false;        // a stream word since reset
  bool refused_ = false;         // the last access was refused
  bool access_refused_ = false;  // the last access() was refused
  std::uint32_t checker_wait_ = 0;
  std::uint32_t start_wait_ = 0;
  std::uint32_t marks_every_ = 300;
  std::uint32_t captures_every_ = 300;
  std::uint32_t drops_every_ = 10;  // one in this many accesses drops a capture
  std::uint8_t told_ = 0;           // the units that were told in the last clock
  std::uint8_t held_ = 0;           // those of them that will hand on a capture
  std::uint32_t stopped_for_ = 0;   // clocks since the last stop
  bool outstanding_ = false;
};

}  // namespace trammel::lockstep
