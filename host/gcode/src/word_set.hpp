// One line of G-code as a set of words, one word per modal group and letter. Internal to the reader.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codes.hpp"
#include "problem.hpp"
#include "trammel/card_map.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "words.hpp"

namespace trammel::gcode {

// Modal groups as in RS274/NGC: at most one word of a group on a line.
enum class Group {
  kNonModal,     // G4 G10 G28 G28.1 G30 G30.1 G52 G53 G92 .. G92.3
  kMotion,       // G0 G1 G2 G3 G5 G5.1 G31 G38.2 .. G38.5 G73 G80 .. G83 G85 G89
  kPlane,        // G17 G18 G19
  kDistance,     // G90 G91
  kArcDistance,  // G90.1 G91.1
  kFeedMode,     // G93 G94
  kUnits,        // G20 G21
  kCutter,       // G40
  kToolLength,   // G43 G43.1 G49
  kCoordinates,  // G54 .. G59.3
  kPathControl,  // G61 G61.1 G64
  kStopping,     // M0 M1 M2 M30
  kSpindle,      // M3 M4 M5
  kCoolant,      // M7 M8 M9
  kNumbered,     // M62 M63 M64 M65
  kExtruder,     // M82 M83
  kRetract,      // G98 G99
  kToolChange,   // M6
  kDiameter,     // G8
  kPolar,        // G15
  kRotation,     // G69
  kSpindleMode,  // G97
  kCount
};

inline constexpr std::size_t kLetters = 26;

// Code::effect of the word: false if it does nothing on some machines, as M3. Empty if the reader does not know it.
std::optional<bool> has_effect(const CodeWord& word);

// The axis of each letter; kNone for a letter without an axis.
class AxisLetters {
 public:
  static constexpr std::uint8_t kNone = 0xff;
  explicit AxisLetters(const machine::Machine& machine);
  std::uint8_t operator[](char letter) const { return axes_[static_cast<std::size_t>(letter - 'A')]; }

 private:
  std::array<std::uint8_t, kLetters> axes_;
};

// A value is valid only if its bit is set. The arrays are not cleared between lines, because a line sets few of them.
class WordSet {
 public:
  // Sorts the words of a line. Returns false, with a problem, for an unknown word, an axis that the machine lacks, two
  // words of one group, a letter twice, and values that a letter cannot have. Assignments go to `parameters`, and have
  // taken effect if it returns true.
  bool read(std::string_view line, const AxisLetters& axes, Parameters& parameters, Problem& problem);

  bool empty() const { return words_ == 0; }
  // Nothing but axis words, a motion word, F and N, as on most lines of most programs.
  bool is_plain() const { return (codes_present_ & ~kPlainGroups) == 0 && (letters_present_ & ~kPlainLetters) == 0; }
  // The word of a group in tenths, such as G2 = 20 or M30 = 300.
  std::optional<int> code(Group group) const;
  std::optional<double> letter(char name) const;  // F H I J K L N P Q R S T
  bool has_axis_words() const { return axes_present_ != 0; }
  bool has_axis(std::size_t axis) const { return (axes_present_ >> axis & 1U) != 0; }
  double axis(std::size_t axis) const { return axes_[axis]; }  // as written
  std::uint32_t axes() const { return axes_present_; }         // bit n: axis n
  // Axes that G28 or G30 names without a value.
  std::uint32_t bare_axes() const { return bare_axes_; }
  // Seconds of a G4: P, or else S, which is then not a spindle speed.
  std::optional<double> dwell() const;
  bool dwells_by_s() const { return code(Group::kNonModal) == code::kDwell && !letter('P'); }

  // Whether a value depends on a probe that has not run yet (see Value): of any word, of a letter, of an axis word.
  bool later() const { return (later_letters_ | later_axes_) != 0; }
  bool later(char name) const { return (later_letters_ >> (name - 'A') & 1U) != 0; }
  bool axis_later(std::size_t axis) const { return (later_axes_ >> axis & 1U) != 0; }

  // Words that have no effect unless the machine has an output for them: "M3".
  struct Accepted {
    char letter;
    int number;  // -1: a letter without a code
  };
  const Accepted* accepted_begin() const { return accepted_.data(); }
  const Accepted* accepted_end() const { return accepted_.data() + accepted_count_; }

 private:
  bool add(const Word& word, const AxisLetters& axes, Problem& problem);
  bool add_code(const Word& word, Problem& problem);
  bool add_letter(const Word& word, Problem& problem);
  bool add_axis(const Word& word, const AxisLetters& axes, Problem& problem);
  [[gnu::cold]] bool check_bare(const AxisLetters& axes, Problem& problem);
  [[gnu::cold]] bool unsupported(const Word& word, Problem& problem) const;

  static constexpr std::uint32_t kPlainGroups = 1U << static_cast<unsigned>(Group::kMotion);
  static constexpr std::uint32_t kPlainLetters = 1U << ('F' - 'A') | 1U << ('N' - 'A');

  std::size_t words_ = 0;
  std::uint32_t codes_present_ = 0;
  std::uint32_t letters_present_ = 0;
  std::uint32_t axes_present_ = 0;
  std::uint32_t bare_letters_ = 0;
  char first_bare_ = 0;
  std::uint32_t bare_axes_ = 0;
  std::uint32_t later_letters_ = 0;
  std::uint32_t later_axes_ = 0;
  std::size_t accepted_count_ = 0;
  std::array<std::int16_t, static_cast<std::size_t>(Group::kCount)> codes_;
  std::array<double, kLetters> letters_;
  std::array<double, card_map::kMaxAxes> axes_;
  std::array<Accepted, static_cast<std::size_t>(Group::kCount) + 2> accepted_;  // one per group, S and T
};

inline std::optional<int> WordSet::code(Group group) const {
  const auto place = static_cast<std::size_t>(group);
  return (codes_present_ >> place & 1U) != 0 ? std::optional<int>(codes_[place]) : std::nullopt;
}

inline std::optional<double> WordSet::letter(char name) const {
  const auto place = static_cast<std::size_t>(name - 'A');
  return (letters_present_ >> place & 1U) != 0 ? std::optional<double>(letters_[place]) : std::nullopt;
}

inline std::optional<double> WordSet::dwell() const { return letter(dwells_by_s() ? 'S' : 'P'); }

}  // namespace trammel::gcode
