// The plan over many blocks: times against single moves and against a second computation over the whole program, speeds
// in curves, stops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "plan.hpp"
#include "trammel/driver/trigonometry.hpp"

namespace trammel::planner {
namespace {

// A machine with 300 mm/s and 3,000 mm/s^2.
machine::Machine fast_machine(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"motion.junction_deviation=0.02"};
  for (const char* axis : {"x", "y", "z", "e"}) {
    const std::string name = std::string("axis.") + axis;
    overrides.push_back(name + ".max_velocity=300");
    overrides.push_back(name + ".max_acceleration=3000");
    overrides.push_back(name + ".step_length_ns=1000");
    overrides.push_back(name + ".step_space_ns=1000");
  }
  overrides.insert(overrides.end(), more.begin(), more.end());
  return machine_with(overrides);
}

std::vector<Planned> blocks_of(const std::string& text, const machine::Machine& machine) {
  const Plan plan = plan_text(text, machine, kCard);
  if (plan.error) throw std::runtime_error(gcode::describe(*plan.error));
  return plan.blocks;
}

double seconds_of(const std::vector<Planned>& blocks) {
  double sum = 0;
  for (const Planned& block : blocks) sum += block.planned.seconds;
  return sum;
}

// Clocks of the pieces in the feed generator, which holds each rate for 32 clocks. The first rate of a piece takes
// effect 6 clocks after the last tick of the previous piece; this constant delay is left out.
double feed_clocks(const std::vector<Planned>& blocks) {
  double clocks = 0;
  for (const Planned& block : blocks) {
    for (const driver::FeedCommand& piece : commands<driver::FeedCommand>(block)) {
      double rate = static_cast<double>(piece.rate) * 0x1p-64;
      double change = static_cast<double>(piece.acceleration) * 0x1p-64;
      const double floor = piece.floor * 0x1p-32;
      double left = static_cast<double>(piece.ticks);
      for (; left > 32 * std::max(rate, floor); clocks += 32) {
        left -= 32 * std::max(rate, floor);
        rate += change;
        change += static_cast<double>(piece.jerk) * 0x1p-64;
      }
      clocks += left / std::max(rate, floor);
    }
  }
  return clocks;
}

std::string format(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.5f", value);
  return text.data();
}

std::string line_of_chords(double length, double chord, double feed) {
  std::string text = "G1 F" + format(feed) + "\n";
  const auto count = static_cast<int>(std::lround(length / chord));
  for (int i = 1; i <= count; ++i) text += "X" + format(length * i / count) + "\n";
  return text;
}

std::string circle_of_chords(double radius, double chord, double feed) {
  std::string text = "G0 X" + format(radius) + "\nG1 F" + format(feed) + "\n";
  const auto count = static_cast<int>(std::lround(2 * driver::kPi * radius / chord));
  for (int i = 1; i <= count; ++i) {
    text += "X" + format(radius * std::cos(2 * driver::kPi * i / count)) + "Y" +
            format(radius * std::sin(2 * driver::kPi * i / count)) + "\n";
  }
  return text;
}

std::string square_of_chords(double side, int chords) {
  std::string text = "G1 F3000\n";
  const double corners[5][2] = {{0, 0}, {side, 0}, {side, side}, {0, side}, {0, 0}};
  for (int c = 0; c < 4; ++c) {
    for (int i = 1; i <= chords; ++i) {
      const double share = static_cast<double>(i) / chords;
      text += "X" + format(corners[c][0] + (corners[c + 1][0] - corners[c][0]) * share) + "Y" +
              format(corners[c][1] + (corners[c + 1][1] - corners[c][1]) * share) + "\n";
    }
  }
  return text;
}

TEST(LookAhead, CollinearBlocksTakeTheTimeOfOne) {
  const machine::Machine machine = machine::default_machine();
  const std::vector<Planned> one = blocks_of("G1 X10 F3000\n", machine);
  const std::vector<Planned> many = blocks_of(line_of_chords(10, 0.1, 3000), machine);
  ASSERT_EQ(many.size(), 101U);
  EXPECT_NEAR(seconds_of(many) / seconds_of(one), 1, 0.001);
  EXPECT_NEAR(feed_clocks(many) / feed_clocks(one), 1, 0.001);
  // 0.2 s at 50 mm/s and a ramp of 0.05 s. A start and a stop at the rate of one tick from rest each save 0.3 ms.
  EXPECT_NEAR(seconds_of(one), 0.25 - 0.0006, 0.0001);
  const std::vector<Planned> stops = blocks_of("G61.1\n" + line_of_chords(10, 0.1, 3000), machine);
  EXPECT_GT(seconds_of(stops), 1.9) << "exact stops";
}

TEST(LookAhead, ASquareOfChordsTakesTheTimeOfItsSides) {
  const machine::Machine machine = machine::default_machine();
  const double sides = seconds_of(blocks_of(square_of_chords(200, 1), machine));
  const double chords = seconds_of(blocks_of(square_of_chords(200, 400), machine));
  EXPECT_NEAR(chords / sides, 1, 0.01);
  EXPECT_NEAR(sides, 16.2, 0.1);
}

// Largest share of an axis in the change from one direction to the other.
double axis_share(const Planned& from, const Planned& to) {
  const double x = to->entry[0] - from->exit[0];
  const double y = to->entry[1] - from->exit[1];
  return std::max(std::abs(x), std::abs(y)) / std::sqrt(x * x + y * y);
}

TEST(LookAhead, CirclesOfChordsKeepTheirAcceleration) {
  const machine::Machine machine = machine::default_machine();
  for (const double radius : {2.0, 10.0, 50.0}) {
    for (const double chord : {0.02, 0.1, 0.5, 1.0}) {
      SCOPED_TRACE("R " + format(radius) + ", chords of " + format(chord));
      const std::vector<Planned> blocks = blocks_of(circle_of_chords(radius, chord, 60000), machine);
      double most = 0;
      for (std::size_t i = 2; i + 2 < blocks.size(); ++i) {
        // Of the two corners of the block, the one at which the axes allow more.
        const double share = std::min(axis_share(blocks[i - 1], blocks[i]), axis_share(blocks[i], blocks[i + 1]));
        most = std::max(most, blocks[i].planned.speed * blocks[i].planned.speed / radius * share / 1000);
      }
      EXPECT_LE(most, 1.05);
      // With longer chords the deviation formula allows less; 150 mm/s are not reached on R 50.
      if (radius < 20 && chord <= radius / 20) {
        EXPECT_GE(most, 0.9);
      }
    }
  }
}

TEST(LookAhead, PlannedSecondsAreThoseOfThePieces) {
  const machine::Machine machine = machine::default_machine();
  for (const std::string& text :
       {line_of_chords(10, 0.1, 3000), circle_of_chords(10, 0.1, 6000), square_of_chords(5, 10),
        std::string("G1 X0.1 F3000\nX0\nX0.1\nX0\n"), std::string("G0 X10 Y5\nG1 X20 F300\nG0 X0\nG1 X1 Y1 F60\n")}) {
    const std::vector<Planned> blocks = blocks_of(text, machine);
    EXPECT_NEAR(feed_clocks(blocks) / 1e8 / seconds_of(blocks), 1, 0.001) << text.substr(0, 40);
  }
}

// Time of the whole program at once: corners by angles and trigonometry, v^2 by a backward and a forward pass, the time
// of each block from its two speeds. On an arc of radius r with a total acceleration of a, v^2 = a r sin(2 s / r) from
// rest.
class WholeProgram {
 public:
  explicit WholeProgram(const machine::Machine& machine) : machine_(machine) {}

