// What the register file does beyond keeping values: latencies, snapshot, faults, stream, start, interrupt, skipping.
#include <gtest/gtest.h>

#include "register_bench.hpp"

namespace {

using trammel::model::RegisterFile;
using trammel::tests::RegisterBench;
namespace card_map = trammel::card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Reason;

TEST(Behaviour, LatenciesAreTheDocumentedOnes) {
  RegisterBench bench(4);
  bench.read(reg::kMagic);
  EXPECT_GT(bench.latency(), 256u) << "the walk behind reset goes first";
  bench.read(reg::kMagic);
  EXPECT_EQ(bench.latency(), 5u);
  bench.write(reg::kHold, 1);
  EXPECT_EQ(bench.latency(), 4u);
}

TEST(Behaviour, StatusAnswersDuringTheWalk) {
  RegisterBench bench(4);
  EXPECT_EQ(bench.read(reg::kStatus).data, field::kStatusSnapshot);
  EXPECT_EQ(bench.latency(), 5u);
}

TEST(Behaviour, SnapshotIsOfOneClock) {
  RegisterBench bench(4);
  bench.read(reg::kMagic);
  bench.in.busy = true;
  bench.in.request = true;
  bench.in.write = true;
  bench.in.address = reg::kControl;
  bench.in.data = field::kControlSnapshot;
  std::uint32_t taken = 0;
  const auto at = static_cast<std::uint32_t>(bench.file().time());
  // Everything counts up in step, so whatever clock it is taken in, all must tell the same one.
  for (std::uint32_t i = 0; i < 8; ++i) {
    bench.in.rate = 100 + i;
    bench.in.ratio = 200 + i;
    bench.in.running_geometry = static_cast<std::uint8_t>(10 + i);
    bench.in.running_feed = static_cast<std::uint8_t>(20 + i);
    for (std::uint32_t n = 0; n < 4; ++n) bench.in.position[n] = 1000 * n + i;
    bench.clock();
    bench.in.request = false;
  }
  taken = bench.read(reg::kSnapRate).data - 100;
  EXPECT_LT(taken, 8u);
  EXPECT_EQ(bench.read(reg::kSnapTimeLo).data, at + taken);
  EXPECT_EQ(bench.read(reg::kSnapTimeHi).data, 0u);
  EXPECT_EQ(bench.read(reg::kSnapRatio).data, 200 + taken);
  EXPECT_EQ(bench.read(reg::kSnapRunning).data, (20 + taken) << 8 | (10 + taken));
  EXPECT_EQ(bench.read(reg::kSnapStatus).data, field::kStatusBusy);
  for (std::uint32_t n = 0; n < 4; ++n) EXPECT_EQ(bench.read(reg::snap_position(n)).data, 1000 * n + taken);
}

TEST(Behaviour, TimeCarriesIntoItsHighWord) {
  RegisterBench bench(4);
  RegisterFile file({4, 1024, 512, 1});
  file.advance((std::uint64_t{7} << 32) - 1000);
  RegisterFile::Inputs in;
  for (int i = 0; i < 1200; ++i) file.clock(in);
  in.request = true;
  in.write = true;
  in.address = reg::kControl;
  in.data = field::kControlSnapshot;
  const std::uint64_t before = file.time();
  file.clock(in);
  in.write = false;
  in.request = false;
  while (!file.outputs().ack) file.clock(in);
  file.clock(in);
  in.address = reg::kSnapTimeHi;
  in.request = true;
  file.clock(in);
  in.request = false;
  while (!file.outputs().ack) file.clock(in);
  EXPECT_EQ(file.outputs().data, 7u);
  EXPECT_EQ(before >> 32, 7u);
}

TEST(Behaviour, FaultsStickUntilClearedAndTheirSourceIsTold) {
  RegisterBench bench(4);
  bench.in.fault = 0x104;
  bench.clock();
  bench.in.fault = 0;
  EXPECT_EQ(bench.read(reg::kFault).data, 0x104u);
  EXPECT_NE(bench.read(reg::kStatus).data & field::kStatusFaulted, 0u);
  EXPECT_FALSE(bench.write(reg::kFault, 0x004).error);
  EXPECT_EQ(bench.outputs().clear_fault, 0x004u);
  EXPECT_EQ(bench.read(reg::kFault).data, 0x100u);
  bench.write(reg::kFault, 0x100);
  EXPECT_EQ(bench.read(reg::kFault).data, 0u);
}

TEST(Behaviour, AFaultThatPersistsComesBack) {
  RegisterBench bench(4);
  bench.in.fault = 0x001;
  bench.clock();
  bench.write(reg::kFault, 0x001);
  EXPECT_EQ(bench.read(reg::kFault).data, 0x001u);
}

TEST(Behaviour, StreamWordsReachTheDoorAndItsRefusalsAreKept) {
  RegisterBench bench(4);
  EXPECT_FALSE(bench.write(reg::kStream, 0xDEADBEEF).error);
  EXPECT_EQ(bench.outputs().stream_word, 0xDEADBEEFu);
  bench.in.door_refuse = true;
  bench.in.door_reason = static_cast<std::uint8_t>(Reason::BadField);
  bench.in.door_number = 42;
  EXPECT_TRUE(bench.write(reg::kStream, 1).error);
  bench.in.door_refuse = false;
  const std::uint32_t refusal = bench.read(reg::kRefusal).data;
  EXPECT_EQ(refusal & field::kRefusalReason, static_cast<std::uint32_t>(Reason::BadField));
  EXPECT_EQ((refusal & field::kRefusalCommand) >> field::kRefusalCommandShift, 42u);
}

TEST(Behaviour, StreamIsBusyInDirectMode) {
  RegisterBench bench(4);
  bench.in.direct = true;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::Busy);
  bench.in.direct = false;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::None);
}

