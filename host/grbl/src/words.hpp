// The words of a line, by Grbl's modal groups. Internal to the block parser.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/grbl/modal.hpp"
#include "trammel/grbl/numbers.hpp"

namespace trammel::grbl {

// Grbl's modal groups; each is a bit of Words::groups.
enum Group : unsigned {
  kNonModalGroup,
  kMotionGroup,
  kPlane,
  kDistance,
  kArcDistance,
  kFeedMode,
  kUnits,
  kCutter,
  kToolLengthGroup,
  kSystemGroup,
  kControl,
  kProgram,
  kSpindle,
  kCoolant
};

struct Words {
  enum class Command { kNone, kMotion, kNonModal, kToolLength };

  std::map<char, std::string> values;  // letters other than G and M, as written
  std::vector<std::string> codes;      // codes for the project's reader
  std::string axes;                    // letters of the axis words
  Command command = Command::kNone;    // the command that uses the axis words
  int motion = -1;                     // code of the motion group, as in Modal::motion
  int non_modal = -1;                  // tenths: 40, 100, 280, 281, 300, 301, 530, 920, 921
  int program = -1;                    // 0, 2, 30
  bool tool_length = false;            // G43.1
  bool outputs = false;                // M3 .. M5, M7 .. M9
  bool system = false;                 // G54 .. G59
  unsigned groups = 0;                 // bit n: Group n occurred
  std::vector<int> g_codes;            // tenths
  std::vector<int> m_codes;

  bool has(char letter) const { return values.count(letter) != 0; }
  double value(char letter) const;
  // Letters of the values, without axis letters.
  std::string letters() const;
};

// Reads sign, digits and one point; no exponent. `at`: moved to the end of the number.
bool read_number(std::string_view line, std::size_t& at, std::string& text);
Status read_words(std::string_view line, std::string_view axes, Words& words);
// Applies G and M codes, F, S, T and Z of G43.1.
void apply_words(const Words& words, Modal& modal);

}  // namespace trammel::grbl
