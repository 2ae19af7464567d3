// Judges captures from the pins alone: switches that bounce behind filters of all lengths, glitches, and moving axes.
// Each genuine edge must be captured with the time of its first touch and the positions that the pins had then; nothing
// else may be captured.
#include "trammel/model/captures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <vector>

#include "core_bench.hpp"

namespace trammel::testing {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kScan = 64;    // clocks
constexpr std::uint64_t kLatency = 2;  // clocks from the first sample of the level to the time of the snapshot
constexpr std::uint64_t kFullRate = ~std::uint64_t{0};

using Random = std::mt19937_64;

struct Edge {
  std::uint64_t touch = 0;  // the clock that first samples the new level
  bool to_active = false;
};

// A switch at a pin with a filter of `scans` scans. It is quiet for long or bounces. No level during a bounce lasts
// longer than the filter, so none of them passes and the old level never counts as quiet. Without a filter each change
// is an edge of its own.
class Switch {
 public:
  Switch(Random& random, std::uint64_t scans) : random_(random), scans_(scans), left_(200 + below(500)) {}

  // Level in this clock. `calm`: no touch begins. Adds each genuine edge to `edges` once, as soon as it is decided.
  bool level(std::uint64_t clock, bool calm, std::vector<Edge>& edges) {
    if (left_ != 0) --left_;
    if (left_ != 0 || (bounces_ == 0 && calm)) return level_;
    level_ = !level_;
    if (scans_ == 0) {
      edges.push_back({clock, level_});
      left_ = below(4) == 0 ? 1 + below(5) : 150 + below(2000);
    } else if (bounces_ == 0) {
      // An odd number of further changes returns to the old level (a glitch), an even number ends at the new one.
      bounces_ = below(12);
      if (bounces_ % 2 == 0) edges.push_back({clock, level_});
      glitches_ += bounces_ % 2;
      left_ = stay();
    } else {
      --bounces_;
      left_ = stay();
    }
    return level_;
  }
  std::uint64_t glitches() const { return glitches_; }
  bool stands() const { return bounces_ == 0; }

 private:
  std::uint64_t below(std::uint64_t count) { return random_() % count; }
  std::uint64_t stay() {
    if (bounces_ == 0) return kScan * (scans_ + 3) + below(1000);
    return 1 + below(below(2) == 0 ? 6 : kScan * scans_);
  }

  Random& random_;
  std::uint64_t scans_;
  std::uint64_t left_;  // clocks left at this level
  std::uint64_t bounces_ = 0;
  std::uint64_t glitches_ = 0;
  bool level_ = false;
};

struct Round {
  unsigned axes = 4;
  unsigned units = 4;
  std::uint64_t longest = 3;  // longest filter, scans
  bool host = true;           // the host takes snapshots at any time
};

// Expected state of a unit, computed from the pins alone.
struct Watched {
  unsigned input = 0;
  std::uint32_t select = 0;
  bool off = false;        // one-shot unit that has captured
  std::deque<Edge> due{};  // the edge to be captured
  bool lost = false;       // another edge came before the host had read
};

class Judge : public CoreBench {
 public:
  Judge(const Round& round, std::uint64_t seed) : CoreBench(config(round)), round_(round), random_(seed) {
    skips = false;
    idle(700);
    for (unsigned n = 0; n < kInputs; ++n) {
      scans_[n] = n % 4 == 0 ? 0 : 1 + random_() % round.longest;
      switches_.emplace_back(random_, scans_[n]);
      write(reg::input_filter(n), static_cast<std::uint32_t>(scans_[n]));
    }
    idle(kScan * 3);
    before_clock = [this] { move_switches(); };
    after_clock = [this] { look(); };
    for (unsigned k = 0; k < round.units; ++k) select(k);
  }

  void run(std::uint64_t clocks) {
    const std::uint64_t end = core.cycles() + clocks;
    while (core.cycles() < end) {
      keep_moving();
      if (round_.host && random_() % 2 == 0) write(reg::kControl, field::kControlSnapshot);
      idle(random_() % 30);
      const std::uint32_t state = read(reg::kCaptureState);
      for (unsigned k = 0; k < round_.units; ++k) {
        if ((state >> (4 + k) & 1) != 0) take(k, state);
      }
      if (random_() % 100 == 0) reselect(static_cast<unsigned>(random_() % round_.units));
    }
  }

  std::uint64_t captured = 0, exact = 0, latest = 0, overruns = 0;
  std::uint64_t glitches() const {
    std::uint64_t sum = 0;
    for (const Switch& s : switches_) sum += s.glitches();
    return sum;
  }

 private:
  static constexpr unsigned kInputs = 8;

  static model::CardConfig config(const Round& round) {
    model::CardConfig config;
    config.axes = round.axes;
    config.engines = model::RegisterFile::kMaxEngines;
    config.inputs = kInputs;
    config.captures = round.units;
    return config;
  }

