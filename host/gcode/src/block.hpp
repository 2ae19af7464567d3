// One line of G-code as a set of words, one for each modal group. Internal to the reader.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/machine/machine.hpp"
#include "words.hpp"

namespace trammel::gcode {

// Modal groups as in RS274/NGC: at most one word of a group on a line.
enum class Group {
  kNonModal,     // G4 G28 G53 G92 G92.1
  kMotion,       // G0 G1 G2 G3 G80
  kPlane,        // G17 G18 G19
  kDistance,     // G90 G91
  kArcDistance,  // G90.1 G91.1
  kFeedMode,     // G93 G94
  kUnits,        // G20 G21
  kCutter,       // G40
  kToolLength,   // G49
  kCoordinates,  // G54 .. G59
  kPathControl,  // G61 G64
  kStopping,     // M0 M1 M2 M30
  kSpindle,      // M3 M4 M5
  kCoolant,      // M7 M8 M9
  kMotors,       // M18 M84
  kExtruder,     // M82 M83
  kCount
};

struct Block {
  // Code in tenths of a group's word, as G2 = 20 or M30 = 300.
  std::array<std::optional<int>, static_cast<std::size_t>(Group::kCount)> codes;
  std::array<std::optional<double>, card_map::kMaxAxes> axes;  // as written, by axis index
  std::array<std::optional<double>, 26> letters;               // F I J K N P R S T, by letter
  std::vector<std::string> accepted;                           // words without effect, as "M3"

  std::optional<int> code(Group group) const { return codes[static_cast<std::size_t>(group)]; }
  std::optional<double> letter(char name) const { return letters[static_cast<std::size_t>(name - 'A')]; }
  bool has_axis_words() const;
};

// Sorts the words into a block. Throws WordError for an unknown word, an axis that the machine lacks, two words of one
// group, a letter twice, and values that a letter cannot have.
Block make_block(const std::vector<Word>& words, const machine::Machine& machine);

}  // namespace trammel::gcode
