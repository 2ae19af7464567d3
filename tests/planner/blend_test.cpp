// G64 P: blends of corners, judged by points of the blended and of the programmed path.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "plan.hpp"

namespace trammel::planner {
namespace {

using Place = std::array<double, 3>;

double distance(const Place& a, const Place& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// Distance of point `p` from the segment `a` to `b`.
double from_segment(const Place& p, const Place& a, const Place& b) {
  double along = 0;
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    along += (p[i] - a[i]) * (b[i] - a[i]);
    square += (b[i] - a[i]) * (b[i] - a[i]);
  }
  const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
  return distance(p, {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])});
}

double from_points(const Place& p, const std::vector<Place>& path) {
  double least = INFINITY;
  for (std::size_t i = 1; i < path.size(); ++i) least = std::min(least, from_segment(p, path[i - 1], path[i]));
  return least;
}

// Largest distance between two paths, given as points: of each point of one path from the other path.
double apart(const std::vector<Place>& one, const std::vector<Place>& other) {
  double most = 0;
  for (const Place& p : one) most = std::max(most, from_points(p, other));
  for (const Place& p : other) most = std::max(most, from_points(p, one));
  return most;
}

constexpr double kScale = 1e5;  // pulses per mm; so many that rounding to pulses has little effect

machine::Machine fine_machine() {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) {
    axis.steps_per_mm = kScale;
    axis.max_velocity = 100;
    axis.max_acceleration = 1000;
    axis.min = -1e6;
    axis.max = 1e6;
  }
  return machine;
}

CardLimits fast_card() {
  CardLimits card;
  card.clock_hz = 100'000'000;
  return card;
}

// Adds points of a block's path before rounding; for a line, its ends.
void add_points(const Block& block, double points_a_radian, std::vector<Place>& path) {
  const auto mm = [](std::int64_t pulses) { return static_cast<double>(pulses) / kScale; };
  Place start{}, end{};
  for (std::size_t i = 0; i < 3; ++i) {
    start[i] = mm(block.start[i]);
    end[i] = mm(block.end[i]);
  }
  if (path.empty()) path.push_back(start);
  if (block.geometry != Geometry::kLine) {
    const ExactArc& arc = block.exact;
    const double parts = 10 + std::floor(points_a_radian * arc.sweep);
    for (double part = 1; part < parts; ++part) {
      const double share = part / parts;
      Place at = start;
      if (block.tilted) {
        const SpaceArc& space = block.space;
        for (std::size_t i = 0; i < 3; ++i) {
          at[space.axes[i]] = space.centre[i] + space.radius * (std::cos(space.sweep * share) * space.first[i] +
                                                                std::sin(space.sweep * share) * space.second[i]);
        }
      } else {
        for (std::size_t i = 0; i < 3; ++i) at[i] += share * (end[i] - start[i]);
        const double angle = arc.angle_start + (block.clockwise ? -1 : 1) * arc.sweep * share;
        const double radius = arc.radius_start + share * (arc.radius_end - arc.radius_start);
        at[block.axis_x] = arc.centre_x + radius * std::cos(angle);
        at[block.axis_y] = arc.centre_y + radius * std::sin(angle);
      }
      path.push_back(at);
    }
  }
  path.push_back(end);
}

struct Blended {
  std::vector<Place> path;
  std::vector<Block> blocks;  // blocks that move
  double seconds = 0;
  double distance = 0;
  std::size_t blends = 0;
  std::size_t faster = 0;  // corners that were kept because they are faster
};

Blended blended(const std::string& program, const machine::Machine& machine, double points_a_radian = 1000) {
  const Plan plan = plan_text(program, machine, fast_card());
  Blended result;
  EXPECT_FALSE(plan.error) << plan.error->message;
  for (const Planned& planned : plan.blocks) {
    const Block& block = planned.planned.block;
    result.seconds += planned.planned.seconds;
    if (!moves(block)) continue;
    add_points(block, points_a_radian, result.path);
    result.blocks.push_back(block);
    result.distance = std::max(result.distance, block.distance);
    result.blends += block.corner == Corner::kBlended;
  }
  return result;
}

std::string lines_through(const std::vector<Place>& corners) {
  std::string text;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    text += fmt::format("G1 X{:.6f} Y{:.6f} Z{:.6f}\n", corners[i][0], corners[i][1], corners[i][2]);
  }
  return text + "M2\n";
}

// Rounding of a point to pulses and of the program's digits, and the rest of a line or an arc within a pulse. Such a
// rest has no step and is part of the next motion.
constexpr double kRounding = (0.5 * 1.7320508 + 1) / kScale + 1e-6;

// Tolerance for the directions at the ends of a blend, which must equal those of its neighbours. The rest of an arc may
// turn within a pulse and have no step.
constexpr double kWithinAPulse = 1 / kScale / 0.125;

