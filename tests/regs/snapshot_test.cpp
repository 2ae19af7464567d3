// Snapshots: all values are of one clock, in the area of the requester, in the right order.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "register_bench.hpp"
#include "trammel/card_map.hpp"
#include "trammel/model/snapshot_writer.hpp"

namespace {

using trammel::model::RegisterFile;
using trammel::model::SnapshotWriter;
using trammel::tests::RegisterBench;
namespace card_map = trammel::card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Area;

// All inputs count up with the time, so that each value shows the clock in which it was taken.
void count(RegisterFile::Inputs& in, std::uint64_t time) {
  const auto t = static_cast<std::uint32_t>(time);
  in.rate = 100 + t;
  in.ratio = 200 + t;
  in.geometry_begun = 0x10000000 + t;
  in.feed_begun = 0x20000000 + t;
  in.fault = t & 0xFFFF;
  for (std::uint32_t n = 0; n < card_map::kMaxAxes; ++n) in.position[n] = 0x01000000 * (n + 1) + t;
}

struct Taken {
  std::uint32_t time;
  bool coherent;
};

// Reads an area while the inputs of the bench are constant.
Taken area(RegisterBench& bench, Area where) {
  const std::uint32_t t = bench.read(reg::time_lo(where)).data;
  RegisterFile::Inputs then;
  count(then, t);
  bool good = bench.read(reg::time_hi(where)).data == 0;
  good = good && bench.read(reg::rate(where)).data == then.rate && bench.read(reg::ratio(where)).data == then.ratio;
  good = good && bench.read(reg::geometry_begun(where)).data == then.geometry_begun;
  good = good && bench.read(reg::feed_begun(where)).data == then.feed_begun;
  good = good && bench.read(reg::fault(where)).data == then.fault;
  good = good && bench.read(reg::status(where)).data == (field::kStatusBusy | field::kStatusFaulted);
  for (std::uint32_t n = 0; n < bench.axes(); ++n) {
    good = good && bench.read(reg::position(where, n)).data == then.position[n];
  }
  return {t, good};
}

class Snapshot : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  void SetUp() override {
    bench_.in.busy = true;
    bench_.read(reg::kMagic);
    for (int i = 0; i < 5; ++i) clock();
  }
  void clock() {
    count(bench_.in, bench_.file().time());
    bench_.clock();
  }
  std::uint64_t now() const { return bench_.file().time(); }
  bool busy() const { return (bench_.file().status(bench_.in) & field::kStatusSnapshot) != 0; }

  // Requests a snapshot by CONTROL; the clock of the answer is the clock of the request.
  std::uint64_t ask_by_control() {
    bench_.in.request = true;
    bench_.in.write = true;
    bench_.in.address = reg::kControl;
    bench_.in.data = field::kControlSnapshot;
    do {
      clock();
      bench_.in.request = false;
    } while (!bench_.outputs().ack);
    return now();
  }
  std::uint64_t ask_by_stop() {
    bench_.in.stop = true;
    const std::uint64_t at = now();
    clock();
    return at;
  }

  RegisterBench bench_{GetParam()};
};

TEST_P(Snapshot, IsOfTheClockAfterItsRequest) {
  const std::uint64_t host = ask_by_control();
  EXPECT_FALSE(busy());
  EXPECT_FALSE(bench_.outputs().strobe);
  clock();
  EXPECT_TRUE(bench_.outputs().strobe);
  for (std::uint32_t i = 1; i <= GetParam() + 11; ++i) {
    EXPECT_TRUE(busy()) << i;
    clock();
  }
  EXPECT_FALSE(busy());
  const Taken snap = area(bench_, Area::Snap);
  EXPECT_TRUE(snap.coherent);
  EXPECT_EQ(snap.time, host + 1);
  const std::uint64_t stop = ask_by_stop();
  while (busy()) clock();
  const Taken stopped = area(bench_, Area::Stop);
  EXPECT_TRUE(stopped.coherent);
  EXPECT_EQ(stopped.time, stop + 1);
  EXPECT_EQ(area(bench_, Area::Snap).time, host + 1) << "an area each";
}

