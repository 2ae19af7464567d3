// Lockstep of the register file: random accesses of all ports, a random command checker and loader, stops, snapshots
// through a chain of latched words, and resets; every port in every cycle, data where it means something.
#include "trammel/model/register_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <type_traits>
#include <utility>

#include "Vdut.h"
#include "register_file_inside.hpp"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace {

using trammel::lockstep::Checker;
using trammel::lockstep::Simulated;
using trammel::model::RegisterFile;
using IdleLevel = std::remove_reference_t<decltype(Vdut::idle_level_i)>;
namespace card_map = trammel::card_map;
namespace reg = card_map::reg;

constexpr std::uint32_t kAxes = TRAMMEL_AXES;
constexpr std::uint32_t kPorts = TRAMMEL_PORTS;
constexpr std::uint32_t kFaultBits = 0x3FF;
constexpr std::uint64_t kComparedSignals = 14;
constexpr bool kStreaming = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kStreaming);
constexpr bool kPathCommands = card_map::has_engine(TRAMMEL_ENGINES, card_map::engine::kPathCommands);
constexpr std::uint64_t kFilled = 300;  // clocks after reset, more than the filling takes
constexpr std::uint32_t kFirstDirect = card_map::reg::frequency_lo(7) / 4;  // word of the direct mode's first register
// RATIO, RATE, FEED_BEGUN and GEOMETRY_BEGUN come before the positions on the snapshot chain.
constexpr std::size_t kBeforePositions = 4;

