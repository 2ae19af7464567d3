// Latency from the pin of an input to its role and to FAULT, against the table in docs/reference/behaviour.md, for a
// change in any clock of a scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr unsigned kScan = 64;  // clocks

struct Range {
  std::uint64_t least = UINT64_MAX;
  std::uint64_t most = 0;

  void add(std::uint64_t clocks) {
    least = std::min(least, clocks);
    most = std::max(most, clocks);
  }
};
struct Latencies {
  Range raw, level, role, fault;
};

// Latencies of input 2, the fault input of the drive of axis 1, with a filter of `scans` scans.
Latencies measured(std::uint32_t scans) {
  Latencies result;
  for (unsigned phase = 0; phase < kScan; ++phase) {
    model::CardConfig config;
    config.engines = model::RegisterFile::kMaxEngines;
    CoreBench bench(config);
    bench.idle(400);
    bench.write(reg::role(33), 4);
    bench.write(reg::input_filter(2), scans);
    bench.idle(200 + phase);
    const std::uint64_t begun = bench.core.cycles();
    bench.pins = 4;
    Latencies seen;
    const auto look = [&](Range& range, bool now) {
      if (now && range.most == 0) range.add(bench.core.cycles() - begun);
    };
    while (seen.fault.most == 0 && bench.core.cycles() < begun + 100'000) {
      bench.clock({});
      const model::CoreModel::State& state = bench.core.state();
      look(seen.raw, state.inputs.raw() == 4);
      look(seen.level, state.inputs.levels() == 4);
      look(seen.role, state.inputs.roles().drive_fault == 2);
      look(seen.fault, (state.motion.stop().fault & field::kFaultDriveFault) != 0);
    }
    result.raw.add(seen.raw.most);
    result.level.add(seen.level.most);
    result.role.add(seen.role.most);
    result.fault.add(seen.fault.most);
  }
  return result;
}

void expect_between(const Range& range, std::uint64_t least, std::uint64_t most) {
  EXPECT_EQ(range.least, least);
  EXPECT_EQ(range.most, most);
}

TEST(InputLatency, WithoutAFilter) {
  const Latencies l = measured(0);
  expect_between(l.raw, 2, 2);
  expect_between(l.level, 2, 2);
  expect_between(l.role, 3, 66);
  expect_between(l.fault, 5, 68);
}

TEST(InputLatency, WithFiltersOfAnyLength) {
  for (const std::uint32_t scans : {1U, 2U, 5U, 100U}) {
    SCOPED_TRACE(scans);
    const Latencies l = measured(scans);
    expect_between(l.raw, 2, 2);
    // Longer than the filter by at most one scan, plus the synchroniser.
    expect_between(l.level, kScan * scans + 3, kScan * (scans + 1) + 2);
    EXPECT_LE(l.role.most, kScan * (scans + 2) + 2);
    EXPECT_EQ(l.fault.most, l.role.most + 2);
  }
}

}  // namespace
}  // namespace trammel::testing