  // Lines of all axes with at least six clocks between steps.
  void keep_moving() {
    if ((core.outputs().status & field::kStatusBusy) != 0) return;
    std::vector<std::int64_t> increments;
    for (unsigned n = 0; n < round_.axes; ++n)
      increments.push_back((random_() % 2 == 0 ? -1 : 1) * (kOnePulse / static_cast<std::int64_t>(2 + random_() % 6)));
    const std::uint64_t ticks = 200 + random_() % 3000;
    EXPECT_TRUE(line(ticks, increments));
    EXPECT_TRUE(feed(ticks, kFullRate / (3 + random_() % 8)));
  }

  void move_switches() {
    std::uint32_t levels = 0;
    for (unsigned n = 0; n < kInputs; ++n) {
      std::vector<Edge> edges;
      if (switches_[n].level(core.cycles() + 1, calm_, edges)) levels |= 1U << n;
      for (const Edge& edge : edges) happens(n, edge);
    }
    pins = levels;
  }
  void happens(unsigned input, const Edge& edge) {
    for (unsigned k = 0; k < round_.units; ++k) {
      Watched& w = watched_[k];
      const std::uint32_t wanted = edge.to_active ? field::kCaptureSelectToActive : field::kCaptureSelectToInactive;
      if (w.input != input || w.off || (w.select & wanted) == 0) continue;
      if (w.due.empty())
        w.due.push_back(edge);
      else
        w.lost = true;
    }
  }

  // Records for each clock the pulses counted at the pins, and whether a snapshot is being written.
  void look() {
    const std::uint32_t rises = core.outputs().step & ~step_;
    step_ = core.outputs().step;
    for (unsigned n = 0; n < round_.axes; ++n)
      if ((rises >> n & 1) != 0) now_[n] += (core.outputs().dir >> n & 1) != 0 ? -1 : 1;
    history_.resize(core.cycles() + 1);
    history_.back() = {now_, (core.outputs().status & field::kStatusSnapshot) != 0};
  }

  // Runs `act` while no input has an edge, so that no edge can fall into the restart of a unit.
  void quietly(const std::function<void()>& act) {
    calm_ = true;
    while (!std::all_of(switches_.begin(), switches_.end(), [](const Switch& s) { return s.stands(); })) idle(1);
    idle(kScan * (round_.longest + 4));
    act();
    idle(kScan * (round_.longest + 4));
    calm_ = false;
  }
  void select(unsigned k) {
    quietly([this, k] {
      Watched w;
      w.input = static_cast<unsigned>(random_() % kInputs);
      w.select = w.input | static_cast<std::uint32_t>(1 + random_() % 3) << 8;
      if (random_() % 3 != 0) w.select |= field::kCaptureSelectContinuous;
      EXPECT_TRUE(write(reg::capture_select(k), w.select));
      watched_[k] = w;
    });
  }
  void reselect(unsigned k) {
    // A pending edge must be captured before the new selection drops it.
    quietly([this, k] {
      const std::uint32_t state = read(reg::kCaptureState);
      EXPECT_EQ((state >> (4 + k) & 1) != 0, !watched_[k].due.empty());
      EXPECT_EQ(state >> k & 1, 0U);
    });
    select(k);
  }

  // Checks the capture of unit k and clears it.
  void take(unsigned k, std::uint32_t state) {
    Watched& w = watched_[k];
    ASSERT_FALSE(w.due.empty()) << "unit " << k << ": a capture of no edge, clock " << core.cycles();
    const Edge edge = w.due.front();
    const std::uint32_t area = reg::fault(card_map::Area::Capture0) + 0x40 * k;
    const std::uint64_t time = read(area + 0x1C);
    ASSERT_GE(time, edge.touch + kLatency) << "unit " << k;
    const std::uint64_t late = time - edge.touch - kLatency;
    EXPECT_LE(late, bound()) << "unit " << k << ", touched in clock " << edge.touch;
    EXPECT_EQ((state >> (12 + k) & 1) != 0, edge.to_active);
    const bool alone = round_.units == 1 && !history_.at(edge.touch + kLatency - 1).writing;
    EXPECT_TRUE(late == 0 || !alone) << late;
    const Seen& then = history_.at(time);
    for (unsigned n = 0; n < round_.axes; ++n)
      EXPECT_EQ(static_cast<std::int32_t>(read(area + 0x20 + 4 * n)), then.position[n]) << "unit " << k;
    ++captured;
    exact += late == 0 ? 1 : 0;
    latest = std::max(latest, late);
    quietly([&] {
      const std::uint32_t last = read(reg::kCaptureState);
      // Bounces of an input without a filter count as lost here, although the unit was still busy with the first of
      // them.
      const bool overrun = (last >> (8 + k) & 1) != 0;
      EXPECT_TRUE(w.lost || !overrun);
      const bool goes_on = (w.select & field::kCaptureSelectContinuous) != 0;
      EXPECT_TRUE(overrun || !w.lost || !goes_on || scans_[w.input] == 0);
      overruns += overrun ? 1 : 0;
      EXPECT_TRUE(write(reg::kCaptureClear, 1U << k));
      w.due.clear();
      w.lost = false;
      w.off = !goes_on;
    });
    if (w.off && random_() % 4 == 0) select(k);
  }
  // Longest delay of a snapshot. One unit: the snapshot in progress and one clock. Several units: the snapshots of the
  // other units, of the host, and the host's next one.
  std::uint64_t bound() const {
    const std::uint64_t one = round_.axes + 12;
    return round_.units == 1 ? one : (round_.units + 2) * one;
  }

