// Lockstep of the register file: random accesses, a random door and loader, faults and resets; every port in every
// cycle. loader_data_o is compared where it answers the loader.
#include "trammel/model/register_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "Vdut.h"
#include "lockstep.hpp"
#include "register_file_inside.hpp"

namespace {

using trammel::lockstep::Checker;
using trammel::lockstep::Simulated;
using trammel::model::RegisterFile;
namespace card_map = trammel::card_map;
namespace reg = card_map::reg;

constexpr std::uint32_t kAxes = 4;
constexpr std::uint32_t kFaultBits = 0x3FF;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("register_file", seed), random_(seed), model_(RegisterFile::Config{}) {
    rtl_->clock_hz_i = RegisterFile::Config{}.clock_hz;
    reset();
    in_.ratio = 0x10000;
  }

  void reset() {
    in_ = {};
    door_wait_ = 0;
    start_wait_ = 0;
    outstanding_ = false;
    rtl_->rst_i = 1;
    drive();
    rtl_.clock();
    rtl_.clock();
    rtl_->rst_i = 0;
    model_.reset();
    checker_.event("reset");
    compare();
  }

  void clock() {
    drive();
    rtl_.clock();
    model_.clock(in_);
    checker_.next_cycle();
    compare();
  }

  // A whole access with everything else at rest; the data read.
  std::uint32_t access(bool write, std::uint32_t address, std::uint32_t data) {
    in_.request = true;
    in_.write = write;
    in_.address = address;
    in_.data = data;
    in_.partial = false;
    checker_.event(write ? "write" : "read", address);
    clock();
    in_.request = false;
    while (!model_.outputs().ack) clock();
    const std::uint32_t answer = model_.outputs().data;
    clock();
    return answer;
  }

  void random_clock() {
    random_state();
    random_faults();
    random_door();
    random_loader();
    random_access();
    if (chance(20000)) reset();
    clock();
  }

  // Sets both times, right behind a reset, to `clocks`, which must not reach into the high word.
  void skip_to(std::uint32_t clocks) {
    model_.advance(clocks - model_.time());
    set_time_low(*rtl_, clocks);
  }

  Checker& checker() { return checker_; }

 private:
  std::uint32_t draw() { return static_cast<std::uint32_t>(random_()); }
  bool chance(std::uint32_t one_in) { return draw() % one_in == 0; }

  void random_state() {
    if (!chance(8)) return;
    const std::uint32_t bits = draw();
    in_.busy = (bits & 1) != 0;
    in_.direct = (bits & 0x0E) == 0;
    in_.path_active = (bits & 0x10) != 0;
    in_.feed_active = (bits & 0x20) != 0;
    in_.ended = (bits & 0x40) != 0;
    in_.incomplete = (bits & 0x80) != 0;
    in_.geometry_room = bits >> 8 & 0x1FFF;
    in_.feed_room = bits >> 19;
    in_.running_geometry = static_cast<std::uint8_t>(draw());
    in_.running_feed = static_cast<std::uint8_t>(draw());
    in_.rate = draw();
    in_.ratio = chance(3) ? 0 : draw() % 0x10001;
    for (std::uint32_t n = 0; n < kAxes; ++n) in_.position[n] = draw();
  }

  // A source drops its level none to two clocks after it is told to; now and then it stays broken.
  void random_faults() {
    in_.fault &= ~drop_now_ & kFaultBits;
    drop_now_ = drop_soon_;
    drop_soon_ = 0;
    if (!chance(5)) (chance(2) ? drop_now_ : drop_soon_) |= model_.outputs().clear_fault;
    if (chance(60)) in_.fault |= 1u << draw() % 10;
  }

  void random_door() {
    in_.door_refuse = chance(200);
    in_.door_reason = static_cast<std::uint8_t>(1 + draw() % 14);
    in_.door_number = static_cast<std::uint8_t>(draw());
    if (model_.outputs().stream_write) door_wait_ = 1 + draw() % 6;
    in_.door_ready = door_wait_ == 0 && !chance(10);
    if (door_wait_ == 0) return;
    --door_wait_;
    if (chance(10)) in_.door_refuse = true;
  }

  void random_loader() {
    if (model_.outputs().start) start_wait_ = 1 + draw() % 40;
    in_.loader_address = static_cast<std::uint8_t>(draw());
    in_.start_done = start_wait_ == 1;
    in_.start_error = chance(2);
    in_.start_reason = chance(2) ? 8 : 12;
    if (start_wait_ != 0) --start_wait_;
  }

  void random_access() {
    in_.request = false;
    if (model_.outputs().ack) {
      outstanding_ = false;
      return;
    }
    if (outstanding_ || chance(3)) return;
    outstanding_ = true;
    in_.request = true;
    in_.write = chance(2);
    in_.partial = chance(20);
    in_.address = random_address();
    in_.data = random_data(in_.address);
    checker_.event(in_.write ? "write" : "read", in_.address);
  }