void expect_tangent(const std::vector<Block>& blocks, double tolerance) {
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const Block& before = blocks[i - 1];
    if (before.corner != Corner::kBlended && blocks[i].corner != Corner::kBlended) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(before.exit[axis], blocks[i].entry[axis], tolerance) << "block " << i << ", axis " << axis;
    }
  }
}

TEST(Blend, ASquareIsQuickerAndStaysWithinTheTolerance) {
  const std::vector<Place> square = {{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}, {0, 0, 0}, {20, 0, 0}};
  ASSERT_LT(blended("F6000 G64 P1\n" + lines_through(square), fine_machine()).seconds,
            blended("F6000 G64\n" + lines_through(square), fine_machine()).seconds - 0.02);
  double before = blended("F6000 G61\n" + lines_through(square), fine_machine()).seconds;
  for (const double tolerance : {0.3, 1.0}) {
    const Blended path = blended(fmt::format("F6000 G64 P{}\n", tolerance) + lines_through(square), fine_machine());
    EXPECT_LT(path.seconds, before - 0.02);
    before = path.seconds;
    EXPECT_EQ(path.blends, 4U);
    EXPECT_NEAR(path.distance, tolerance, 1e-12);
    EXPECT_NEAR(apart(path.path, square), tolerance,
                kRounding + 1e-3 * tolerance);  // the tolerance is reached, but not exceeded
    expect_tangent(path.blocks, 1e-6);
    EXPECT_EQ(path.blocks.back().end[0], 20 * kScale);
    for (const Block& block : path.blocks) EXPECT_TRUE(block.geometry != Geometry::kChords);
  }
}

// Random corners in space or in a main plane, slight and sharp, between long and short lines.
std::vector<Place> random_corners(std::mt19937& random, bool flat) {
  const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  std::vector<Place> corners{{0, 0, 0}};
  const std::size_t plane = random() % 3;
  for (int i = 0; i < 12; ++i) {
    Place next = corners.back();
    const double size = std::exp2(number(-6, 4));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!flat || axis != plane) next[axis] += std::round(number(-size, size) * 1e6) / 1e6;
    }
    if (distance(next, corners.back()) < 2 / kScale) continue;  // without a step a line is part of the next one
    corners.push_back(next);
  }
  return corners;
}

RC_GTEST_PROP(Blend, RandomLinesAreLeftByTheToleranceAtMost, ()) {
  const auto seed = *rc::gen::arbitrary<unsigned>();
  const auto flat = *rc::gen::arbitrary<bool>();
  std::mt19937 random(seed);
  const std::vector<Place> corners = random_corners(random, flat);
  const double tolerance = std::exp2(std::uniform_real_distribution<>(-7, 2)(random));
  const Blended path = blended(fmt::format("F6000 G64 P{:.6f}\n", tolerance) + lines_through(corners), fine_machine());
  RC_ASSERT(path.distance <= tolerance * (1 + 1e-12) + 1e-6);
  RC_ASSERT(apart(path.path, corners) <= path.distance + kRounding);
  expect_tangent(path.blocks, 1e-6);
  RC_ASSERT(!testing::Test::HasFailure());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    RC_ASSERT(path.blocks.back().end[axis] == kinematics::to_pulses(corners.back()[axis], kScale));
  }
  // A blend takes at most half of a line, so the middle of each line stays on the path, except for rounding.
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Place& a = corners[i - 1];
    const Place& b = corners[i];
    RC_ASSERT(from_points({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2}, path.path) <= kRounding + 1e-5);
  }
}

// Lines and arcs in a plane, with corners between them.
struct Curves {
  std::string text;
  std::vector<Place> path;
};

