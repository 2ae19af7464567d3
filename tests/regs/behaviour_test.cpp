// Behaviour of the register file beyond keeping values: latencies, setting bus, events, the stream and its owner,
// START, interrupt, skipping. Snapshots: snapshot_test.cpp.
#include <gtest/gtest.h>

#include <array>

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
  EXPECT_EQ(bench.latency(), 260u) << "the registers are filled first";
  bench.read(reg::kMagic);
  EXPECT_EQ(bench.latency(), 5u);
  bench.write(reg::kHold, 1);
  EXPECT_EQ(bench.latency(), 4u);
  bench.write(reg::kMagic, 1);
  EXPECT_EQ(bench.latency(), 4u) << "refused";
  bench.read(reg::kControl);
  EXPECT_EQ(bench.latency(), 4u) << "refused";
  bench.write(reg::kStream, 1);
  EXPECT_EQ(bench.latency(), 11u);
}

TEST(Behaviour, TheFirstWriteAfterResetIsAnsweredInClock259) {
  RegisterBench bench(4);
  bench.write(reg::kHold, 1);
  EXPECT_EQ(bench.latency(), 259u);
}

TEST(Behaviour, LiveRegistersAnswerDuringTheFill) {
  for (const std::uint32_t address : {reg::kStatus, reg::kFault, reg::kRefusal, reg::kFeedRoom, reg::kGeometryBegun}) {
    RegisterBench bench(4);
    bench.in.feed_room = 77;
    bench.in.geometry_begun = 0xDEADBEEF;
    const std::uint32_t value = bench.read(address).data;
    EXPECT_EQ(bench.latency(), 5u) << address;
    EXPECT_EQ(value, address == reg::kFeedRoom ? 77u : address == reg::kGeometryBegun ? 0xDEADBEEFu : 0u) << address;
  }
  RegisterBench bench(4);
  EXPECT_EQ(bench.refusal_of_write(reg::kStatus, 0), Reason::ReadOnly);
  EXPECT_GT(bench.file().time(), 256u) << "a write waits, to whatever register";
}

TEST(Behaviour, EveryBitOfStatus) {
  RegisterBench bench(4);
  RegisterFile::Inputs& in = bench.in;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0u);
  in.busy = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 1u << 0);
  in.direct = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 3u);
  in.path_active = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 7u);
  in.feed_active = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0xFu);
  in.ratio = 0;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0x1Fu);
  in.ended = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0x3Fu);
  in.fault = 0x8000;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0x7Fu);
  EXPECT_TRUE(bench.write(reg::kMagic, 0).error);
  EXPECT_EQ(bench.read(reg::kStatus).data, 0xFFu);
  in.incomplete = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0x2FFu);
  in.stopping = true;
  EXPECT_EQ(bench.read(reg::kStatus).data, 0x6FFu);
}

TEST(Behaviour, ASettingGoesOutInTheClockOfItsAnswerAndOnlyThen) {
  RegisterBench bench(4);
  bench.write(reg::dir_setup(3), 0xABCD);
  EXPECT_TRUE(bench.outputs().setting.set);
  EXPECT_EQ(bench.outputs().setting.address, reg::dir_setup(3));
  EXPECT_EQ(bench.outputs().setting.data, 0xABCDu);
  bench.clock();
  EXPECT_FALSE(bench.outputs().setting.set);
  EXPECT_EQ(bench.settings, 1u);
  bench.read(reg::dir_setup(3));
  bench.write(reg::dir_setup(3), 0x10000);
  bench.write(reg::kFault, 1);
  bench.write(reg::kControl, 1);
  EXPECT_EQ(bench.settings, 1u) << "neither reads nor refused writes nor commands";
}

