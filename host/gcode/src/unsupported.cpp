#include "unsupported.hpp"

#include <algorithm>
#include <iterator>

namespace trammel::gcode {
namespace {

constexpr std::string_view kEncoder = "there is no spindle encoder to follow";
constexpr std::string_view kCutter = "cutter compensation: let the CAM program offset the path";
constexpr std::string_view kSpindleCycle = "a boring cycle that stops and turns the spindle";

struct Reason {
  char letter;
  int tenths;
  std::string_view why;
};

constexpr Reason kReasons[] = {
    {'G', 52, "B-splines are not there; G5 and G5.1 are"},
    {'G', 53, "B-splines are not there; G5 and G5.1 are"},
    {'G', 70, "diameters of a lathe: write radii"},
    {'G', 330, kEncoder},
    {'G', 331, kEncoder},
    {'G', 410, kCutter},
    {'G', 411, kCutter},
    {'G', 420, kCutter},
    {'G', 421, kCutter},
    {'G', 432, "one tool offset at a time: G43 or G43.1"},
    {'G', 740, kEncoder},
    {'G', 760, kEncoder},
    {'G', 840, kEncoder},
    {'G', 860, kSpindleCycle},
    {'G', 870, kSpindleCycle},
    {'G', 880, kSpindleCycle},
    {'G', 950, kEncoder},
    {'G', 960, "the spindle's speed cannot follow a radius"},
    {'M', 480, "the operator has the overrides"},
    {'M', 490, "the operator has the overrides"},
    {'M', 980, "subroutines are not supported"},
    {'M', 990, "subroutines are not supported"},
};

}  // namespace

std::string_view why_unsupported(char letter, int tenths) {
  const auto found = std::find_if(std::begin(kReasons), std::end(kReasons), [&](const Reason& reason) {
    return reason.letter == letter && reason.tenths == tenths;
  });
  return found != std::end(kReasons) ? found->why : std::string_view();
}

}  // namespace trammel::gcode
