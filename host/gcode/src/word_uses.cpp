#include "word_uses.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "codes.hpp"
#include "cycles.hpp"
#include "left_out.hpp"

namespace trammel::gcode {
namespace {

bool unused(Problem& problem, std::string message) { return problem.set(ErrorCode::kUnusedWord, std::move(message)); }
bool missing(Problem& problem, const char* message) { return problem.set(ErrorCode::kMissingWord, message); }

// Which letters the words of a line use.
struct Takers {
  std::optional<int> action;
  std::optional<int> motion;  // the motion in force on this line
  bool path_tolerance = false;
  bool arc = false;
  bool makes_arc = false;
  bool numbered = false;  // M62 to M65

  bool takes(char letter) const {
    switch (letter) {
      case 'P':
        return numbered || action == code::kDwell || action == code::kSet || path_tolerance || makes_arc ||
               motion == code::kSpline || (motion && dwells_below(*motion));
      case 'Q':
        return path_tolerance || motion == code::kSpline || (motion && pecks(*motion));
      case 'R':
        return arc || is_cycle(motion) || action == code::kSet;  // the check of G10 says why R is refused
      case 'I':
      case 'J':
        return arc || motion == code::kSpline || motion == code::kQuadratic;
      case 'K':
        return arc;
      case 'L':
        return action == code::kSet || is_cycle(motion);
      default:
        return true;
    }
  }
};

const char* takers_of(char letter) {
  switch (letter) {
    case 'P':
      return "P without a word that takes it: G2, G3, G4, G5, G10, G64, G82, G89 or M62 to M65";
    case 'Q':
      return "Q without G5, G64, G73 or G83";
    case 'L':
      return "L without G10 or a drilling cycle";
    case 'K':
      return "K without G2 or G3";
    default:
      return nullptr;
  }
}

// The number of the output is the line's P, so no other word of the line may use P.
bool check_numbered(const WordSet& words, const Takers& takers, Problem& problem) {
  const std::string name = name_of('M', *words.code(Group::kNumbered));
  const auto number = words.letter('P');
  if (!number) return missing(problem, "M62 to M65 need P, the output's number");
  const bool moves = words.has_axis_words() && takers.motion;
  if (takers.action == code::kDwell || takers.action == code::kSet || takers.path_tolerance || takers.makes_arc ||
      (moves && (takers.motion == code::kSpline || dwells_below(*takers.motion)))) {
    return unused(problem, fmt::format("{} beside another word that takes P: give it a line of its own", name));
  }
  if (words.later('P')) return problem.set(ErrorCode::kDependsOnProbe, name + ": P cannot depend on a probe");
  if (*number != std::trunc(*number)) {
    return problem.set(ErrorCode::kNotWhole, fmt::format("'P{:.10g}' must be a whole number", *number));
  }
  return true;
}

bool check_needs(const WordSet& words, const Takers& takers, Problem& problem) {
  if (takers.action == code::kDwell && !words.dwell()) return missing(problem, "G4 needs P or S, its seconds");
  if (words.letter('H') && words.code(Group::kToolLength) != code::kToolLength) {
    return unused(problem, "H without G43");
  }
  for (const char letter : {'P', 'Q'}) {
    const auto value = words.letter(letter);
    if (value && *value < 0 && takers.motion != code::kSpline && !words.later(letter)) {
      return problem.set(ErrorCode::kNegative, fmt::format("'{}{:.10g}' must not be negative", letter, *value));
    }
  }
  return !words.code(Group::kNumbered) || check_numbered(words, takers, problem);
}

}  // namespace

bool uses_axes_otherwise(const WordSet& words) {
  const auto action = words.code(Group::kNonModal);
  return action == code::kSet || action == code::kHome || action == code::kSecondHome || action == code::kOrigin ||
         action == code::kLocalOrigin || words.code(Group::kToolLength) == code::kToolOffsets;
}

bool check_uses(const WordSet& words, std::optional<int> modal, Problem& problem) {
  Takers takers;
  takers.action = words.code(Group::kNonModal);
  const auto motion = words.code(Group::kMotion);
  const bool otherwise = uses_axes_otherwise(words);
  if (otherwise && motion && motion != code::kCancel) {
    const int action = takers.action.value_or(code::kToolOffsets);
    return problem.set(ErrorCode::kTwoUsesOfAxisWords,
                       fmt::format("{} cannot share a line with a motion", name_of('G', action)));
  }
  takers.motion = otherwise ? std::nullopt : motion ? motion : modal;
  takers.path_tolerance = words.code(Group::kPathControl) == code::kBlend;
  takers.numbered = words.code(Group::kNumbered).has_value();
  takers.arc = takers.motion == code::kArcClockwise || takers.motion == code::kArcCounterClockwise;
  const bool centre = words.letter('I') || words.letter('J') || words.letter('K') || words.letter('R');
  takers.makes_arc = takers.arc && (motion || centre || words.has_axis_words());
  for (const char letter : {'P', 'Q', 'I', 'J', 'K', 'R', 'L'}) {
    if (!words.letter(letter) || takers.takes(letter)) continue;
    const char* const message = takers_of(letter);
    return unused(problem, message != nullptr ? message
                           : letter == 'R'    ? std::string("R without G2, G3 or a drilling cycle")
                                              : fmt::format("{} without G2, G3 or G5", letter));
  }
  return check_needs(words, takers, problem);
}

}  // namespace trammel::gcode
