// Tests of the card's judge: it detects an error in every compared signal and names the signal; no output is left
// out; the RTL that runs behind the model is compared as if they ran together; one evaluation per clock equals two.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <random>
#include <string>
#include <string_view>

#include "Vcard4.h"
#include "card_variant.hpp"
#include "host.hpp"
#include "lockstep_card.hpp"
#include "rtl_engine.hpp"

namespace trammel::sim {
namespace {

using model::CardModel;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::uint32_t kClockHz = 1'000'000;
constexpr std::uint64_t kResetClocks = 5;  // clocks before the first cycle that is compared

// A correct card that shows one wrong word in one cycle.
class Liar : public VerilatedCard {
 public:
  Liar(std::uint64_t cycle, std::size_t offset, std::uint32_t wrong_bits)
      : cycle_(cycle), offset_(offset), wrong_bits_(wrong_bits) {}

  void run(const CardModel::Inputs& in, std::size_t clocks, CardRecord* records) override {
    card_->run(in, clocks, records);
    for (std::size_t i = 0; i < clocks; ++i) {
      if (++clocks_ != cycle_ + kResetClocks) continue;
      char* const word = reinterpret_cast<char*>(records + i) + offset_;
      std::uint32_t value = 0;
      std::memcpy(&value, word, sizeof value);
      value ^= wrong_bits_;
      std::memcpy(word, &value, sizeof value);
    }
  }

 private:
  std::unique_ptr<VerilatedCard> card_ = make_card<4>({kClockHz, 0});
  std::uint64_t cycle_;
  std::size_t offset_;
  std::uint32_t wrong_bits_;
  std::uint64_t clocks_ = 0;
};

// The mismatch report of `scenario`; empty if there is none.
template <class Scenario>
std::string report_of(Scenario scenario) {
  try {
    scenario();
  } catch (const lockstep::Mismatch& mismatch) {
    return mismatch.what();
  }
  return {};
}

std::string report_of_lie(std::uint64_t cycle, std::size_t offset, std::uint32_t wrong_bits, std::size_t batch,
                          RtlThread thread = RtlThread::kCallers) {
  return report_of([&] {
    LockstepCard card(std::make_unique<Liar>(cycle, offset, wrong_bits), CardModel::Config{}, 5, batch, thread);
    card.run({}, 5000);
    card.settle();
  });
}

// One bit of one signal in one cycle: at the borders of a batch, within one, and after the last full one. The report
// is the same whether the RTL follows in batches, in its own thread, or clock by clock.
TEST(CardJudge, EverySignalIsCaughtAndNamedWithItsCycle) {
  for (const CardSignal& signal : kCardSignals) {
    for (std::size_t n = 0; n < signal.words; ++n) {
      for (const std::uint64_t cycle : {1U, 700U, 2048U, 2049U, 4999U, 5000U}) {
        const std::size_t offset = signal.offset + 4 * n;
        const std::uint32_t bit = 1U << cycle % 32;
        const std::string report = report_of_lie(cycle, offset, bit, LockstepCard::kBatch);
        EXPECT_THAT(report, StartsWith(fmt::format("card: cycle {}: {} is 0x", cycle, signal.name)));
        EXPECT_THAT(report, HasSubstr("repeat with TRAMMEL_SEED=5 TRAMMEL_STATE_SEED="));
        EXPECT_EQ(report_of_lie(cycle, offset, bit, 1), report);
        EXPECT_EQ(report_of_lie(cycle, offset, bit, LockstepCard::kBatch, RtlThread::kOwn), report);
      }
    }
  }
}

TEST(CardJudge, ReportHasBothValues) {
  // At rest both rooms are the depths of the queues.
  const std::string report = report_of_lie(100, offsetof(CardRecord, feed_room), 0x1, 64);
  EXPECT_THAT(report, StartsWith("card: cycle 100: feed_room is 0xa01 (2561) in RTL, 0xa00 (2560) in the model\n"));
}

TEST(CardJudge, EventsUpToTheCycleAreReported) {
  SimulationOptions options;
  const auto card = make_rtl_engine(std::make_unique<Liar>(450, offsetof(CardRecord, irq_o), 1), options);
  // While a write is answered no other one runs, so the events are some clocks apart.
  const std::uint64_t begin = card->cycles();
  std::string expected;
  std::string too_late;
  for (std::uint32_t i = 0; card->cycles() - begin < 600; ++i) {
    (card->cycles() - begin < 450 ? expected : too_late) =
        fmt::format("cycle {}: written {:#x}\n", card->cycles() - begin, i);
    card->write(card_map::reg::step_length(0), i);
  }
  const std::string report = report_of([&] { card->lockstep_cycles(); });
  EXPECT_THAT(report, StartsWith("card: cycle 450: irq_o is 0x1 (1) in RTL"));
  EXPECT_THAT(report, HasSubstr(expected));
  EXPECT_THAT(report, Not(HasSubstr(too_late)));
}

// A mismatch at the start of a batch is reported with the last events of the previous batch, although the model was
// ahead.
TEST(CardJudge, ReportOfTheRtlsOwnThreadIsTheCallers) {
  for (const std::uint64_t cycle : {150U, 2049U, 3000U, 4097U}) {
    const auto report = [cycle](bool rtl_thread) {
      SimulationOptions options;
      options.rtl_thread = rtl_thread;
      const auto card = make_rtl_engine(std::make_unique<Liar>(cycle, offsetof(CardRecord, irq_o), 1), options);
      return report_of([&] {
        for (std::uint32_t i = 0; i < 3000; ++i) card->write(card_map::reg::step_length(0), i);
      });
    };
    const std::string expected = report(false);
    EXPECT_THAT(expected, StartsWith(fmt::format("card: cycle {}: irq_o is 0x1 (1) in RTL", cycle)));
    EXPECT_EQ(report(true), expected);
  }
}

// A card whose run fails, and fails again in each later one.
class Broken : public VerilatedCard {
 public:
  explicit Broken(std::uint64_t clocks) : left_(clocks + kResetClocks) {}