TEST_P(Snapshot, AccessesWaitForItsWordsButLiveRegistersDoNot) {
  ask_by_stop();
  const std::uint64_t asked = now();  // clock of the strobe
  bench_.read(reg::kStatus);
  EXPECT_EQ(bench_.latency(), 5u);
  bench_.read(reg::kMagic);
  EXPECT_EQ(bench_.file().time(), asked + GetParam() + 11 + 3);
}

// The request of a stop in each clock around the host's: the snapshots are never mixed. That of the stop is of its own
// clock, that of the host follows.
TEST_P(Snapshot, TheStopGoesFirstAndTheHostsIsTakenAnew) {
  const std::uint64_t busy_clocks = GetParam() + 11;
  for (std::uint64_t after = 0; after <= busy_clocks + 1; ++after) {
    SCOPED_TRACE("stop " + std::to_string(after) + " clocks after the host's request");
    const std::uint64_t host = ask_by_control();
    while (now() < host + after) clock();
    const std::uint64_t stop = ask_by_stop();
    std::uint64_t clocks = 0;
    while (busy()) {
      clock();
      ++clocks;
    }
    const bool anew = after <= busy_clocks;
    EXPECT_EQ(clocks, anew ? 2 * busy_clocks : busy_clocks);
    const Taken stopped = area(bench_, Area::Stop);
    EXPECT_TRUE(stopped.coherent);
    EXPECT_EQ(stopped.time, stop + 1);
    const Taken snap = area(bench_, Area::Snap);
    EXPECT_TRUE(snap.coherent);
    EXPECT_EQ(snap.time, anew ? stop + busy_clocks + 1 : host + 1);
  }
}

TEST_P(Snapshot, AStopDuringTheStopsOwnIsTakenAnew) {
  ask_by_stop();
  for (int i = 0; i < 4; ++i) clock();
  const std::uint64_t second = ask_by_stop();
  while (busy()) clock();
  const Taken stopped = area(bench_, Area::Stop);
  EXPECT_TRUE(stopped.coherent);
  EXPECT_EQ(stopped.time, second + 1);
}

TEST_P(Snapshot, TellsOfRefusalsAtAnyPort) {
  bench_.in.port = 3;
  bench_.write(reg::kMagic, 0);
  bench_.in.port = 0;
  bench_.write(reg::kControl, field::kControlSnapshot);
  EXPECT_NE(bench_.read(reg::status(Area::Snap)).data & field::kStatusRefused, 0u);
  EXPECT_EQ(bench_.read(reg::kStatus).data & field::kStatusRefused, 0u);
}

INSTANTIATE_TEST_SUITE_P(Axes, Snapshot, ::testing::Values(1u, 4u, 8u));

TEST(SnapshotTime, CarriesIntoItsHighWord) {
  RegisterBench bench(4);
  bench.read(reg::kMagic);
  RegisterFile file = bench.file();
  file.state().time += (std::uint64_t{7} << 32) - file.time() - 10;
  RegisterFile::Inputs in;
  const auto access = [&](bool write, std::uint32_t address, std::uint32_t data) {
    in.request = true;
    in.write = write;
    in.address = address;
    in.data = data;
    do {
      file.clock(in);
      in.request = false;
    } while (!file.outputs().ack);
    return file.outputs().data;
  };
  access(true, reg::kControl, field::kControlSnapshot);
  const std::uint64_t before = file.time() + 1;
  EXPECT_EQ(access(false, reg::time_hi(Area::Snap), 0), 6u);
  EXPECT_EQ(access(false, reg::time_lo(Area::Snap), 0), static_cast<std::uint32_t>(before));
  access(true, reg::kControl, field::kControlSnapshot);
  EXPECT_EQ(access(false, reg::time_hi(Area::Snap), 0), 7u);
}

}  // namespace