TEST(Behaviour, FaultIsTheStopControlsAndAWriteTellsItWhatToClear) {
  RegisterBench bench(4);
  bench.in.fault = 0x104;
  EXPECT_EQ(bench.read(reg::kFault).data, 0x104u);
  EXPECT_FALSE(bench.write(reg::kFault, 0x8004).error);
  EXPECT_EQ(bench.outputs().clear_fault, 0x8004u);
  bench.clock();
  EXPECT_EQ(bench.outputs().clear_fault, 0u);
  EXPECT_EQ(bench.read(reg::kFault).data, 0x104u) << "nothing is latched here";
  EXPECT_EQ(bench.refusal_of_write(reg::kFault, 0x80000), Reason::BadValue);
}

TEST(Behaviour, StreamWordsReachTheCheckerAndItsRefusalsAreKept) {
  RegisterBench bench(4);
  EXPECT_FALSE(bench.write(reg::kStream, 0xDEADBEEF).error);
  EXPECT_EQ(bench.outputs().stream_word, 0xDEADBEEFu);
  bench.refuse_word = true;
  bench.in.checker_reason = static_cast<std::uint8_t>(Reason::BadField);
  bench.in.checker_number = 42;
  EXPECT_TRUE(bench.write(reg::kStream, 1).error);
  EXPECT_EQ(bench.latency(), 11u);
  EXPECT_EQ(bench.read(reg::kRefusal).data, reg::kStream << 16 | 42u << 8 | 6u);
}

TEST(Behaviour, StreamIsBusyInDirectMode) {
  RegisterBench bench(4);
  bench.in.direct = true;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::Busy);
  bench.in.direct = false;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::None);
}

TEST(Behaviour, TheStreamBelongsToAPortFromACommandsFirstWordToItsLast) {
  RegisterBench bench(4);
  bench.in.port = 2;
  EXPECT_FALSE(bench.write(reg::kStream, 1).error);
  bench.in.incomplete = true;
  for (const std::uint8_t port : std::array<std::uint8_t, 3>{0, 1, 3}) {
    bench.in.port = port;
    EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::Busy) << int{port};
  }
  bench.in.port = 2;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::None) << "a refused word of another one changes nothing";
  bench.in.incomplete = false;
  bench.in.port = 1;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::None);
  bench.in.incomplete = true;
  bench.in.port = 2;
  EXPECT_EQ(bench.refusal_of_write(reg::kStream, 1), Reason::Busy) << "now it is port 1's";
}

TEST(Behaviour, EachPortHasItsRefusal) {
  RegisterBench bench(4);
  bench.in.port = 1;
  EXPECT_TRUE(bench.write(reg::kMagic, 0).error);
  bench.in.port = 3;
  EXPECT_TRUE(bench.write(reg::kAxes, 0).error);
  for (const std::uint8_t port : std::array<std::uint8_t, 4>{0, 1, 2, 3}) {
    bench.in.port = port;
    const std::uint32_t expected = port == 1 ? reg::kMagic << 16 | 9u : port == 3 ? reg::kAxes << 16 | 9u : 0;
    EXPECT_EQ(bench.read(reg::kRefusal).data, expected) << int{port};
    EXPECT_EQ((bench.read(reg::kStatus).data & field::kStatusRefused) != 0, expected != 0) << int{port};
  }
  bench.in.port = 2;
  bench.write(reg::kRefusal, 1);
  bench.in.port = 1;
  EXPECT_NE(bench.read(reg::kRefusal).data, 0u) << "a port clears its own alone";
  EXPECT_NE(bench.file().status(bench.in) & field::kStatusRefused, 0u) << "any port's";
  bench.write(reg::kRefusal, 1);
  bench.in.port = 3;
  bench.write(reg::kRefusal, 1);
  EXPECT_EQ(bench.file().status(bench.in) & field::kStatusRefused, 0u);
}