  void run(const CardModel::Inputs& in, std::size_t clocks, CardRecord* records) override {
    card_->run(in, clocks, records);
    if (left_ == 0) throw std::runtime_error("broken twice");
    left_ -= std::min<std::uint64_t>(left_, clocks);
    if (left_ == 0) throw std::runtime_error("broken");
  }

 private:
  std::unique_ptr<VerilatedCard> card_ = make_card<4>({kClockHz, 0});
  std::uint64_t left_;
};

// An exception of the RTL's thread comes out of a call, and the rest is dropped; the second batch is under way then.
TEST(CardJudge, ErrorsOfTheRtlsThreadReachTheCaller) {
  LockstepCard card(std::make_unique<Broken>(1000), CardModel::Config{}, 5, LockstepCard::kBatch, RtlThread::kOwn);
  EXPECT_THROW(card.run({}, 100'000), std::runtime_error);
  EXPECT_EQ(card.cycles(), 0U);
}

// Wrong in every clock: after the first report, no second one may end the process.
TEST(CardJudge, NothingIsComparedAfterAMismatch) {
  class Wrong : public VerilatedCard {
   public:
    void run(const CardModel::Inputs&, std::size_t clocks, CardRecord* records) override {
      for (std::size_t i = 0; i < clocks; ++i) records[i].tick = 5;
    }
  };
  for (const RtlThread thread : {RtlThread::kCallers, RtlThread::kOwn}) {
    LockstepCard card(std::make_unique<Wrong>(), CardModel::Config{}, 5, LockstepCard::kBatch, thread);
    EXPECT_THAT(report_of([&] { card.run({}, 100'000); }), HasSubstr("cycle 1: tick is 0x5"));
    EXPECT_EQ(card.cycles(), 1U);
    EXPECT_EQ(report_of([&] { card.settle(); }), "");
  }
}

// A query of the comparison state reports mismatches in clocks that the RTL had not finished yet.
class CardJudgeThreads : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(RtlThread, CardJudgeThreads, testing::Bool());

TEST_P(CardJudgeThreads, QueriesCatchUp) {
  const auto engine = [] {
    SimulationOptions options;
    options.rtl_thread = GetParam();
    return make_rtl_engine(std::make_unique<Liar>(20, offsetof(CardRecord, dir_o), 8), options);
  };
  const auto first = engine();
  first->wait(30);
  EXPECT_THAT(report_of([&] { first->lockstep_cycles(); }), HasSubstr("cycle 20: dir_o"));
  const auto second = engine();
  second->wait(30);
  EXPECT_THAT(report_of([&] { second->comparisons(); }), HasSubstr("cycle 20: dir_o"));
  const auto third = engine();
  EXPECT_THAT(report_of([&] { third->wait(100'000); }), HasSubstr("cycle 20: dir_o"));
}

TEST(CardJudgeDeathTest, MismatchAtTheEndIsNotLost) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  // A mismatch in the last, unfinished batch, and in the batch before, which the RTL's thread has when the card is
  // destroyed.
  for (const std::uint64_t clocks : {10U, 2048U + 10U}) {
    for (const RtlThread thread : {RtlThread::kCallers, RtlThread::kOwn}) {
      if (clocks > LockstepCard::kBatch && thread == RtlThread::kCallers) continue;
      EXPECT_DEATH(
          {
            LockstepCard card(std::make_unique<Liar>(9, offsetof(CardRecord, tick), 1), CardModel::Config{}, 5,
                              LockstepCard::kBatch, thread);
            card.run({}, clocks);
          },
          "cycle 9: tick is 0x1");
    }
  }
}

// Signals per cycle on every card: 18 of the core, 8 of the bus (docs/developer/architecture.md); plus one position
// per axis.
TEST_P(CardJudgeThreads, EverySignalIsComparedInEveryCycle) {
  for (const unsigned axes : {4U, 8U}) {
    SimulationOptions options;
    options.axes = axes;
    options.rtl_thread = GetParam();
    const auto card = make_engine(options);
    const std::uint64_t begin = card->cycles();
    const std::uint64_t compared_before = lockstep::compared();
    card->wait(3000);
    card->read(card_map::reg::kStatus);
    card->wait(3000);
    EXPECT_GT(card->cycles() - begin, 6000U);
    EXPECT_EQ(*card->lockstep_cycles(), card->cycles() - begin);
    EXPECT_EQ(card->comparisons(), (card->cycles() - begin) * (26 + axes));
    EXPECT_EQ(lockstep::compared() - compared_before, card->cycles() - begin);
  }
}

// The pulse counts of an axis: its position includes them one clock later.
bool shows_later(const std::string& port, unsigned bit) {
  if (port != "observe_o" || bit < bus::observe::kWidth) return false;
  return (bit - bus::observe::kWidth) % bus::axis_observe::kWidth >= bus::axis_observe::kCounts.offset;
}

// Any bit of any output that changes is visible in the record; this test covers every output.
TEST(CardJudge, EveryBitOfEveryOutputIsCompared) {
  VerilatedContext context;
  Vcard4 rtl(&context);
  rtl.bvalid_o = rtl.rvalid_o = 1;
  const auto seen = [&rtl] {
    CardRecord record;
    record.show_rtl<4>(rtl);
    return record;
  };
  const CardRecord before = seen();
  unsigned ports = 0;
  const auto turn = [&](auto& port, unsigned low, unsigned width, const char* name) {
    for (unsigned bit = 0; bit < width; ++bit) {
      if (shows_later(name, low + bit)) continue;
      port = static_cast<std::remove_reference_t<decltype(port)>>(port ^ 1U << bit);
      const CardRecord after = seen();
      EXPECT_NE(std::memcmp(&before, &after, sizeof before), 0) << name << " bit " << low + bit;
      port = static_cast<std::remove_reference_t<decltype(port)>>(port ^ 1U << bit);
    }
    if (low == 0) ++ports;
  };
  turn(rtl.awready_o, 0, 1, "awready_o");
  turn(rtl.wready_o, 0, 1, "wready_o");
  turn(rtl.bvalid_o, 0, 1, "bvalid_o");
  turn(rtl.bresp_o, 0, 2, "bresp_o");
  turn(rtl.arready_o, 0, 1, "arready_o");
  turn(rtl.rvalid_o, 0, 1, "rvalid_o");
  turn(rtl.rdata_o, 0, 32, "rdata_o");
  turn(rtl.rresp_o, 0, 2, "rresp_o");
  turn(rtl.step_o, 0, 4, "step_o");
  turn(rtl.dir_o, 0, 4, "dir_o");
  turn(rtl.output_o, 0, 4, "output_o");
  turn(rtl.irq_o, 0, 1, "irq_o");
  constexpr unsigned kObserved = bus::observe::kWidth + 4 * bus::axis_observe::kWidth;
  for (unsigned low = 0; low < kObserved; low += 32) {
    turn(rtl.observe_o[low / 32], low, std::min(32U, kObserved - low), "observe_o");
  }
  std::ifstream source(TRAMMEL_CARD_SOURCE);
  constexpr std::string_view kOutput = "output logic ";
  unsigned outputs = 0;
  for (std::string line; std::getline(source, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    if (first != std::string::npos && line.compare(first, kOutput.size(), kOutput) == 0) ++outputs;
  }
  EXPECT_EQ(ports, outputs);
}

// Compares the card with one evaluation per clock with the card with both edges evaluated, in every clock, including
// reset.
class Pair : public VerilatedCard {
 public:
  Pair(std::uint64_t& clocks, std::uint64_t& different) : clocks_(clocks), different_(different) {}

  void run(const CardModel::Inputs& in, std::size_t clocks, CardRecord* records) override {
    std::vector<CardRecord> both(clocks);
    one_.run(in, clocks, records);
    both_.run(in, clocks, both.data());
    for (std::size_t i = 0; i < clocks; ++i) different_ += std::memcmp(&both[i], records + i, sizeof both[i]) != 0;
    clocks_ += clocks;
  }

 private:
  CardVariant<Vcard4, 4> one_{CardStraps{kClockHz, 0}};
  BothEdgesVariant<Vcard4, 4> both_{CardStraps{kClockHz, 0}};
  std::uint64_t& clocks_;
  std::uint64_t& different_;
};

TEST(CardJudge, OneEvaluationAClockIsAsGoodAsTwo) {
  std::uint64_t clocks = 0;
  std::uint64_t different = 0;
  const auto card = make_rtl_engine(std::make_unique<Pair>(clocks, different), SimulationOptions{});
  test::Host host(*card);
  const std::uint64_t seed = lockstep::seed_from_environment(3);
  std::mt19937_64 engine(seed);
  const auto random = [&engine](std::uint64_t count) { return engine() % count; };
  while (card->cycles() < lockstep::scaled(500'000)) test::random_section(host, random, 4);
  EXPECT_EQ(*card->lockstep_cycles() + kResetClocks, clocks);
  EXPECT_EQ(different, 0U);
}

}  // namespace
}  // namespace trammel::sim