  double seconds(const std::vector<Planned>& blocks) {
    double sum = 0;
    std::vector<const Block*> run;
    const auto end_run = [&] {
      sum += seconds_of_run(run);
      run.clear();
    };
    for (const Planned& block : blocks) {
      if (!moves(block.planned.block)) {
        end_run();
        continue;
      }
      if (!run.empty() && run.back()->linear != block->linear) end_run();
      run.push_back(&block.planned.block);
    }
    end_run();
    return sum;
  }

 private:
  double corner(const Block& from, const Block& to) const {
    double dot = 0, size_from = 0, size_to = 0;
    const std::size_t axes = from.linear ? 3 : 4;
    for (std::size_t i = 0; i < axes; ++i) {
      dot += from.exit[i] * to.entry[i];
      size_from += from.exit[i] * from.exit[i];
      size_to += to.entry[i] * to.entry[i];
    }
    double speed = std::min(from.speed, to.speed);
    if (axes == 3) {
      const double jump = std::abs(to.entry[3] - from.exit[3]);
      const double most = std::sqrt(machine_.axes[3].max_acceleration * machine_.motion.junction_deviation);
      if (jump > 1e-12) speed = std::min(speed, most / jump);
    }
    const double cosine = std::clamp(dot / std::sqrt(size_from * size_to), -1.0, 1.0);
    if (cosine < -0.9999) return 0;
    const double angle = std::acos(cosine);
    if (angle < 1e-6) return speed;
    double acceleration = 1e300;
    const double size = 2 * std::sin(angle / 2);
    for (std::size_t i = 0; i < axes; ++i) {
      const double part = std::abs(to.entry[i] - from.exit[i]) / size;
      if (part > 1e-12) acceleration = std::min(acceleration, machine_.axes[i].max_acceleration / part);
    }
    const double s = std::cos(angle / 2);
    const double formula = acceleration * machine_.motion.junction_deviation * s / (1 - s);
    const double curve = acceleration * std::min(from.length, to.length) / angle;
    return std::min(speed, std::sqrt(std::min(formula, curve)));
  }

