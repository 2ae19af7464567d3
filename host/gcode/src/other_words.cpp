#include "other_words.hpp"

#include <algorithm>
#include <iterator>

#include "characters.hpp"

namespace trammel::gcode {
namespace {

using T = Treatment;

constexpr std::string_view kThread = "there is no spindle encoder to follow: let the CAM program mill the thread";
constexpr std::string_view kCutter = "cutter compensation: let the CAM program offset the path";
constexpr std::string_view kBSpline = "B-splines are not there; G5 and G5.1 are";
constexpr std::string_view kSpindleCycle = "a boring cycle that stops and turns the spindle: G85 and G89 bore without";
constexpr std::string_view kRotation = "coordinate systems cannot be turned: let the CAM program turn the path";
constexpr std::string_view kScaling = "no scaling: let the CAM program write the size";
constexpr std::string_view kPolar = "no polar coordinates: let the CAM program write X and Y";
constexpr std::string_view kMoves = "a motion that the controller makes by itself: let the CAM program write it";
constexpr std::string_view kMapped = "no path follows a turned or tilted part: let the CAM program write all axes";
constexpr std::string_view kHoming = "there is no homing: bring the axes to their place, then `trammel zero --homed`";
constexpr std::string_view kUnits = "units are G20 and G21; a lathe's cycles are not there";
constexpr std::string_view kOffsets = "an offset of a firmware: write G10 L2 or G92";
constexpr std::string_view kOverrides = "the operator has the overrides";
constexpr std::string_view kModes = "modes are not stored: write the words that set them";
constexpr std::string_view kSubroutines = "subroutines are not supported: let the CAM program write their lines out";

constexpr OtherWord kWords[] = {
    {'G', 40, T::kPrintersWait, ""},
    {'G', 52, T::kNeverLeftOut, kBSpline},
    {'G', 53, T::kNeverLeftOut, kBSpline},
    {'G', 60, T::kNeverLeftOut, kMoves},
    {'G', 70, T::kNeverLeftOut, "diameters of a lathe: write radii"},
    {'G', 100, T::kRetraction, ""},
    {'G', 110, T::kRetraction, "alone on its line it takes back a retraction (G10)"},
    {'G', 120, T::kNeverLeftOut, kMoves},
    {'G', 130, T::kNeverLeftOut, kMoves},
    {'G', 160, T::kNeverLeftOut, kPolar},
    {'G', 260, T::kNeverLeftOut, kMoves},
    {'G', 270, T::kNeverLeftOut, kMoves},
    {'G', 282, T::kNeverLeftOut, kHoming},
    {'G', 290, T::kLeftOut, ""},
    {'G', 320, T::kNeverLeftOut, kMoves},
    {'G', 330, T::kNeverLeftOut, kThread},
    {'G', 331, T::kNeverLeftOut, kThread},
    {'G', 340, T::kNeverLeftOut, kMoves},
    {'G', 350, T::kNeverLeftOut, kMoves},
    {'G', 360, T::kNeverLeftOut, kMoves},
    {'G', 370, T::kNeverLeftOut, kMoves},
    {'G', 410, T::kNeverLeftOut, kCutter},
    {'G', 411, T::kNeverLeftOut, kCutter},
    {'G', 420, T::kNeverLeftOut, kCutter},
    {'G', 421, T::kNeverLeftOut, kCutter},
    {'G', 432, T::kNeverLeftOut, "one tool offset at a time: G43 or G43.1"},
    {'G', 470, T::kNeverLeftOut, kMoves},
    {'G', 500, T::kNeverLeftOut, kScaling},
    {'G', 510, T::kNeverLeftOut, kScaling},
    {'G', 600, T::kNeverLeftOut, kMoves},
    {'G', 630, T::kNeverLeftOut, kThread},
    {'G', 650, T::kNeverLeftOut, kSubroutines},
    {'G', 660, T::kNeverLeftOut, kSubroutines},
    {'G', 680, T::kNeverLeftOut, kRotation},
    {'G', 700, T::kNeverLeftOut, kUnits},
    {'G', 710, T::kNeverLeftOut, kUnits},
    {'G', 720, T::kNeverLeftOut, kUnits},
    {'G', 740, T::kNeverLeftOut, kThread},
    {'G', 750, T::kNeverLeftOut, kMoves},
    {'G', 760, T::kNeverLeftOut, kThread},
    {'G', 840, T::kNeverLeftOut, kThread},
    {'G', 860, T::kNeverLeftOut, kSpindleCycle},
    {'G', 870, T::kNeverLeftOut, kSpindleCycle},
    {'G', 880, T::kNeverLeftOut, kSpindleCycle},
    {'G', 950, T::kNeverLeftOut, "there is no spindle encoder to follow: write feeds a minute (G94)"},
    {'G', 960, T::kRefused, "the spindle's speed cannot follow a radius"},
    {'G', 1070, T::kNeverLeftOut, kMapped},
    {'G', 1120, T::kNeverLeftOut, kMapped},
    {'G', 1130, T::kNeverLeftOut, kMapped},
    {'G', 1410, T::kNeverLeftOut, kCutter},
    {'G', 1430, T::kNeverLeftOut, kMapped},
    {'G', 1500, T::kNeverLeftOut, kMoves},
    {'G', 1540, T::kNeverLeftOut, "coordinate systems are G54 to G59.3"},
    {'G', 1610, T::kNeverLeftOut, kHoming},
    {'G', 1620, T::kNeverLeftOut, kHoming},
    {'G', 1840, T::kNeverLeftOut, kThread},
    {'G', 2340, T::kNeverLeftOut, kMapped},
    {'G', 2540, T::kNeverLeftOut, kMapped},
    {'G', 3800, T::kNeverLeftOut, kMoves},
    {'G', 4250, T::kNeverLeftOut, kMoves},
    {'M', 170, T::kLeftOut, ""},
    {'M', 180, T::kLeftOut, ""},
    {'M', 190, T::kRefused, "there is no spindle encoder to turn to an angle by"},
    {'M', 480, T::kRefused, kOverrides},
    {'M', 490, T::kRefused, kOverrides},
    {'M', 500, T::kRefused, kOverrides},
    {'M', 510, T::kRefused, kOverrides},
    {'M', 520, T::kRefused, kOverrides},
    {'M', 530, T::kRefused, kOverrides},
    {'M', 610, T::kNeverLeftOut, "T and M6 name the tool in the spindle"},
    {'M', 660, T::kRefused, "no line waits for an input; G38.2 moves until one changes"},
    {'M', 670, T::kRefused, "there are no analogue outputs"},
    {'M', 680, T::kRefused, "there are no analogue outputs"},
    {'M', 700, T::kNeverLeftOut, kModes},
    {'M', 710, T::kNeverLeftOut, kModes},
    {'M', 720, T::kNeverLeftOut, kModes},
    {'M', 730, T::kLeftOut, ""},
    {'M', 840, T::kLeftOut, ""},
    {'M', 970, T::kNeverLeftOut, kSubroutines},
    {'M', 980, T::kNeverLeftOut, kSubroutines},
    {'M', 990, T::kNeverLeftOut, kSubroutines},
    {'M', 1040, T::kLeftOut, ""},
    {'M', 1050, T::kLeftOut, ""},
    {'M', 1060, T::kLeftOut, ""},
    {'M', 1070, T::kLeftOut, ""},
    {'M', 1090, T::kLeftOut, ""},
    {'M', 1100, T::kLeftOut, ""},
    {'M', 1150, T::kLeftOut, ""},
    {'M', 1170, T::kText, ""},
    {'M', 1400, T::kLeftOut, ""},
    {'M', 1900, T::kLeftOut, ""},
    {'M', 2010, T::kLeftOut, ""},
    {'M', 2020, T::kLeftOut, ""},
    {'M', 2030, T::kLeftOut, ""},
    {'M', 2040, T::kLeftOut, ""},
    {'M', 2050, T::kLeftOut, ""},
    {'M', 2060, T::kNeverLeftOut, kOffsets},
    {'M', 2180, T::kNeverLeftOut, kOffsets},
    {'M', 2200, T::kFullPercent, "only S100 has no effect; --override changes the speed"},
    {'M', 2210, T::kFullPercent, "only S100 has no effect; let the slicer scale E"},
    {'M', 2900, T::kNeverLeftOut, kOffsets},
    {'M', 4000, T::kLeftOut, ""},
    {'M', 8621, T::kLeftOut, ""},
    {'M', 8622, T::kLeftOut, ""},
    {'M', 8623, T::kLeftOut, ""},
    {'M', 8624, T::kLeftOut, ""},
    {'M', 8625, T::kLeftOut, ""},
    {'M', 8626, T::kLeftOut, ""},
    {'M', 9000, T::kLeftOut, ""},
};

}  // namespace

const OtherWord* begin_other_words() { return std::begin(kWords); }
const OtherWord* end_other_words() { return std::end(kWords); }

const OtherWord* find_other_word(char letter, int tenths) {
  const OtherWord* const found = std::find_if(std::begin(kWords), std::end(kWords), [&](const OtherWord& word) {
    return word.letter == letter && word.tenths == tenths;
  });
  return found != std::end(kWords) ? found : nullptr;
}

std::string_view command_name(std::string_view line) {
  constexpr std::size_t kShortest = 4;
  const auto letters = static_cast<std::size_t>(std::find_if_not(line.begin(), line.end(), is_letter) - line.begin());
  const auto in_name = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
  const auto size = static_cast<std::size_t>(std::find_if_not(line.begin(), line.end(), in_name) - line.begin());
  const bool ends = size == line.size() || is_space(line[size]) || line[size] == ';';
  return letters >= 2 && size >= kShortest && ends ? line.substr(0, size) : std::string_view();
}

}  // namespace trammel::gcode