Curves random_curves(std::mt19937& random) {
  constexpr int kParts = 300;
  struct Plane {
    const char* words;
    std::size_t x, y;
    char letters[5];
  };
  constexpr Plane kPlanes[] = {{"G17", 0, 1, "XYIJ"}, {"G18", 2, 0, "ZXKI"}, {"G19", 1, 2, "YZJK"}};
  const auto number = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  const auto rounded = [](double value) { return std::round(value * 1e9) / 1e9; };
  const Plane& plane = kPlanes[random() % 3];
  Curves curves{fmt::format("{}\n", plane.words), {{0, 0, 0}}};
  for (int i = 0; i < 6; ++i) {
    Place next = curves.path.back();
    const Place here = next;
    const double size = std::exp2(number(-3, 2));
    if (random() % 3 == 0) {
      next[plane.x] = rounded(here[plane.x] + number(-size, size));
      next[plane.y] = rounded(here[plane.y] + number(-size, size));
      curves.text +=
          fmt::format("G1 {}{:.9f} {}{:.9f}\n", plane.letters[0], next[plane.x], plane.letters[1], next[plane.y]);
      curves.path.push_back(next);
      continue;
    }
    const double heading = number(0, 6.28);
    const double turn = number(0.05, 6) * (random() % 2 == 0 ? 1 : -1);
    const double i_word = rounded(size * std::cos(heading));
    const double j_word = rounded(size * std::sin(heading));
    for (int part = 1; part <= kParts; ++part) {
      const double angle = turn * part / kParts;
      next[plane.x] = here[plane.x] + i_word - (i_word * std::cos(angle) - j_word * std::sin(angle));
      next[plane.y] = here[plane.y] + j_word - (i_word * std::sin(angle) + j_word * std::cos(angle));
      if (part == kParts) next = {rounded(next[0]), rounded(next[1]), rounded(next[2])};
      curves.path.push_back(next);
    }
    curves.text +=
        fmt::format("{} {}{:.9f} {}{:.9f} {}{:.9f} {}{:.9f}\n", turn < 0 ? "G2" : "G3", plane.letters[0], next[plane.x],
                    plane.letters[1], next[plane.y], plane.letters[2], i_word, plane.letters[3], j_word);
  }
  return curves;
}

constexpr double kChords =
    4 * (6.0 / 300) * (6.0 / 300) / 8;  // largest distance of an arc from the chords between its points

// A corner is kept if this is faster than a blend. Each corner is judged by its two motions alone, so a program may
// take a little longer than with all corners kept.
TEST(Blend, AreMadeWhereTheyAreQuicker) {
  machine::Machine machine = machine::default_machine();
  for (machine::MachineAxis& axis : machine.axes) axis.max_velocity = 100;
  const auto planned = [&](const std::string& program) {
    const Plan plan = plan_text(program, machine, {100'000'000, 4});
    Blended result;
    for (const Planned& one : plan.blocks) {
      result.seconds += one.planned.seconds;
      result.blends += one->corner == Corner::kBlended;
      result.faster += one->corner == Corner::kFaster;
    }
    return result;
  };
  const std::string square = "G1 X20\nY20\nX0\nY0\nX20\nM2\n";
  const Blended kept = planned("F6000 G64\n" + square);
  const Blended little = planned("F6000 G64 P0.1\n" + square);
  EXPECT_EQ(little.faster, 4U);
  EXPECT_EQ(little.seconds, kept.seconds);
  EXPECT_LT(planned("F6000 G64 P1\n" + square).seconds, kept.seconds - 0.05);

  double worst = 0;
  double worst_smooth = 0;
  std::size_t blends = 0;
  std::size_t faster = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    for (machine::MachineAxis& axis : machine.axes) axis.max_jerk = seed % 3 == 0 ? 20000 : 0;
    const std::string program =
        seed % 2 == 0 ? lines_through(random_corners(random, false)) : random_curves(random).text + "M2\n";
    const double tolerance = std::exp2(std::uniform_real_distribution<>(-7, 0)(random));
    const double seconds = planned("F6000 G64\n" + program).seconds;
    const Blended path = planned(fmt::format("F6000 G64 P{:.6f}\n", tolerance) + program);
    blends += path.blends;
    faster += path.faster;
    double& slowest = seed % 3 == 0 ? worst_smooth : worst;
    slowest = std::max(slowest, path.seconds / seconds);
  }
  EXPECT_GT(blends, 200U);
  EXPECT_GT(faster, 300U);
  EXPECT_LE(worst, 1.01);
  EXPECT_LE(worst_smooth, 1.07);
  RecordProperty("worst", fmt::format("{:.4f}", worst));
  RecordProperty("worst_smooth", fmt::format("{:.4f}", worst_smooth));
}

RC_GTEST_PROP(Blend, RandomArcsAndLinesAreLeftByTheToleranceAtMost, ()) {
  const auto seed = *rc::gen::arbitrary<unsigned>();
  std::mt19937 random(seed);
  const Curves curves = random_curves(random);
  const double tolerance = std::exp2(std::uniform_real_distribution<>(-7, 0)(random));
  const Blended path =
      blended(fmt::format("F6000 G64 P{:.6f}\n", tolerance) + curves.text + "M2\n", fine_machine(), 50);
  RC_ASSERT(path.distance <= tolerance + 1e-6);
  RC_ASSERT(apart(path.path, curves.path) <= path.distance + kRounding + 2 * kChords);
  expect_tangent(path.blocks, kWithinAPulse);
  RC_ASSERT(!testing::Test::HasFailure());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    RC_ASSERT(path.blocks.back().end[axis] == kinematics::to_pulses(curves.path.back()[axis], kScale));
  }
  RC_CLASSIFY(path.blends != 0, "some blends");
  RC_CLASSIFY(path.blends > 3, "more than three");
}

