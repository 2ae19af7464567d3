#include "trammel/report/report_writer.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "text.hpp"
#include "time_map.hpp"
#include "trammel/model/step_shaper.hpp"
#include "trammel/report/page.hpp"

namespace trammel::report {
namespace {

TEST(InsideScript, NothingOfTheJsonEndsItsElement) {
  EXPECT_EQ(inside_script(R"({"a":"</script><!--"})"), R"({"a":"\u003c/script>\u003c!--"})");
}

TEST(ReportWriter, WithoutAPageItSaysHowToGetOne) {
  if (page_is_built()) GTEST_SKIP() << "this build has the page";
  Text text;
  const machine::Machine machine = machine::default_machine();
  EXPECT_THROW(ReportWriter(text, machine, {}), std::logic_error);
}

TEST(TurnClocks, AreTheShapersWhateverItsTimes) {
  std::mt19937 random(3);
  int turns = 0;
  for (int round = 0; round < 50; ++round) {
    model::StepShaper shaper;
    model::StepShaper::Inputs in;
    in.step_length = static_cast<std::uint16_t>(random() % 20);
    in.step_space = static_cast<std::uint16_t>(random() % 20);
    in.dir_setup = static_cast<std::uint16_t>(random() % 40);
    in.dir_hold = static_cast<std::uint16_t>(random() % 40);
    const std::uint64_t apart = 60 + random() % 200;
    bool dir = false;
    bool step = false;
    std::uint64_t turned = 0;
    for (std::uint64_t clock = 0; clock < 3000; ++clock) {
      in.step = clock % apart == 0;
      in.dir = clock / apart % 3 == 2;
      shaper.clock(in);
      if (shaper.outputs().dir != dir) turned = clock;
      if (shaper.outputs().step && !step && turned != 0) {
        EXPECT_EQ(clock - turned, in.dir_setup + kTurnClocks);
        turned = 0;
        ++turns;
      }
      dir = shaper.outputs().dir;
      step = shaper.outputs().step;
    }
  }
  EXPECT_GT(turns, 200);
}

// A straight line is kept as two points, and a bend is kept within the tolerance.
TEST(TimeMap, KeepsFewPointsAndStaysNearAllOthers) {
  std::vector<TimeMap::Point> given;
  std::vector<TimeMap::Point> kept;
  TimeMap map;
  const auto keep = [&](const TimeMap::Point& point) { kept.push_back(point); };
  const auto motion_at = [](std::uint64_t cycle) {
    // Full speed, then a ramp down over 100,000 clocks, then a tenth of full speed.
    if (cycle < 500'000) return static_cast<double>(cycle);
    const double t = std::min(100'000.0, static_cast<double>(cycle) - 500'000);
    const double rest = std::max(0.0, static_cast<double>(cycle) - 600'000);
    return 500'000 + t - 0.9 * t * t / 200'000 + 0.1 * rest;
  };
  for (std::uint64_t cycle = 1000; cycle < 1'000'000; cycle += 1000) {
    const TimeMap::Point point{static_cast<std::uint64_t>(motion_at(cycle)), cycle, cycle == 1000, 0};
    given.push_back(point);
    map.add(point, keep);
  }
  map.flush(keep);
  EXPECT_LT(kept.size(), 150U);
  EXPECT_EQ(kept.back().cycle, given.back().cycle);
  std::size_t i = 0;
  for (const TimeMap::Point& point : given) {
    while (i + 2 < kept.size() && kept[i + 1].cycle < point.cycle) ++i;
    const double share =
        static_cast<double>(point.cycle - kept[i].cycle) / static_cast<double>(kept[i + 1].cycle - kept[i].cycle);
    const double motion = static_cast<double>(kept[i].motion) +
                          share * (static_cast<double>(kept[i + 1].motion) - static_cast<double>(kept[i].motion));
    EXPECT_NEAR(motion, static_cast<double>(point.motion), TimeMap::kTolerance + 0.01) << point.cycle;
  }
}

}  // namespace
}  // namespace trammel::report