TEST(Behaviour, ARefusalByFlushBelongsToThePortThatAskedForIt) {
  RegisterBench bench(4);
  bench.in.port = 2;
  bench.write(reg::kControl, field::kControlFlush);
  // The checker answers the flush in the clock in which the write is answered; the next access comes one clock later.
  RegisterFile file = bench.file();
  RegisterFile::Inputs in = bench.in;
  in.checker_refuse = true;
  in.checker_reason = static_cast<std::uint8_t>(Reason::Truncated);
  in.checker_number = 9;
  file.clock(in);
  in.checker_refuse = false;
  in.request = true;
  in.port = 0;
  in.write = false;
  in.address = reg::kRefusal;
  file.clock(in);
  in.request = false;
  while (!file.outputs().ack) file.clock(in);
  EXPECT_EQ(file.outputs().data, 0u);
  in.request = true;
  in.port = 2;
  file.clock(in);
  in.request = false;
  while (!file.outputs().ack) file.clock(in);
  EXPECT_EQ(file.outputs().data, reg::kControl << 16 | 9u << 8 | 7u);
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
  const std::uint64_t asked = file.time();
  while (!file.outputs().start) {
    file.clock(in);
    in.request = false;
  }
  EXPECT_EQ(file.time() - asked, 4u);
  EXPECT_EQ(file.outputs().start_mask, 0x4u);
  file.clock(in);
  in.loader_address = static_cast<std::uint16_t>(reg::frequency_lo(2) / 4);
  file.clock(in);
  EXPECT_FALSE(file.outputs().loader_valid && file.outputs().loader_data == 0x12345678u);
  in.loader_address = 0;
  file.clock(in);
  EXPECT_TRUE(file.outputs().loader_valid);
  EXPECT_EQ(file.outputs().loader_data, 0x12345678u);
  EXPECT_FALSE(file.outputs().ack);
  in.start_done = true;
  in.start_error = true;
  in.start_reason = static_cast<std::uint8_t>(Reason::Faulted);
  file.clock(in);
  EXPECT_TRUE(file.outputs().ack);
  EXPECT_TRUE(file.outputs().error);
}

TEST(Behaviour, EventsLastTheClockOfTheAnswer) {
  RegisterBench bench(4);
  bench.write(reg::kControl, field::kControlAbort);
  EXPECT_TRUE(bench.outputs().abort);
  bench.clock();
  EXPECT_FALSE(bench.outputs().abort);
  bench.write(reg::kControl, 0);
  EXPECT_FALSE(bench.outputs().abort);
}

// The clocks after the request in which flush and abort are high, for each combination of the two.
TEST(Behaviour, AFlushComesAClockBeforeTheAnswerAndNeverWithAnAbort) {
  for (const std::uint32_t orders : {0u, 2u, 4u, 6u}) {
    RegisterBench bench(4);
    bench.read(reg::kMagic);
    bench.clock();
    bench.in.request = bench.in.write = true;
    bench.in.address = reg::kControl;
    bench.in.data = orders;
    for (int clock = 1; clock < 8; ++clock) {
      bench.clock();
      bench.in.request = false;
      EXPECT_EQ(bench.outputs().flush, orders == 4 && clock == 3) << orders << " " << clock;
      EXPECT_EQ(bench.outputs().abort, (orders & 2) != 0 && clock == 4) << orders << " " << clock;
    }
  }
}

TEST(Behaviour, InterruptFollowsItsMaskAClockLate) {
  RegisterBench bench(4);
  bench.in.busy = true;
  bench.write(reg::kIrqEnable, field::kIrqEnableIdle | field::kIrqEnableRefused);
  for (int i = 0; i < 4; ++i) bench.clock();
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

TEST(Behaviour, AnEnabledInterruptComesTwoClocksAfterItsSetting) {
  for (std::uint32_t bit = 1; bit < 18; ++bit) {
    RegisterBench bench(4);
    bench.in.stopping = bit == 10;
    bench.in.ended = bit == 5;
    bench.in.fault = bit == 6 ? 1 : 0;
    bench.in.busy = true;
    ASSERT_FALSE(bench.write(reg::kIrqEnable, 1U << bit).error);
    EXPECT_FALSE(bench.outputs().irq);
    bench.clock();
    EXPECT_FALSE(bench.outputs().irq);
    bench.clock();
    EXPECT_EQ(bench.outputs().irq, bit == 5 || bit == 6 || bit == 10) << bit;
  }
}

}  // namespace
