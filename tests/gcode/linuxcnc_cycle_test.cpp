// Drilling cycles against LinuxCNC's interpreter: all combinations of their modes, and random series.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "linuxcnc.hpp"

namespace trammel::gcode::linuxcnc {
namespace {

struct CyclePlane {
  const char* word;
  char first, second, normal;
};
constexpr CyclePlane kCyclePlanes[] = {{"G17", 'X', 'Y', 'Z'}, {"G18", 'Z', 'X', 'Y'}, {"G19", 'Y', 'Z', 'X'}};
// Cycles with the words that they need besides R and the bottom. Q never divides the depth of a hole: LinuxCNC adds up
// its pecks, so by rounding it may make one more peck at the bottom.
constexpr const char* kCycles[] = {"G73 Q1.373", "G81", "G82 P0.5", "G83 Q1.717", "G85", "G89 P0.2"};

class LinuxcncCycle : public LinuxcncTest {};

TEST_F(LinuxcncCycle, HasTheSameMotionsInAllModes) {
  std::string text = "G21 F60\n";
  for (const CyclePlane& plane : kCyclePlanes) {
    for (const char* cycle : kCycles) {
      for (const char* distance : {"G90", "G91"}) {
        for (const char* retract : {"G98", "G99"}) {
          for (const int repeats : {1, 3}) {
            for (const int r : {-4, 2, 7}) {  // the holes begin at level 5
              text += fmt::format("G80 G90 {}\nG0 X5 Y5 Z5\n", plane.word);
              text += fmt::format("{} {} {} {}1 {}-6 R{} L{}\n", distance, retract, cycle, plane.first, plane.normal, r,
                                  repeats);
              text += fmt::format("{}2\n{}1 {}-1 L2\n{}-5\n", plane.second, plane.first, plane.second, plane.normal);
            }
          }
        }
      }
    }
  }
  expect_same(text + "M2\n");
}

// Length of the dwells between the lines of random series, s. At a dwell both interpreters are at the same place.
constexpr double kBetweenLines = 0.123;

// A series begins at a random place; each further line may change modes, levels, cycle and offsets.
class RandomCycles {
 public:
  explicit RandomCycles(unsigned seed) : random_(seed) {}

  std::string program() {
    std::string text;
    for (int i = 0; i < 30; ++i) text += series();
    return text + "M2\n";
  }

 private:
  int number(int least, int most) { return std::uniform_int_distribution<>(least, most)(random_); }
  bool one_in(int n) { return number(1, n) == 1; }
  double coordinate(int least, int most) { return number(10 * least, 10 * most) / 10.0; }

  std::string series() {
    plane_ = kCyclePlanes[number(0, 2)];
    std::string text = fmt::format("G80 G90 {} {}\nF{}\n", plane_.word, one_in(4) ? "G20" : "G21", number(30, 90));
    text += fmt::format("G0 X{} Y{} Z{}\n", coordinate(-9, 9), coordinate(-9, 9), coordinate(-9, 9)) + pause();
    text += fmt::format("{} {} {}\n", distance(), retract(), line(true)) + pause();
    for (int i = number(1, 5); i > 0; --i) {
      if (one_in(3)) text += offset() + "\n";
      if (one_in(3)) text += std::string(distance()) + " ";
      if (one_in(3)) text += std::string(retract()) + " ";
      text += line(one_in(4)) + "\n" + pause();
    }
    return text + "G92.1 G49 G54\n";
  }
  static std::string pause() { return fmt::format("G4 P{}\n", kBetweenLines); }
  const char* distance() { return one_in(2) ? "G90" : "G91"; }
  const char* retract() { return one_in(2) ? "G98" : "G99"; }
  std::string offset() {
    const char* const words[] = {"G43.1", "G92", "G10 L2 P1", "G10 L20 P0"};
    if (one_in(4)) return one_in(2) ? "G55" : "G54";
    return fmt::format("{} X{} Y{} Z{}", words[number(0, 3)], coordinate(-3, 3), coordinate(-3, 3), coordinate(-3, 3));
  }
  // `whole`: the line has a cycle and all words that it needs. The bottom is at most -5 and R at least -4, so the
  // bottom is below R both as a coordinate and as an increment.
  std::string line(bool whole) {
    std::string text = whole ? kCycles[number(0, 5)] : "";
    text += fmt::format(" {}{}", plane_.first, coordinate(-9, 9));
    if (one_in(2)) text += fmt::format(" {}{}", plane_.second, coordinate(-9, 9));
    if (whole || one_in(3)) text += fmt::format(" R{}", coordinate(-4, 7));
    if (whole || one_in(3)) text += fmt::format(" {}{}", plane_.normal, coordinate(-9, -5));
    if (one_in(3)) text += fmt::format(" L{}", number(1, 3));
    return text;
  }