  double seconds_of_run(const std::vector<const Block*>& run) const {
    const std::size_t n = run.size();
    if (n == 0) return 0;
    std::vector<double> speed(n + 1, 0.0);
    for (std::size_t i = 1; i < n; ++i) speed[i] = corner(*run[i - 1], *run[i]);
    for (std::size_t i = n; i-- != 0;) speed[i] = std::min(speed[i], reach(speed[i + 1], *run[i]));
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      speed[i + 1] = std::min(speed[i + 1], reach(speed[i], *run[i]));
      sum += seconds_of_block(*run[i], speed[i], speed[i + 1]);
    }
    return sum;
  }

  static bool is_arc(const Block& block) { return block.geometry == Geometry::kArcChord; }
  // For an arc in X and Y.
  double radius_times_acceleration(const Block& arc) const {
    return arc.exact.radius_start * machine_.axes[0].max_acceleration;
  }
  double angle(const Block& arc, double speed) const {
    return std::asin(std::min(1.0, speed * speed / radius_times_acceleration(arc)));
  }

  double reach(double from, const Block& over) const {
    if (!is_arc(over)) return std::sqrt(from * from + 2 * over.acceleration * over.length);
    const double end = std::min(driver::kPi / 2, angle(over, from) + 2 * over.length / over.exact.radius_start);
    return std::sqrt(radius_times_acceleration(over) * std::sin(end));
  }
  double length_between(const Block& block, double low, double high) const {
    if (!is_arc(block)) return (high * high - low * low) / (2 * block.acceleration);
    return (angle(block, high) - angle(block, low)) * block.exact.radius_start / 2;
  }
  double seconds_between(const Block& block, double low, double high) const {
    if (!is_arc(block)) return (high - low) / block.acceleration;
    constexpr int kParts = 1000;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {
      const double speed = low + (high - low) * (i + 0.5) / kParts;
      const double across = speed * speed / block.exact.radius_start;
      const double whole = machine_.axes[0].max_acceleration;
      sum += (high - low) / kParts / std::sqrt(whole * whole - across * across);
    }
    return sum;
  }
  double seconds_of_block(const Block& block, double v0, double v1) const {
    const auto ramps = [&](double top) { return length_between(block, v0, top) + length_between(block, v1, top); };
    double top = block.speed;
    double low = std::min(top, std::max(v0, v1));
    if (ramps(top) > block.length) {
      for (int i = 0; i < 60; ++i) {
        const double middle = (low + top) / 2;
        (ramps(middle) > block.length ? top : low) = middle;
      }
    }
    return seconds_between(block, v0, top) + seconds_between(block, v1, top) + (block.length - ramps(top)) / top;
  }

  const machine::Machine& machine_;
};

TEST(LookAhead, ChordsTakeTheTimeOfTheWholeProgram) {
  for (const std::string& text : {line_of_chords(100, 0.02, 18000), circle_of_chords(10, 0.05, 18000),
                                  circle_of_chords(50, 1, 18000), square_of_chords(20, 40)}) {
    const machine::Machine machine = fast_machine();
    const std::vector<Planned> blocks = blocks_of(text, machine);
    EXPECT_NEAR(seconds_of(blocks) / WholeProgram(machine).seconds(blocks), 1, 0.005) << text.substr(0, 30);
  }
}