  std::uint32_t random_address() {
    if (chance(20)) return draw() & 0xFFF;
    const card_map::Register& entry = card_map::kRegisters[draw() % card_map::kRegisters.size()];
    const std::uint32_t stray = chance(40) ? 1 + draw() % 3 : 0;
    return entry.address + entry.stride * (draw() % entry.count) + stray;
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
    rtl_->write_i = in_.write;
    rtl_->partial_i = in_.partial;
    rtl_->address_i = static_cast<SData>(in_.address);
    rtl_->data_i = in_.data;
    rtl_->busy_i = in_.busy;
    rtl_->direct_i = in_.direct;
    rtl_->path_active_i = in_.path_active;
    rtl_->feed_active_i = in_.feed_active;
    rtl_->ended_i = in_.ended;
    rtl_->incomplete_i = in_.incomplete;
    rtl_->geometry_room_i = static_cast<SData>(in_.geometry_room);
    rtl_->feed_room_i = static_cast<SData>(in_.feed_room);
    rtl_->running_geometry_i = in_.running_geometry;
    rtl_->running_feed_i = in_.running_feed;
    rtl_->rate_i = in_.rate;
    rtl_->ratio_i = in_.ratio;
    for (std::uint32_t n = 0; n < kAxes; ++n) rtl_->position_i[n] = in_.position[n];
    rtl_->fault_i = static_cast<SData>(in_.fault);
    rtl_->door_ready_i = in_.door_ready;
    rtl_->door_refuse_i = in_.door_refuse;
    rtl_->door_reason_i = in_.door_reason;
    rtl_->door_number_i = in_.door_number;
    rtl_->start_done_i = in_.start_done;
    rtl_->start_error_i = in_.start_error;
    rtl_->start_reason_i = in_.start_reason;
    rtl_->loader_address_i = in_.loader_address;
  }

  void compare() {
    const RegisterFile::Outputs& out = model_.outputs();
    checker_.compare("ack_o", rtl_->ack_o, out.ack);
    checker_.compare("error_o", rtl_->error_o, out.error);
    checker_.compare("data_o", rtl_->data_o, out.data);
    checker_.compare("clear_fault_o", rtl_->clear_fault_o, out.clear_fault);
    checker_.compare("fault_o", rtl_->fault_o, out.fault);
    checker_.compare("irq_o", rtl_->irq_o, out.irq);
    checker_.compare("stream_write_o", rtl_->stream_write_o, out.stream_write);
    checker_.compare("stream_word_o", rtl_->stream_word_o, out.stream_word);
    checker_.compare("abort_o", rtl_->abort_o, out.abort);
    checker_.compare("flush_o", rtl_->flush_o, out.flush);
    checker_.compare("start_o", rtl_->start_o, out.start);
    checker_.compare("start_mask_o", rtl_->start_mask_o, out.start_mask);
    if (out.loader_valid) checker_.compare("loader_data_o", rtl_->loader_data_o, out.loader_data);
    checker_.compare("hold_o", rtl_->hold_o, out.hold);
    checker_.compare("ratio_o", rtl_->ratio_o, out.ratio);
    checker_.compare("slew_o", rtl_->slew_o, out.slew);
    checker_.compare("hold_limit_o", rtl_->hold_limit_o, out.hold_limit);
    for (std::uint32_t n = 0; n < kAxes; ++n) {
      checker_.compare("step_length_o", rtl_->step_length_o >> 16 * n & 0xFFFF, out.step_length[n]);
      checker_.compare("step_space_o", rtl_->step_space_o >> 16 * n & 0xFFFF, out.step_space[n]);
      checker_.compare("dir_setup_o", rtl_->dir_setup_o >> 16 * n & 0xFFFF, out.dir_setup[n]);
      checker_.compare("dir_hold_o", rtl_->dir_hold_o >> 16 * n & 0xFFFF, out.dir_hold[n]);
      checker_.compare("mode_o", rtl_->mode_o >> 4 * n & 0xF, out.mode[n]);
    }
  }

  Checker checker_;
  std::mt19937_64 random_;
  Simulated<Vdut> rtl_;
  RegisterFile model_;
  RegisterFile::Inputs in_;
  std::uint32_t drop_now_ = 0;
  std::uint32_t drop_soon_ = 0;
  std::uint32_t door_wait_ = 0;
  std::uint32_t start_wait_ = 0;
  bool outstanding_ = false;
};

constexpr std::uint64_t kComparisonsACycle = 16 + 5 * kAxes;

// Snapshots in every clock around the carry into the time's high word, of which the card writes the halves in turn.
void snapshots_around_the_carry(Bench& bench) {
  constexpr std::uint32_t kWalk = 300;  // clocks, more than the walk behind reset takes
  for (std::uint32_t before = 0; before < 16; ++before) {
    bench.reset();
    for (std::uint32_t i = 0; i < kWalk; ++i) bench.clock();
    bench.skip_to(0xFFFF'FFFFu - before);
    bench.access(true, reg::kControl, card_map::field::kControlSnapshot);
    bench.access(false, reg::kSnapTimeLo, 0);
    bench.access(false, reg::kSnapTimeHi, 0);
  }
}

TEST(RegisterFile, LockstepUnderTraffic) {
  const std::uint64_t seed = trammel::lockstep::seed_from_environment(1);
  EXPECT_EQ("", trammel::lockstep::judge([&] {
              Bench bench(seed);
              snapshots_around_the_carry(bench);
              const std::uint64_t length = trammel::lockstep::scaled(400'000);
              for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
              EXPECT_GE(bench.checker().comparisons(), bench.checker().cycles() * kComparisonsACycle);
            }));
}

TEST(RegisterFile, ReadsEveryAddressBehindReset) {
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