// A letter for each block: line, arc, chords; a blend in brackets.
std::string kinds(const std::vector<Block>& blocks) {
  std::string text;
  for (const Block& block : blocks) {
    const char kind = block.geometry == Geometry::kLine ? 'l' : block.geometry == Geometry::kChords ? 'c' : 'a';
    text += block.corner == Corner::kBlended ? fmt::format("({})", kind) : std::string(1, kind);
  }
  return text;
}

std::string kinds(const std::string& program) { return kinds(blended("F600 " + program, fine_machine()).blocks); }

TEST(Blend, TakesTheCardsArcsInMainPlanesAndChordsInOthers) {
  EXPECT_EQ(kinds("G64 P0.1\nG1 X10\nY10\nM2\n"), "l(a)l");
  EXPECT_EQ(kinds("G64 P0.1\nG1 X10\nZ10\nM2\n"), "l(a)l");
  EXPECT_EQ(kinds("G64 P0.1\nG1 Y10\nZ10\nM2\n"), "l(a)l");
  EXPECT_EQ(kinds("G64 P0.1\nG1 X10 Z1\nY10\nM2\n"), "l(c)l");
  EXPECT_EQ(kinds("G64 P0.1\nG1 X10\nG2 X20 I5\nM2\n"), "l(a)a");
  EXPECT_EQ(kinds("G64 P0.1\nG2 X10 I5\nG3 X20 I5\nG1 X30\nM2\n"), "aa(a)l");  // the first corner is tangent
  EXPECT_EQ(kinds("G64 P0.1\nG2 X10 I5\nG2 X20 I5\nM2\n"), "aa");              // a reversal
  EXPECT_EQ(kinds("G64 P0.1\nG18 G1 Z10\nG2 Z20 K5\nM2\n"), "l(a)a");
}

TEST(Blend, KeepsCornersThatItCannotOrNeedNotRound) {
  const auto corners = [](const std::string& program) {
    std::vector<Corner> found;
    for (const Block& block : blended("F600 " + program, fine_machine()).blocks) found.push_back(block.corner);
    return found;
  };
  using List = std::vector<Corner>;
  EXPECT_EQ(corners("G64 P0.1\nG1 X10\nX0\nM2\n"), (List{Corner::kReversal, Corner::kNone}));
  EXPECT_EQ(corners("G64 P0.1\nG1 X10\nG2 X20 Z5 I5\nG1 X30\nM2\n"),
            (List{Corner::kNoCurve, Corner::kNoCurve, Corner::kNone}));
  EXPECT_EQ(corners("G64 P0.1\nG1 X0.000006\nY0.000006\nX10\nM2\n").front(), Corner::kInvisible);
  EXPECT_EQ(corners("G64 P0.1\nG1 X10\nX20\nM2\n"), (List{Corner::kNone, Corner::kNone}));
  // Both motions must be under G64 P.
  for (const char* mode : {"G64", "G61", "G61.1"}) {
    EXPECT_EQ(corners(fmt::format("G64 P0.1\nG1 X10\n{}\nY10\nX0\nM2\n", mode)),
              (List{Corner::kNone, Corner::kNone, Corner::kNone}))
        << mode;
    EXPECT_EQ(corners(fmt::format("{}\nG1 X10\nG64 P0.1\nY10\nM2\n", mode)), (List{Corner::kNone, Corner::kNone}))
        << mode;
  }
  // There is no blend across a dwell, or beside a motion without X, Y and Z.
  EXPECT_EQ(corners("G64 P0.1\nG1 X10\nG4 P0\nY10\nE5\nX0\nM2\n"), (List(4, Corner::kNone)));
}

// Outputs do not change the motion.
TEST(Blend, OutputsAreSwitchedWhereItsBlendBegins) {
  machine::Machine machine = fine_machine();
  machine.outputs.m3 = 1;
  machine.outputs.m8 = 2;
  CardLimits card = fast_card();
  card.outputs = 2;
  const auto planned = [&](const std::string& words) {
    return plan_text("F600 G64 P0.1\nG1 X10\n" + words + "Y10\nM2\n", machine, card);
  };
  const Plan without = planned("");
  const Plan with = planned("M3\nM8\nM5\n");
  ASSERT_EQ(with.blocks.size(), without.blocks.size());
  for (std::size_t i = 0; i < with.blocks.size(); ++i) EXPECT_EQ(with.blocks[i]->end, without.blocks[i]->end);
  ASSERT_EQ(with.blocks[1]->corner, Corner::kBlended);
  EXPECT_EQ(with.blocks[1]->outputs.set, 2U);
  EXPECT_EQ(with.blocks[1]->outputs.clear, 1U);
  EXPECT_FALSE(switches(with.blocks[2].planned.block));
}

}  // namespace
}  // namespace trammel::planner