RegisterFile::Config configuration() {
  RegisterFile::Config config;
  config.axes = kAxes;
  config.ports = kPorts;
  config.engines = TRAMMEL_ENGINES;
  config.inputs = 7;
  config.outputs = 16;
  config.idle_level = 0x9C35 & ((1U << 2 * kAxes) - 1);
  config.build_id = 0x1234'5678;
  config.build_dirty = true;
  config.board_id = 0x9ABC'DEF0;
  return config;
}

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("register_file", seed), random_(seed), model_(configuration()) {
    const RegisterFile::Config config = configuration();
    for (std::uint32_t word = 0; word < 16; ++word) rtl_->constants_i[word] = 0;
    constants(reg::kAxes) = config.axes;
    constants(reg::kClockHz) = config.clock_hz;
    constants(reg::kEngines) = config.engines;
    constants(reg::kGeometryDepth) = config.geometry_depth;
    constants(reg::kFeedDepth) = config.feed_depth;
    constants(reg::kBuildId) = config.build_id;
    constants(reg::kBuildFlags) = 1;
    constants(reg::kBoardId) = config.board_id;
    constants(reg::kPorts) = config.ports | (kPathCommands ? 0x10'07'00U : 0);
    rtl_->idle_level_i = static_cast<IdleLevel>(config.idle_level);
    reset();
    in_ = {};
    in_.ratio = 0x10000;
  }

  // One clock of reset, whatever comes in it; what was asked for is forgotten.
  void reset() {
    in_.incomplete = false;
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
    in_.request = in_.stop = in_.probe = in_.mark = in_.start_done = in_.checker_refuse = false;
    in_.checker_ready = true;
    compare();
  }

  void clock() {
    drive();
    const std::uint32_t snapshot = rtl_->snapshot_o;
    for (std::size_t i = chain_.size(); i-- > 0;)
      chain_[i].clock(snapshot, latched_value(i), i == 0 ? rtl_->chain_o : chain_[i - 1].word());
    rtl_.clock();
    model_.clock(in_);
    compare();
  }

  // The first clock of an access with everything else at rest.
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

  // The whole of it; the data read.
  std::uint32_t access(bool write, std::uint32_t address, std::uint32_t data) {
    ask(write, address, data);
    while (!model_.outputs().ack) clock();
    const std::uint32_t answer = model_.outputs().data;
    clock();
    return answer;
  }

  void random_clock() {
    random_state();
    random_checker();
    random_loader();
    random_access();
    // Nothing moves before the registers are filled, so nothing stops.
    // A stop is as likely beside what a write asks for as anywhere else.
    in_.stop = model_.time() > kFilled && chance(model_.outputs().ack ? 20 : 300);
    if (in_.stop) checker_.event("stop");
    if (chance(1000)) marks_every_ = chance(3) ? 5 + draw() % 20 : 300;
    in_.mark = kPathCommands && model_.time() > kFilled && chance(marks_every_);
    if (in_.mark) checker_.event("mark");
    // Not while the stop's snapshot is under way: the probe is off then.
    stopped_for_ = in_.stop ? 0 : stopped_for_ + 1;
    in_.probe = kPathCommands && model_.time() > kFilled && stopped_for_ > kAxes + 11 && chance(300);
    if (in_.probe) checker_.event("probe");
    if (chance(reset_every())) {
      reset();
    } else {
      clock();
    }
  }

  // Sets both times to `clocks`.
  void skip_to(std::uint64_t clocks) {
    const std::uint64_t more = clocks - model_.time();
    model_.state().time += more;
    advance_time(*rtl_, more);
  }

  Checker& checker() { return checker_; }
  std::uint64_t expected() const { return kComparedSignals * checker_.cycles() + more_; }

 private:
  std::uint32_t draw() { return static_cast<std::uint32_t>(random_()); }
  bool chance(std::uint32_t one_in) { return draw() % one_in == 0; }

  // Most where something is under way that a reset must stop, and in the clocks after another one.
  std::uint32_t reset_every() const {
    const bool acts = in_.write && (in_.address == reg::kStream || in_.address == reg::kStart ||
                                    in_.address == reg::kFault || in_.address == reg::kControl);
    if (model_.time() < 8) return 20;
    return start_wait_ != 0 || (outstanding_ && acts) ? 60 : 3000;
  }

  std::uint32_t& constants(std::uint32_t address) { return rtl_->constants_i[address / 4]; }

  std::uint32_t latched_value(std::size_t place) const {
    if (place >= kBeforePositions) return in_.position[place - kBeforePositions];
    const std::uint32_t values[] = {in_.ratio, in_.rate, in_.feed_begun, in_.geometry_begun};
    return values[place];
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
    in_.geometry_room = static_cast<std::uint16_t>(draw());
    in_.feed_room = static_cast<std::uint16_t>(draw());
    in_.geometry_low = (bits & 0x200) != 0;
    in_.feed_low = (bits & 0x400) != 0;
    in_.geometry_begun = draw();
    in_.feed_begun = draw();
    in_.inputs = static_cast<std::uint16_t>(draw());
    in_.outputs = static_cast<std::uint16_t>(draw());
    in_.marks = draw();
    in_.probed = chance(2);
    in_.probe_missed = chance(2);
    in_.waiting = chance(2);
    in_.rate = draw();
    in_.ratio = chance(3) ? 0 : draw() % 0x10001;
    in_.fault = chance(2) ? 0 : draw() & kFaultBits;
    for (std::uint32_t n = 0; n < kAxes; ++n) in_.position[n] = draw();
  }

  // A word is answered some clocks after its write, with ready; a flush may refuse what it breaks off.
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
    // The direct loader reads its own registers alone, never words that a snapshot may be writing.
    in_.loader_address = static_cast<std::uint8_t>(kFirstDirect + draw() % (256 - kFirstDirect));
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
    // Whoever is refused often looks why.
    const bool looks = refused_ && chance(3);
    if (!looks) in_.port = static_cast<std::uint8_t>(draw() % kPorts);
    in_.write = in_.write && !looks;
    in_.address = looks ? reg::kRefusal : random_address();
    in_.data = random_data(in_.address);
    // Refusals are cleared often, or there would be no first one (a write of 0 clears nothing); snapshots are asked for
    // often.
    if (!looks && chance(5)) write_register(reg::kRefusal, chance(3) ? 0 : 1U << draw() % 28);
    if (!looks && chance(20)) write_register(reg::kControl, card_map::field::kControlSnapshot);
    checker_.event(in_.write ? "write" : "read", in_.address);
  }

  void write_register(std::uint32_t address, std::uint32_t data) {
    in_.write = true;
    in_.partial = false;
    in_.address = address;
    in_.data = data;
  }

  std::uint32_t random_address() {
    if (chance(20)) return draw() & 0xFFF;
    constexpr std::uint32_t kOften[] = {reg::kRefusal, reg::kControl, reg::kStream};
    if (chance(10)) return kOften[draw() % std::size(kOften)];
    const card_map::Register& entry = card_map::kRegisters[draw() % card_map::kRegisters.size()];
    const std::uint32_t stray = chance(40) ? 1 + draw() % 3 : 0;
    return card_map::slot_address(entry, draw() % entry.count) + stray;
  }

  // Mostly a value that the register takes, its limits among them.
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
    rtl_->request_i = in_.request;
    rtl_->access_i = std::uint64_t{in_.port} << 46 | std::uint64_t{in_.write} << 45 | std::uint64_t{in_.partial} << 44 |
                     std::uint64_t{in_.address} << 32 | in_.data;
    rtl_->motion_i = static_cast<CData>(in_.stopping << 5 | in_.ended << 4 | in_.feed_active << 3 |
                                        in_.path_active << 2 | in_.direct << 1 | static_cast<int>(in_.busy));
    rtl_->held_i = in_.ratio == 0;
    rtl_->late_i[0] = in_.underruns;
    rtl_->late_i[1] = std::uint32_t{in_.underrun} | in_.stale_ticks << 1;
    rtl_->late_i[2] = std::uint32_t{in_.stale} << 1 | in_.stale_ticks >> 31;
    rtl_->fault_i = in_.fault;
    rtl_->room_i = std::uint32_t{in_.geometry_room} << 16 | in_.feed_room;
    rtl_->low_i = static_cast<CData>(in_.feed_low << 1 | static_cast<int>(in_.geometry_low));
    rtl_->begun_i = std::uint64_t{in_.geometry_begun} << 32 | in_.feed_begun;
    rtl_->checker_i = std::uint32_t{in_.incomplete} << 18 | std::uint32_t{in_.checker_ready} << 17 |
                      std::uint32_t{in_.checker_refuse} << 16 | std::uint32_t{in_.checker_number} << 8 |
                      in_.checker_reason;
    rtl_->start_answer_i = static_cast<SData>(in_.start_done << 9 | in_.start_error << 8 | in_.start_reason);
    rtl_->loader_address_i = in_.loader_address;
    rtl_->stop_i = in_.stop;
    rtl_->probe_i = in_.probe;
    rtl_->mark_i = in_.mark;
    rtl_->io_i[0] = std::uint32_t{in_.outputs} << 16 | in_.inputs;
    rtl_->io_i[1] = in_.marks;
    rtl_->io_i[2] = std::uint32_t{in_.waiting} << 2 | std::uint32_t{in_.probe_missed} << 1 | std::uint32_t{in_.probed};
    rtl_->chain_i = chain_.back().word();
  }

  void compare() {
    checker_.next_cycle();
    const RegisterFile::Outputs& out = model_.outputs();
    checker_.compare("ack_o", rtl_->ack_o, out.ack);
    checker_.compare("error_o", rtl_->error_o, out.error);
    checker_.compare("data_o", rtl_->data_o, out.data);
    checker_.compare("status_o", rtl_->status_o, model_.status(in_));
    checker_.compare("irq_o", rtl_->irq_o, out.irq);
    checker_.compare("clear_fault_o", rtl_->clear_fault_o, out.clear_fault);
    checker_.compare("abort_o", rtl_->abort_o, out.abort);
    checker_.compare("probe_clear_o", rtl_->probe_clear_o, out.probe_clear);
    checker_.compare("flush_o", rtl_->flush_o, out.flush);
    checker_.compare("stream_write_o", rtl_->stream_write_o, out.stream_write);
    checker_.compare("start_o", rtl_->start_o, out.start);
    checker_.compare("setting_o, set", rtl_->setting_o >> 40, out.setting.set);
    checker_.compare("snapshot_o, strobe", rtl_->snapshot_o & 1U, out.strobe);
    checker_.compare("snapshot_o, shift at rest", rtl_->snapshot_o >> 1 & ~(rtl_->status_o >> 8) & 1U, 0U);
    if (out.setting.set) more("setting_o", rtl_->setting_o, trammel::lockstep::wire(out.setting));
    if (out.stream_write) more("setting_o, word", rtl_->setting_o & 0xFFFF'FFFF, out.stream_word);
    if (out.start) more("setting_o, mask", rtl_->setting_o & 0xFF, out.start_mask);
    if (out.loader_valid) more("loader_data_o", rtl_->loader_data_o, out.loader_data);
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
  std::array<trammel::lockstep::SnapshotWord, kBeforePositions + kAxes> chain_;
  std::uint64_t more_ = 0;
  bool flushed_ = false;
  bool streamed_ = false;  // since reset
  bool refused_ = false;   // the last access
  std::uint32_t checker_wait_ = 0;
  std::uint32_t start_wait_ = 0;
  std::uint32_t marks_every_ = 300;
  std::uint32_t stopped_for_ = 0;  // clocks since the last stop
  bool outstanding_ = false;
};

// A snapshot that is asked for so many clocks before the time's lower `bits` bits carry.
void snapshot_before_a_carry(Bench& bench, std::uint32_t bits, std::uint32_t before) {
  bench.reset();
  for (std::uint64_t i = 0; i < kFilled; ++i) bench.clock();
  bench.skip_to((std::uint64_t{1} << bits) - 1 - before);
  bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
  bench.access(false, reg::kSnapTimeLo, 0);
  bench.access(false, reg::kSnapTimeHi, 0);
}

// In every clock around the carry into the time's high word, of which the card writes the halves in turn; then around
// each carry within the high word.
void snapshots_around_carries(Bench& bench) {
  for (std::uint32_t before = 0; before < 16; ++before) snapshot_before_a_carry(bench, 32, before);
  for (std::uint32_t bits = 33; bits < 64; ++bits) snapshot_before_a_carry(bench, bits, bits % 4);
}

// A reset in each clock of a write: what it asked for never comes out, be it a setting, an event or a refusal.
void resets_in_writes(Bench& bench) {
  constexpr std::pair<std::uint32_t, std::uint32_t> kWritten[] = {
      {reg::kIrqEnable, 1}, {reg::kControl, 1}, {reg::kControl, card_map::field::kControlProbeClear},
      {reg::kFault, 1},     {reg::kRefusal, 1}, {reg::kAxes, 1}};
  constexpr std::uint32_t kLongest = 8;  // clocks, more than such a write takes
  for (const auto& [address, data] : kWritten) {
    for (std::uint32_t after = 0; after < kLongest; ++after) {
      bench.reset();
      for (std::uint64_t i = 0; i < kFilled; ++i) bench.clock();
      bench.ask(true, address, data);
      for (std::uint32_t i = 0; i < after; ++i) bench.clock();
      bench.reset();
      for (std::uint32_t i = 0; i < kLongest; ++i) bench.clock();
    }
  }
}

TEST(RegisterFile, LockstepUnderTraffic) {
  const std::uint64_t seed = trammel::lockstep::seed_from_environment(1);
  EXPECT_EQ("", trammel::lockstep::judge([&] {
              Bench bench(seed);
              snapshots_around_carries(bench);
              resets_in_writes(bench);
              const std::uint64_t length = trammel::lockstep::scaled(400'000);
              for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
              EXPECT_EQ(bench.checker().comparisons(), bench.expected());
            }));
}

TEST(RegisterFile, ReadsEveryAddressAfterReset) {
  EXPECT_EQ("", trammel::lockstep::judge([] {
              Bench bench(1);
              for (std::uint32_t address = 0; address < card_map::kWindowBytes; address += 4)
                bench.access(false, address, 0);
              EXPECT_GT(bench.checker().cycles(), card_map::kWindowBytes);
            }));
}

// A snapshot and its time, read twice in a row: the difference is the clocks between the two snapshots.
void snapshot_time_counts_clocks() {
  Bench bench(1);
  bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
  const std::uint32_t first = bench.access(false, reg::kSnapTimeLo, 0);
  const std::uint64_t start = bench.checker().cycles();
  for (int i = 0; i < 1000; ++i) bench.clock();
  bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
  const std::uint64_t between = bench.checker().cycles() - start;
  const std::uint32_t second = bench.access(false, reg::kSnapTimeLo, 0);
  EXPECT_GT(second - first, between);
  EXPECT_LT(second - first, between + 32);
}

TEST(RegisterFile, SnapshotTimeCountsClocks) { EXPECT_EQ("", trammel::lockstep::judge(snapshot_time_counts_clocks)); }

}  // namespace