// A program with arcs of up to 10 mm that are tangent to lines and to each other, full circles, and changing feeds.
std::string arcs_and_lines(unsigned seed) {
  std::mt19937 random(seed);
  std::string text = "G1 F18000 X1\nG91\n";
  double heading = 0;
  for (int i = 0; i < 60; ++i) {
    if (i % 7 == 0) text += "F" + format(std::uniform_real_distribution<>(600, 18000)(random)) + "\n";
    const double radius = std::exp2(std::uniform_real_distribution<>(-2, 3.3)(random));
    const double sweep = std::uniform_real_distribution<>(0.2, 4)(random);
    const double side = random() % 2 == 0 ? 1 : -1;
    const double length = std::exp2(std::uniform_real_distribution<>(-3, 3)(random));
    if (random() % 3 == 0) {
      text += "G1 X" + format(length * std::cos(heading)) + "Y" + format(length * std::sin(heading)) + "\n";
    }
    const double centre_x = -side * radius * std::sin(heading);
    const double centre_y = side * radius * std::cos(heading);
    heading += side * sweep;
    text += std::string(side > 0 ? "G3" : "G2") + " X" + format(centre_x + side * radius * std::sin(heading)) + "Y" +
            format(centre_y - side * radius * std::cos(heading)) + "I" + format(centre_x) + "J" + format(centre_y) +
            "\n";
  }
  return text;
}