  std::mt19937 random_;
  CyclePlane plane_{};
};

// If a line's R is not the level at which the line before ended, the two interpreters approach the first hole
// differently (docs/user/g-code.md). Therefore only the last one of the rapids after each pause stays.
std::vector<Canonical> without_approaches(const std::vector<Canonical>& steps) {
  const auto rapid = [&](std::size_t i) { return i < steps.size() && steps[i].kind == MotionKind::kTraverse; };
  std::vector<Canonical> rest;
  bool approaches = false;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    approaches = steps[i].seconds == kBetweenLines || (approaches && rapid(i));
    if (!(approaches && rapid(i) && rapid(i + 1))) rest.push_back(steps[i]);
  }
  return without_stills(rest);
}

TEST_F(LinuxcncCycle, HasTheSameHolesInRandomSeries) {
  constexpr unsigned kPrograms = sizeof(void*) < 8 ? 2 : 15;  // fewer on an emulated host
  const unsigned programs = std::getenv("TRAMMEL_LONG") == nullptr ? kPrograms : 300;
  for (unsigned seed = 1; seed <= programs; ++seed) {
    const std::string text = RandomCycles(seed).program();
    SCOPED_TRACE(fmt::format("seed {}\n{}", seed, text));
    expect_same(text, without_approaches);
    if (HasFailure()) return;
  }
}

// End points of LinuxCNC's motions after X0 Y0 Z5.
std::vector<std::string> linuxcnc_ends(const std::string& text) {
  bool ended = false;
  std::vector<std::string> ends;
  for (const Canonical& step : read_by_linuxcnc("G21 G90 F60\nG0 X0 Y0 Z5\n" + text + "\nM2\n", ended)) {
    ends.push_back(fmt::format("{:.4g} {:.4g} {:.4g}", step.end[0], step.end[1], step.end[2]));
  }
  EXPECT_TRUE(ended) << text;
  ends.erase(ends.begin());
  return ends;
}

// Differences of LinuxCNC's cycles, as docs/user/g-code.md describes them.
TEST_F(LinuxcncCycle, DiffersWhereThePageSaysSo) {
  using Ends = std::vector<std::string>;
  EXPECT_EQ(linuxcnc_ends("G81 X1 Z-1 R2\nG98 X3"),
            (Ends{"1 0 5", "1 0 2", "1 0 -1", "1 0 2", "3 0 5", "3 0 2", "3 0 -1", "3 0 5"}));
  EXPECT_EQ(linuxcnc_ends("G81 X1 Z-1 R7\nX2 R6"),
            (Ends{"0 0 7", "1 0 7", "1 0 -1", "1 0 7", "1 0 6", "2 0 6", "2 0 -1", "2 0 6"}));
  EXPECT_EQ(linuxcnc_ends("G91 G81 X1 Z-1 R-4\nG18 X1"),
            (Ends{"1 0 5", "1 0 1", "1 0 0", "1 0 1", "2 1 1", "2 0 1", "2 1 1"}));
  EXPECT_EQ(linuxcnc_ends("G91 G81 X1 Z-1 R-4\nG20 X1"),
            (Ends{"1 0 5", "1 0 1", "1 0 0", "1 0 1", "26.4 0 25.4", "26.4 0 0", "26.4 0 25.4"}));
  EXPECT_EQ(linuxcnc_ends("G0 Z7\nG73 X1 Z-6 R7 Q1.3").size(), 2 + 2 * 10 + 2U) << "a peck more than Q makes";
}

}  // namespace
}  // namespace trammel::gcode::linuxcnc