TEST(Behaviour, StartWaitsForTheLoaderWhichReadsItsRegisters) {
  RegisterBench bench(4);
  bench.write(reg::frequency_lo(2), 0x12345678);
  RegisterFile::Inputs& in = bench.in;
  in.request = true;
  in.write = true;
  in.address = reg::kStart;
  in.data = 0x4;
  RegisterFile file = bench.file();
  while (!file.outputs().start) {
    file.clock(in);
    in.request = false;
  }
  EXPECT_EQ(file.outputs().start_mask, 0x4u);
  file.clock(in);
  in.loader_address = static_cast<std::uint8_t>(reg::frequency_lo(2) / 4);
  file.clock(in);
  EXPECT_FALSE(file.outputs().loader_valid && file.outputs().loader_data == 0x12345678u);
  in.loader_address = 0;
  file.clock(in);
  EXPECT_TRUE(file.outputs().loader_valid);
  EXPECT_EQ(file.outputs().loader_data, 0x12345678u);
  EXPECT_FALSE(file.outputs().ack);
  in.start_done = true;
  in.start_error = true;
  in.start_reason = static_cast<std::uint8_t>(Reason::Busy);
  file.clock(in);
  EXPECT_TRUE(file.outputs().ack);
  EXPECT_TRUE(file.outputs().error);
}

TEST(Behaviour, ControlPulsesLastOneClock) {
  RegisterBench bench(4);
  bench.write(reg::kControl, field::kControlAbort | field::kControlFlush);
  EXPECT_TRUE(bench.outputs().abort);
  EXPECT_TRUE(bench.outputs().flush);
  bench.clock();
  EXPECT_FALSE(bench.outputs().abort);
  EXPECT_FALSE(bench.outputs().flush);
}

TEST(Behaviour, InterruptFollowsItsMask) {
  RegisterBench bench(4);
  bench.in.busy = true;
  bench.write(reg::kIrqEnable, field::kIrqEnableIdle | field::kIrqEnableRefused);
  bench.clock();
  EXPECT_FALSE(bench.outputs().irq);
  bench.in.busy = false;
  bench.clock();
  EXPECT_TRUE(bench.outputs().irq) << "idle";
  bench.in.busy = true;
  bench.in.ended = true;
  bench.clock();
  EXPECT_FALSE(bench.outputs().irq) << "ended is not enabled";
  bench.write(reg::kMagic, 0);
  bench.clock();
  EXPECT_TRUE(bench.outputs().irq) << "refused";
}

TEST(Behaviour, AdvanceEqualsClocking) {
  RegisterBench bench(4);
  bench.read(reg::kMagic);
  for (int i = 0; i < 4; ++i) bench.clock();
  RegisterFile clocked = bench.file();
  RegisterFile skipped = bench.file();
  ASSERT_TRUE(clocked.quiet(bench.in));
  for (int i = 0; i < 1000; ++i) clocked.clock(bench.in);
  skipped.advance(1000);
  EXPECT_EQ(clocked.time(), skipped.time());
  EXPECT_TRUE(clocked.quiet(bench.in));
  bench.in.fault = 1;
  EXPECT_FALSE(clocked.quiet(bench.in));
}

}  // namespace