// The acceleration along an arc is the part that the centripetal acceleration leaves at each moment.
TEST(LookAhead, ArcsTakeTheTimeOfTheWholeProgram) {
  double worst = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const machine::Machine machine = fast_machine();
    const std::vector<Planned> blocks = blocks_of(arcs_and_lines(seed), machine);
    ASSERT_GT(blocks.size(), 60U);
    const double share = seconds_of(blocks) / WholeProgram(machine).seconds(blocks);
    EXPECT_NEAR(share, 1, 0.005) << seed;
    worst = std::max(worst, std::abs(share - 1));
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(LookAhead, ALoneCircleTakesTheTimeOfItsSpeeds) {
  const machine::Machine machine = machine::default_machine();
  const std::vector<Planned> blocks = blocks_of("G2 I10 F60000\n", machine);
  // v^2 / r is at most a. From rest v^2 = a r sin(2 s / r), up to s = pi r / 4. This takes sqrt(r / a) times the
  // integral of 1 / sqrt(sin 2x).
  constexpr double kRadius = 10;
  constexpr double kIntegral = 1.3110287771460599;  // from 0 to pi / 4
  const double acceleration = machine.axes[0].max_acceleration;
  const double even = 1.5 * driver::kPi * kRadius / std::sqrt(acceleration * kRadius);
  const double least = 2 * kIntegral * std::sqrt(kRadius / acceleration) + even;
  EXPECT_GE(seconds_of(blocks), least);
  EXPECT_LE(seconds_of(blocks), least * 1.005);  // measured: 1.0031
  EXPECT_NEAR(seconds_of(blocks) / WholeProgram(machine).seconds(blocks), 1, 0.005);
}

// Time that a short window costs on 100 mm in chords of 0.02 mm.
TEST(LookAhead, AShortWindowIsSlowerAndSaysSo) {
  const std::string text = line_of_chords(100, 0.02, 18000);
  const auto share = [&](int window) {
    const machine::Machine machine = fast_machine({"motion.window=" + std::to_string(window)});
    const std::vector<Planned> blocks = blocks_of(text, machine);
    const bool told = std::any_of(blocks.begin(), blocks.end(),
                                  [](const Planned& block) { return block.planned.limit == SpeedLimit::kWindow; });
    EXPECT_EQ(told, window < 1024) << window;
    return seconds_of(blocks) / WholeProgram(machine).seconds(blocks);
  };
  const double with_16 = share(16);
  const double with_256 = share(256);
  RecordProperty("window_16", format(with_16));
  RecordProperty("window_256", format(with_256));
  EXPECT_GT(with_16, 4);
  EXPECT_LT(with_16, 6);
  EXPECT_GT(with_256, 1.3);
  EXPECT_LT(with_256, 1.6);
  EXPECT_NEAR(share(1024), 1, 0.01);
  EXPECT_NEAR(share(16384), 1, 0.005);
}

std::vector<std::size_t> stops_of(const std::string& text, const machine::Machine& machine) {
  std::vector<std::size_t> lines;
  for (const Planned& block : blocks_of(text, machine)) {
    if (block.planned.stop) lines.push_back(block->line);
  }
  return lines;
}

using Lines = std::vector<std::size_t>;

TEST(Stops, AreWhereTheyMustBe) {
  const machine::Machine machine = machine::default_machine();
  EXPECT_EQ(stops_of("G1 F600 X10\nX0\nX10\nX20\n", machine), (Lines{1, 2, 4})) << "reversals, the end";
  EXPECT_EQ(stops_of("G1 F600 X10\nX0 Y0.05\n", machine), (Lines{1, 2})) << "a reversal but for a third of a degree";
  EXPECT_EQ(stops_of("G1 F600 X10\nE1\nE2\nX20\nX30 E5\n", machine), (Lines{1, 3, 5})) << "moves without X Y Z";
  EXPECT_EQ(stops_of("G1 F600 X10\nG4 P1\nX20\nM0\nX30\nM1\nX40\nM2\n", machine), (Lines{1, 3, 5, 7}));
  EXPECT_EQ(stops_of("G1 F600 X10\nF1200 X20\nS100\nM3\nM8\nX30\n(c)\nG92 X0\nX10\nG0 X20\n", machine), (Lines{10}))
      << "not at feeds, spindle, coolant, comments, G92, rapids";
  EXPECT_EQ(stops_of("G61.1\nG1 F600 X10\nX20\nG64\nX30\nX40\n", machine), (Lines{2, 3, 6}));
  EXPECT_EQ(stops_of("G61\nG1 F600 X10\nX20\nX30 Y1\nX40 Y2\n", machine), (Lines{3, 5})) << "corners alone";
  EXPECT_EQ(stops_of("G1 F600 X10\nX20 Y1\nX30 Y2\n", machine_with({"motion.junction_deviation=0"})), (Lines{1, 3}));
}

TEST(Junctions, FollowTheDeviationFormula) {
  const machine::Machine machine = machine_with({"motion.junction_deviation=0.05"});
  const std::vector<Planned> blocks = blocks_of("G1 F6000 X50\nY50\nX100\n", machine);
  // A quarter turn: along the difference of the directions the axes allow sqrt(2) times their own acceleration.
  const double half = std::cos(driver::kPi / 4);
  const double expected = std::sqrt(1000 * std::sqrt(2) * 0.05 * half / (1 - half));
  EXPECT_NEAR(blocks[0].planned.velocity_jump, expected, expected * 0.002);
  EXPECT_EQ(blocks[0].planned.acceleration_step, 0);
}

TEST(Junctions, OtherAxesJumpByLittle) {
  const machine::Machine machine = machine::default_machine();
  const std::vector<Planned> blocks = blocks_of("G1 F6000 X50 E1\nX100 E50\nX150 E51\n", machine);
  const double most = std::sqrt(machine.axes[3].max_acceleration * 0.01);
  EXPECT_NEAR(blocks[0].planned.velocity_jump, most, most * 0.01);
}

#ifdef TRAMMEL_SHARED_GCODE_DIR
// Feeds of the program times 15.
TEST(LookAhead, OctocatTakesTheTimeOfTheWholeProgram) {
  const machine::Machine machine = fast_machine();
  gcode::FileLines lines(TRAMMEL_SHARED_GCODE_DIR "/octocat.gcode");
  gcode::ReaderOptions options;
  options.feed_scale = 15;
  gcode::Reader reader(lines, machine, {}, options);
  BlockBuilder builder(reader, machine, kCard);
  Planner planner(builder, machine, kCard);
  std::vector<Planned> blocks;
  PlannedBlock planned;
  for (Collector sink; planner.next(sink, planned); sink.commands.clear()) blocks.push_back({planned, sink.commands});
  ASSERT_FALSE(builder.error());
  const double whole = WholeProgram(machine).seconds(blocks);
  RecordProperty("seconds", format(seconds_of(blocks)));
  RecordProperty("whole_program", format(whole));
  EXPECT_NEAR(seconds_of(blocks) / whole, 1, 0.005);
  EXPECT_NEAR(feed_clocks(blocks) / 1e8 / seconds_of(blocks), 1, 0.001);
}
#endif

}  // namespace
}  // namespace trammel::planner
