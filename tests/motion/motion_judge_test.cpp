// Whole programs under the independent reading of motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "judged_program.hpp"

namespace trammel::test {
namespace {

constexpr std::uint32_t kFastClock = 50'000'000;  // the bus must carry 15,000 lines per second at this clock

// With TRAMMEL_LONG all thousand programs run.
bool long_run() { return std::getenv("TRAMMEL_LONG") != nullptr; }
unsigned random_programs() { return long_run() ? 1000 : 60; }

TEST(MotionJudge, RandomProgramsAreWithinTheirLimits) {
  std::vector<unsigned> seeds(random_programs());
  std::iota(seeds.begin(), seeds.end(), 1U);
  // Those of the thousand that have a ramp after a few ticks at a rate near one per clock.
  if (!long_run()) seeds.insert(seeds.end(), {291, 367, 795});
  for (const unsigned seed : seeds) {
    const double jerk = seed % 2 == 0 ? 20000 : 0;
    SCOPED_TRACE(fmt::format("seed {}, jerk {}", seed, jerk));
    const std::string program = random_lines(seed);
    gcode::TextLines lines(program, "program");
    const machine::Machine machine = machine_of(100, 1000, jerk);
    const Planned planned(lines, machine, kClock);
    const MotionVerdict verdict = judge_motion(planned.commands, {machine, kClock, 0.01});
    expect_within_limits(verdict);
    EXPECT_GT(verdict.acceleration.share, 0.8);
    EXPECT_NEAR(verdict.seconds(kClock), planned.seconds, 0.001 * planned.seconds);
  }
}

// Phases of a few ticks, 2 ms at most: rounding to whole ticks takes no axis beyond its acceleration. A piece begins
// and ends at whole ticks, so at its border the acceleration jumps by the jerk of up to two ticks. This is most where
// ticks are slowest: at 500 mm/s^2 the acceleration of a stop begins to fall at 0.5 mm/s, where one tick lasts an
// eighth of the phase.
TEST(MotionJudge, RampsOfAFewTicksAreWithinTheirLimits) {
  double worst = 0;
  double jump = 0;
  double ticks = 0;
  for (unsigned seed = 1; seed <= (long_run() ? 500U : 40U); ++seed) {
    for (const double acceleration : {500.0, 1000.0, 3000.0}) {
      const std::string program = random_lines(seed);
      SCOPED_TRACE(fmt::format("seed {}, acceleration {}", seed, acceleration));
      gcode::TextLines lines(program, "program");
      const machine::Machine machine = machine_of(100, acceleration, 500 * acceleration);
      const Planned planned(lines, machine, 10 * kClock);
      MotionVerdict verdict = judge_motion(planned.commands, {machine, 10 * kClock, 0.01});
      worst = std::max(worst, verdict.acceleration.share);
      jump = std::max(jump, verdict.acceleration_jump.share);
      ticks = std::max(ticks, verdict.acceleration_jump_ticks.share);
      verdict.acceleration_jump.share = 0;
      expect_within_limits(verdict);
    }
  }
  EXPECT_LE(jump, 0.125);
  EXPECT_LE(ticks, 2);
  RecordProperty("acceleration", std::to_string(worst));
  RecordProperty("acceleration_jump", std::to_string(jump));
  RecordProperty("acceleration_jump_ticks", std::to_string(ticks));
}

// An axis outside X Y Z moves along, up to 32 times as far; the path is still that of X Y Z. The ticks per mm change at
// corners by up to this factor. With the first five seeds the rate would jump there if the part of the new path at the
// old rate counted as motion.
TEST(MotionJudge, ProgramsWithAFurtherAxisAreWithinTheirLimits) {
  std::vector<unsigned> seeds = {65, 93, 191, 219, 239};
  for (unsigned seed = 1; seed <= (long_run() ? 250U : 30U); ++seed) seeds.push_back(seed);
  for (const unsigned seed : seeds) {
    const double jerk = seed % 2 == 0 ? 20000 : 0;
    SCOPED_TRACE(fmt::format("seed {}, jerk {}", seed, jerk));
    const std::string program = random_lines(seed, true);
    gcode::TextLines lines(program, "program");
    const machine::Machine machine = machine_of(100, 1000, jerk);
    const Planned planned(lines, machine, 10 * kClock);
    const MotionVerdict verdict = judge_motion(planned.commands, {machine, 10 * kClock, 0.01});
    expect_within_limits(verdict);
    EXPECT_NEAR(verdict.seconds(10 * kClock), planned.seconds, 0.001 * planned.seconds);
  }
}

// 40 mm of short chords that bend both ways, with changing feeds. With the slow clock the density of ticks changes too.
std::string bends_with_feeds(unsigned seed) {
  std::mt19937 random(seed);
  std::string program = "G21 G90 G94\n";
  double x = 0, y = 0, heading = 0, turn = 0;
  for (int i = 0; i < 800; ++i) {
    if (i % 50 == 0) {
      turn = std::uniform_real_distribution<>(-0.03, 0.03)(random);
      program += fmt::format("F{:.0f}\n", std::uniform_real_distribution<>(1000, 18000)(random));
    }
    heading += random() % 3 == 0 ? turn : 0;
    x += 0.05 * std::cos(heading);
    y += 0.05 * std::sin(heading);
    program += fmt::format("G1 X{:.4f} Y{:.4f}\n", x, y);
  }
  return program + "M2\n";
}

// A window shorter than the stopping distance makes the motion slow down in the middle of the path and speed up again.
TEST(MotionJudge, ShortWindowsAreWithinTheirLimits) {
  constexpr double kJerk = 100'000;
  // With the last three seeds, a piece shorter than an update comes before a change of density.
  for (const unsigned seed : {1U, 2U, 42U, 78U, 68U, 74U, 96U}) {
    SCOPED_TRACE(seed);
    const std::uint32_t clock = seed % 2 == 0 ? kClock : 10 * kClock;
    const std::string program = bends_with_feeds(seed);
    gcode::TextLines lines(program, "program");
    machine::Machine machine = fast_machine(kJerk);
    machine.motion.window = 16;
    const Planned planned(lines, machine, clock);
    expect_within_limits(judge_motion(planned.commands, {machine, static_cast<double>(clock), 0.01}));
  }
}

// Almost no length or speed: an arc in chords with more ticks than its length has, a stop shorter than a tick, a line
// of 18 s. The feed must not reach 0 before the ticks end.
TEST(MotionJudge, PiecesEndInTheirTime) {
  struct Case {
    const char* program;
    std::array<double, 4> scale;  // steps/mm
    std::array<double, 4> jerk;
  };
  const Case cases[] = {
      {"F4.86\nG19\nG1 X0.09309 Y-0.03382\nG1 X0.09388 Y-0.04620 Z-0.03285 E0.5\n"
       "G3 Y-0.04620 Z-0.03285 J0.01127 K0.01756 P2\nM2\n",
       {21.4, 21.4, 21.4, 21.4},
       {20000, 20000, 20000, 20000}},
      {"F1.74\nG1 X-0.00158 Y-0.00927 E0.08581\nG1 X-0.01054 Y-0.01859 E0.08070\nG1 X-0.01262 Y-0.02608\n"
       "G1 X-0.00199 Y-0.02493\nM2\n",
       {666, 349, 80, 84},
       {95000, 18800, 9000, 97000}},
      {"F600\nG1 X0.02 Y0.028\nG3 X0.00409 Y-0.00718 I0.00964 J-0.02555\nG93\nG1 X-0.01253 Y-0.01215 F3.241\n"
       "G2 X-0.01253 Y-0.01215 I0.01705 J-0.03611 F1325\nM2\n",
       {30.85, 30.85, 30.85, 30.85},
       {20000, 20000, 20000, 20000}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.program);
    machine::Machine machine = machine_of(150, 1000, 0);
    machine.motion.junction_deviation = 0.001;
    for (std::size_t axis = 0; axis < 4; ++axis) {
      machine.axes[axis].steps_per_mm = one.scale[axis];
      machine.axes[axis].max_jerk = one.jerk[axis];
    }
    gcode::TextLines lines(one.program, "program");
    const Planned planned(lines, machine, kClock);
    const MotionVerdict verdict = judge_motion(planned.commands, {machine, kClock, 0.001});
    EXPECT_NEAR(verdict.seconds(kClock), planned.seconds, 0.002 * planned.seconds);
  }
}

// With G64 P, arcs in main planes and chords in other planes replace the corners.
TEST(MotionJudge, BlendedProgramsAreWithinTheirLimits) {
  for (unsigned seed = 1; seed <= random_programs() / 4; ++seed) {
    const double jerk = seed % 2 == 0 ? 20000 : 0;
    const std::string program = fmt::format("G64 P{}\n", seed % 3 == 0 ? 1.0 : 0.3) + random_lines(seed);
    SCOPED_TRACE(fmt::format("seed {}, jerk {}", seed, jerk));
    gcode::TextLines lines(program, "program");
    const machine::Machine machine = machine_of(100, 1000, jerk);
    const Planned planned(lines, machine, 10 * kClock);
    EXPECT_GT(planned.blends, 10U);
    const MotionVerdict verdict = judge_motion(planned.commands, {machine, 10 * kClock, 0.01});
    expect_within_limits(verdict);
    EXPECT_NEAR(verdict.seconds(10 * kClock), planned.seconds, 0.001 * planned.seconds);
  }
}

TEST(MotionJudge, StepsFollowTheCommandedMotion) {
  for (unsigned seed = 1; seed <= (long_run() ? 1000U : 10U); ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const machine::Machine machine = machine_of(100, 1000, seed % 2 == 0 ? 20000 : 0);
    EXPECT_LE(Program(text(random_lines(seed)), machine, 10 * kClock).farthest(), 0.8);
  }
}

#ifdef TRAMMEL_SHARED_GCODE_DIR
// Only a short program without TRAMMEL_LONG. The steps of octocat would not fit in memory.
TEST(MotionJudge, StepsFollowRealPrograms) {
  using Names = std::vector<std::string>;
  for (const std::string& name : long_run()
                                     ? Names{"tball", "jsdc-laser", "circle-inch", "arc-xz-plane", "arc-yz-plane"}
                                     : Names{"arc-xz-plane"}) {
    SCOPED_TRACE(name);
    const run::ProgramLines lines = [&] {
      return std::make_unique<gcode::FileLines>(TRAMMEL_SHARED_GCODE_DIR "/" + name + ".gcode");
    };
    Program program(lines, machine_of(100, 1000, 20000), 10 * kClock);
    EXPECT_GT(program.recorder().steps.size(), 1000U);
    EXPECT_LE(program.farthest(), 0.8);
  }
}
#endif

TEST(MotionJudge, StepsFollowABlendedMotion) {
  const std::string program = "G21 G90 G94 F3000 G64 P0.5\nG1 X8\nY8\nX2 Y9 Z3\nG2 X5 Y6 I3\nG1 X0 Y1\nM2\n";
  EXPECT_LE(Program(text(program), machine_of(100, 1000, 0), 10 * kClock).farthest(), 0.8);
}

#ifdef TRAMMEL_SHARED_GCODE_DIR
// The clock does not change the ticks per pulse between lines and blends.
TEST(MotionJudge, OctocatBlendedIsWithinItsLimits) {
  std::ifstream file(std::filesystem::path(TRAMMEL_SHARED_GCODE_DIR) / "octocat.gcode");
  std::string program = "G64 P0.1\n";
  std::string line;
  for (int i = 0; i < 4000 && std::getline(file, line); ++i) program += line + "\n";
  for (const double jerk : {0.0, 30000.0}) {
    gcode::TextLines lines(program, "octocat.gcode");
    machine::Machine machine = fast_machine(jerk);
    machine.motion.junction_deviation = 0.02;
    const Planned planned(lines, machine, 4 * kClock, 15);
    ASSERT_FALSE(planned.error);
    EXPECT_GT(planned.blends, 1000U);
    const MotionVerdict verdict = judge_motion(planned.commands, {machine, 4 * kClock, 0.02});
    expect_within_limits(verdict);
    EXPECT_NEAR(verdict.seconds(4 * kClock), planned.seconds, 0.001 * planned.seconds);
  }
}

TEST(MotionJudge, RealProgramsAreWithinTheirLimits) {
  for (const auto& entry : std::filesystem::directory_iterator(TRAMMEL_SHARED_GCODE_DIR)) {
    if (entry.path().extension() != ".gcode") continue;
    for (const double jerk : {0.0, 30000.0}) {
      SCOPED_TRACE(fmt::format("{}, jerk {}", entry.path().filename().string(), jerk));
      gcode::FileLines lines(entry.path());
      machine::Machine machine = fast_machine(jerk);
      machine.motion.junction_deviation = 0.02;
      const Planned planned(lines, machine, kClock, 15);
      if (planned.error) continue;  // two programs are refused
      const MotionVerdict verdict = judge_motion(planned.commands, {machine, kClock, 0.02});
      expect_within_limits(verdict);
      EXPECT_NEAR(verdict.seconds(kClock), planned.seconds, 0.001 * planned.seconds);
    }
  }
}
#endif

// Points of a curve at equal distances, at a feed of 300 mm/s.
std::string chords(std::size_t count, double chord, double (*x)(double), double (*y)(double)) {
  std::string program = "G21 G90 G94 F18000\n";
  double parameter = 0;
  for (std::size_t i = 0; i < count; ++i) {
    constexpr double kSmall = 1e-6;
    const double speed =
        std::hypot(x(parameter + kSmall) - x(parameter), y(parameter + kSmall) - y(parameter)) / kSmall;
    parameter += chord / speed;
    program += fmt::format("G1 X{:.5f} Y{:.5f}\n", x(parameter), y(parameter));
  }
  return program + "M2\n";
}

std::string line_in_chords() {
  return chords(
      5000, 0.02, [](double t) { return t; }, [](double t) { return t / 2; });
}
std::string spiral_in_chords() {
  return chords(
      10000, 0.02, [](double t) { return (2 + t) * std::cos(t) - 2; }, [](double t) { return (2 + t) * std::sin(t); });
}
std::string sine_in_chords() {
  return chords(
      5000, 0.02, [](double t) { return t; }, [](double t) { return 5 * std::sin(t / 2); });
}

TEST(MotionJudge, CurvesInChordsAreWithinTheirLimits) {
  for (const double jerk : {0.0, 60000.0}) {
    for (const std::string& program_text : {line_in_chords(), spiral_in_chords(), sine_in_chords()}) {
      SCOPED_TRACE(fmt::format("jerk {}, {:.60s}", jerk, program_text));
      Program program(text(program_text), fast_machine(jerk), kFastClock);
      expect_within_limits(program.verdict());
      EXPECT_LE(program.farthest(), 0.8);
    }
  }
}

// From rest to rest on arcs alone: the total acceleration is that of the axes at every speed, never more.
TEST(MotionJudge, ArcsUseTheirAccelerationAtEverySpeed) {
  for (const char* text :
       {"G2 I10\n", "G3 X20 I10\n", "G2 X1 Y1 I1\n", "G17 G2 I10 Z2 P2\n", "G1 X5\nG2 X15 I5\nG3 X18 Y3 J3\n"}) {
    for (const double jerk : {0.0, 20'000.0, 200'000.0}) {
      SCOPED_TRACE(fmt::format("{} jerk {}", text, jerk));
      const std::string program = std::string("G21 G90 G94 F60000\n") + text + "M2\n";
      gcode::TextLines lines(program, "program");
      const machine::Machine machine = machine_of(300, 1000, jerk);
      const Planned planned(lines, machine, 10 * kClock);
      const MotionVerdict verdict = judge_motion(planned.commands, {machine, 10 * kClock, 0.01});
      expect_within_limits(verdict);
      // On the smallest arc, the lower jerk is the limit.
      const bool slow = jerk == 20'000 && text == std::string_view("G2 X1 Y1 I1\n");
      EXPECT_GT(verdict.acceleration.share, slow ? 0.43 : 0.98);
      EXPECT_NEAR(verdict.seconds(10 * kClock), planned.seconds, 0.001 * planned.seconds);
    }
  }
}

// Small arcs among lines, tangent or not: up to the ends of an arc, the speed keeps the jerk that the arc leaves.
TEST(MotionJudge, SmallArcsAmongLinesAreWithinTheirLimits) {
  std::mt19937 random(21);
  const auto logarithmic = [&](double low, double high) {
    return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(random));
  };
  for (int i = 0; i < 12; ++i) {
    std::string program = "G21 G91 G94 F12000\n";
    for (int j = 0; j < 12; ++j) {
      const double radius = logarithmic(0.2, 10);
      const char* way = random() % 2 == 0 ? "G2" : "G3";
      if (random() % 2 == 0) program += fmt::format("G1 X{:.3f}\n", logarithmic(0.1, 10));
      if (random() % 2 == 0) program += fmt::format("G1 Y{:.3f}\n", logarithmic(0.1, 10));
      program += fmt::format("{} X{:.3f} Y{:.3f} J{:.3f}\n", way, way[1] == '3' ? radius : -radius, radius, radius);
    }
    program += "M2\n";
    SCOPED_TRACE(program);
    gcode::TextLines lines(program, "program");
    const machine::Machine machine = machine_of(300, logarithmic(500, 5000), logarithmic(20'000, 200'000));
    const Planned planned(lines, machine, 10 * kClock);
    ASSERT_FALSE(planned.error);
    MotionVerdict verdict = judge_motion(planned.commands, {machine, 10 * kClock, 0.01});
    EXPECT_LE(verdict.acceleration_jump.share, 0.0105);  // measured: 0.0102, in the tick in which a ramp ends
    verdict.acceleration_jump.share = 0;
    expect_within_limits(verdict);
    EXPECT_NEAR(verdict.seconds(10 * kClock), planned.seconds, 0.001 * planned.seconds);
  }
}

}  // namespace
}  // namespace trammel::test