  struct Seen {
    std::array<std::int32_t, card_map::kMaxAxes> position;
    bool writing;
  };

  Round round_;
  Random random_;
  std::array<std::uint64_t, kInputs> scans_{};
  std::vector<Switch> switches_;
  std::array<Watched, 4> watched_{};
  std::vector<Seen> history_;  // indexed by clock
  std::array<std::int32_t, card_map::kMaxAxes> now_{};
  std::uint32_t step_ = 0;
  bool calm_ = true;
};

void judge(const Round& round, std::uint64_t clocks) {
  Judge card(round, seed() + round.axes);
  card.run(clocks);
  EXPECT_GT(card.captured, clocks / 12'000);
  EXPECT_GT(card.exact, card.captured / 2);
  EXPECT_GT(card.glitches(), clocks / 6'000);
  EXPECT_EQ(card.latest > 0, round.host || round.units > 1);
  std::cout << card.captured << " captures, " << card.exact << " exact, the latest " << card.latest << " clocks late, "
            << card.glitches() << " glitches, " << card.overruns << " overruns\n";
}

TEST(Captures, OneUnitIsExact) {
  Round round;
  round.units = 1;
  round.host = false;
  judge(round, 400'000);
}
TEST(Captures, OneUnitBesideTheHostsSnapshots) {
  for (const unsigned axes : {1U, 4U, 8U}) {
    Round round;
    round.axes = axes;
    round.units = 1;
    judge(round, 400'000);
  }
}
TEST(Captures, FourUnits) {
  for (const unsigned axes : {2U, 8U}) {
    Round round;
    round.axes = axes;
    round.longest = 7;
    judge(round, 600'000);
  }
}

// Four inputs that never rest for long, a unit on each, and the shortest filter. A snapshot of the host waits for at
// most one capture, and every access is answered.
TEST(Captures, InputsThatChatterDoNotKeepTheHostWaiting) {
  model::CardConfig config;
  config.axes = 8;
  config.engines = model::RegisterFile::kMaxEngines;
  CoreBench card(config);
  card.skips = false;
  card.idle(700);
  for (unsigned k = 0; k < 4; ++k) {
    card.write(reg::input_filter(k), k == 3 ? 0 : 1);
    card.write(reg::capture_select(k), k | field::kCaptureSelectToActive | field::kCaptureSelectContinuous);
  }
  Random random(seed());
  std::array<std::uint64_t, 4> left{};
  card.before_clock = [&] {
    for (unsigned n = 0; n < 4; ++n) {
      if (left[n]-- != 0) continue;
      card.pins ^= 1U << n;
      left[n] = (card.pins >> n & 1) != 0 ? 0 : 60 + random() % 20;  // quiet except for pulses of one clock
    }
  };
  const std::uint64_t one = config.axes + 12;
  for (unsigned i = 0; i < 2000; ++i) {
    const std::uint64_t asked = card.core.cycles();
    ASSERT_TRUE(card.write(reg::kControl, field::kControlSnapshot));
    const std::uint64_t acted = card.core.cycles();
    EXPECT_LE(acted - asked, one + 6);
    card.idle(2 * one);
    const std::uint64_t taken = card.read(reg::time_lo(card_map::Area::Snap));
    EXPECT_GE(taken, acted);
    EXPECT_LE(taken - acted, one + 1);
    card.write(reg::kCaptureClear, 0xF);
    card.idle(random() % 40);
  }
  EXPECT_GT(card.read(reg::kCaptureState) >> field::kCaptureStateSnapshotsShift, 1000U);
}

// Probing along +X with a step every six clocks; input 2 trips when it is high, behind a filter.
class ProbeBehindAFilter : public CoreBench {
 public:
  explicit ProbeBehindAFilter(std::uint32_t scans, std::uint32_t engines = model::RegisterFile::kMaxEngines)
      : CoreBench(config(engines)) {
    idle(700);
    EXPECT_TRUE(write(reg::input_filter(2), scans));
    idle(2 * kScan * (scans + 2));
    EXPECT_TRUE(probe(0x20 | 2));
    EXPECT_TRUE(line(20'000, {kOnePulse / 3}));
    EXPECT_TRUE(feed(20'000, kFullRate / 2));
    EXPECT_TRUE(probe_end());
    idle(500);
  }
  // Keeps the input at a level for `clocks`; returns the first clock that samples it.
  std::uint64_t stand(bool level, std::uint64_t clocks) {
    pins = level ? 4 : 0;
    const std::uint64_t touch = core.cycles() + 1;
    idle(clocks);
    return touch;
  }
  bool has(std::uint32_t bit) const { return (core.outputs().status & bit) != 0; }
  std::int64_t pulses_until(std::uint64_t cycle) const {
    return std::count_if(steps.pins.begin(), steps.pins.end(),
                         [cycle](const auto& pin) { return std::get<0>(pin) <= cycle; });
  }
  void expect_latched_at(std::uint64_t touch) {
    EXPECT_TRUE(has(field::kStatusProbed));
    EXPECT_EQ(read(reg::time_lo(card_map::Area::Probe)), touch + kLatency);
    EXPECT_EQ(read(reg::position(card_map::Area::Probe, 0)), pulses_until(touch + kLatency));
    EXPECT_GT(pulses_until(touch + kLatency), 50);
  }

 private:
  static model::CardConfig config(std::uint32_t engines) {
    model::CardConfig config;
    config.engines = engines;
    config.inputs = 8;
    return config;
  }
};

TEST(ProbeWithCaptures, LatchesTheFirstTouchAndTripsBehindTheFilter) {
  for (std::uint64_t phase = 0; phase < kScan; ++phase) {
    ProbeBehindAFilter card(5);
    card.idle(phase);
    const std::uint64_t touch = card.stand(true, 3);
    card.stand(false, 200);
    card.stand(true, 40);
    card.stand(false, 5 * kScan);
    card.stand(true, 5 * kScan);
    EXPECT_FALSE(card.has(field::kStatusProbed)) << phase;
    card.idle(kScan + 10);
    card.expect_latched_at(touch);
  }
}

TEST(ProbeWithCaptures, AGlitchTripsNothing) {
  for (std::uint64_t phase = 0; phase < kScan; ++phase) {
    ProbeBehindAFilter card(5);
    card.idle(phase);
    card.stand(true, 5 * kScan);
    card.stand(false, 6 * kScan + 10);
    EXPECT_FALSE(card.has(field::kStatusProbed | field::kStatusHeld)) << phase;
    card.expect_latched_at(card.stand(true, 7 * kScan));
  }
  ProbeBehindAFilter card(5);
  card.stand(true, 100);
  card.stand(false, 60'000);
  EXPECT_TRUE(card.has(field::kStatusProbeMissed));
  EXPECT_FALSE(card.has(field::kStatusProbed | field::kStatusBusy));
  EXPECT_EQ(card.core.position(0), card.pulses_until(card.core.cycles()));
  EXPECT_GT(card.core.position(0), 6'000U);
}

// Without captures the snapshot is taken at the end of the filter. Without a filter, captures make it one clock earlier
// and change nothing else.
TEST(ProbeWithCaptures, WithoutThemTheFilterCounts) {
  constexpr std::uint32_t kWithout =
      model::RegisterFile::kMaxEngines & ~(card_map::engines::kCaptures | card_map::engines::kCaptureFifo);
  ProbeBehindAFilter late(5, kWithout);
  const std::uint64_t touch = late.stand(true, 7 * kScan);
  EXPECT_GT(late.read(reg::time_lo(card_map::Area::Probe)), touch + 5 * kScan);
  std::array<std::vector<CoreBench::Shown>, 2> logs;
  for (const bool with : {false, true}) {
    ProbeBehindAFilter card(0, with ? model::RegisterFile::kMaxEngines : kWithout);
    card.logs = true;
    const std::uint64_t edge = card.stand(true, 1);
    card.stand(false, 5000);
    card.expect_latched_at(with ? edge : edge + 1);
    EXPECT_TRUE(card.write(reg::kControl, field::kControlProbeClear));
    card.stand(false, 500);
    EXPECT_FALSE(card.has(field::kStatusBusy));
    logs[with ? 1 : 0] = card.log;
  }
  // The PROBE area is written one clock later, which may delay an access of the host.
  const auto same = [](const CoreBench::Shown& a, const CoreBench::Shown& b) {
    return a.outputs.step == b.outputs.step && a.outputs.dir == b.outputs.dir && a.position == b.position;
  };
  EXPECT_TRUE(std::equal(logs[0].begin(), logs[0].end(), logs[1].begin(), logs[1].end(), same));
}

}  // namespace
}  // namespace trammel::testing
