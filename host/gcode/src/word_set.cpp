#include "word_set.hpp"

#include <fmt/format.h>

#include <string>

namespace trammel::gcode {
namespace {

struct Code {
  char letter;
  int tenths;
  Group group;
  bool effect;  // false: accepted, listed in the summary; M3 to M9 where they switch no output
};

constexpr std::array<Code, 46> kCodes = {{
    {'G', 0, Group::kMotion, true},        {'G', 10, Group::kMotion, true},       {'G', 20, Group::kMotion, true},
    {'G', 30, Group::kMotion, true},       {'G', 40, Group::kNonModal, true},     {'G', 170, Group::kPlane, true},
    {'G', 180, Group::kPlane, true},       {'G', 190, Group::kPlane, true},       {'G', 200, Group::kUnits, true},
    {'G', 210, Group::kUnits, true},       {'G', 280, Group::kNonModal, true},    {'G', 400, Group::kCutter, true},
    {'G', 490, Group::kToolLength, true},  {'G', 530, Group::kNonModal, true},    {'G', 540, Group::kCoordinates, true},
    {'G', 550, Group::kCoordinates, true}, {'G', 560, Group::kCoordinates, true}, {'G', 570, Group::kCoordinates, true},
    {'G', 580, Group::kCoordinates, true}, {'G', 590, Group::kCoordinates, true}, {'G', 610, Group::kPathControl, true},
    {'G', 611, Group::kPathControl, true}, {'G', 640, Group::kPathControl, true}, {'G', 800, Group::kMotion, true},
    {'G', 900, Group::kDistance, true},    {'G', 901, Group::kArcDistance, true}, {'G', 910, Group::kDistance, true},
    {'G', 911, Group::kArcDistance, true}, {'G', 920, Group::kNonModal, true},    {'G', 921, Group::kNonModal, true},
    {'G', 930, Group::kFeedMode, true},    {'G', 940, Group::kFeedMode, true},    {'M', 0, Group::kStopping, false},
    {'M', 10, Group::kStopping, false},    {'M', 20, Group::kStopping, true},     {'M', 300, Group::kStopping, true},
    {'M', 30, Group::kSpindle, false},     {'M', 40, Group::kSpindle, false},     {'M', 50, Group::kSpindle, false},
    {'M', 70, Group::kCoolant, false},     {'M', 80, Group::kCoolant, false},     {'M', 90, Group::kCoolant, false},
    {'M', 180, Group::kMotors, false},     {'M', 840, Group::kMotors, false},     {'M', 820, Group::kExtruder, true},
    {'M', 830, Group::kExtruder, true},
}};

// Place in kCodes of every G and M word, by its tenths.
constexpr std::uint8_t kNoCode = 0xff;
using CodePlaces = std::array<std::uint8_t, 1000>;

constexpr CodePlaces places_of(char letter) {
  CodePlaces places{};
  for (std::uint8_t& place : places) {
    place = kNoCode;
  }
  for (std::size_t i = 0; i < kCodes.size(); ++i) {
    if (kCodes[i].letter == letter) {
      places[static_cast<std::size_t>(kCodes[i].tenths)] = static_cast<std::uint8_t>(i);
    }
  }
  return places;
}

const Code* find_code(const Word& word) {
  static constexpr CodePlaces kG = places_of('G');
  static constexpr CodePlaces kM = places_of('M');
  const int tenths = code_of(word.value);
  if (tenths < 0 || tenths >= static_cast<int>(kG.size())) {
    return nullptr;
  }
  const std::uint8_t place = (word.letter == 'G' ? kG : kM)[static_cast<std::size_t>(tenths)];
  return place != kNoCode ? &kCodes[place] : nullptr;
}

// Letters as a set of bits.
constexpr std::uint32_t bit(char letter) { return 1U << static_cast<unsigned>(letter - 'A'); }
constexpr std::uint32_t bits(std::string_view letters) {
  std::uint32_t set = 0;
  for (const char letter : letters) {
    set |= bit(letter);
  }
  return set;
}
constexpr bool in(char letter, std::uint32_t set) { return (set & bit(letter)) != 0; }

constexpr std::uint32_t kCodeLetters = bits("GM");
constexpr std::uint32_t kAxes = bits(machine::kAxisLetters);
constexpr std::uint32_t kOthers = bits("FIJKNPQRST");
constexpr std::uint32_t kSignless = bits("FNPQST");
constexpr std::uint32_t kWhole = bits("NT");
constexpr std::uint32_t kWithoutEffect = bits("ST");

// Numbers of words are at most 1e12.
bool is_whole(double value) { return value == static_cast<double>(static_cast<std::int64_t>(value)); }

bool twice(const Word& word, Problem& problem) {
  return problem.set(ErrorCode::kLetterTwice, fmt::format("'{}': {} stands twice", quote(word.text), word.letter));
}

}  // namespace

AxisLetters::AxisLetters(const machine::Machine& machine) {
  axes_.fill(kNone);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    axes_[static_cast<std::size_t>(machine.axes[axis].letter - 'A')] = static_cast<std::uint8_t>(axis);
  }
}

bool WordSet::read(std::string_view line, const AxisLetters& axes, Problem& problem) {
  words_ = 0;
  codes_present_ = 0;
  letters_present_ = 0;
  axes_present_ = 0;
  accepted_count_ = 0;
  WordScanner scanner(line);
  for (Word word; scanner.next(word, problem); ++words_) {
    if (!add(word, axes, problem)) {
      return false;
    }
  }
  return !scanner.failed();
}

bool WordSet::add(const Word& word, const AxisLetters& axes, Problem& problem) {
  if (in(word.letter, kAxes)) {
    return add_axis(word, axes, problem);
  }
  if (in(word.letter, kCodeLetters)) {
    return add_code(word, problem);
  }
  if (in(word.letter, kOthers)) {
    return add_letter(word, problem);
  }
  return problem.set(ErrorCode::kUnsupportedWord, fmt::format("unsupported word '{}'", quote(word.text)));
}

bool WordSet::add_code(const Word& word, Problem& problem) {
  const Code* code = find_code(word);
  if (code == nullptr) {
    return problem.set(ErrorCode::kUnsupportedWord, fmt::format("unsupported word '{}'", quote(word.text)));
  }
  const auto place = static_cast<std::size_t>(code->group);
  if ((codes_present_ >> place & 1U) != 0) {
    return problem.set(ErrorCode::kModalGroupTwice,
                       fmt::format("'{}' beside another word of its modal group", quote(word.text)));
  }
  codes_present_ |= 1U << place;
  codes_[place] = static_cast<std::int16_t>(code->tenths);
  if (!code->effect) {
    accepted_[accepted_count_++] = {word.letter, code->tenths / 10};
  }
  return true;
}

bool WordSet::add_letter(const Word& word, Problem& problem) {
  if (word.letter == 'N' && words_ != 0) {
    return problem.set(ErrorCode::kLineNumberNotFirst, fmt::format("'{}' must be the first word", quote(word.text)));
  }
  if (in(word.letter, letters_present_)) {
    return twice(word, problem);
  }
  if (in(word.letter, kSignless) && word.value < 0) {
    return problem.set(ErrorCode::kNegative, fmt::format("'{}' must not be negative", quote(word.text)));
  }
  if (in(word.letter, kWhole) && !is_whole(word.value)) {
    return problem.set(ErrorCode::kNotWhole, fmt::format("'{}' must be a whole number", quote(word.text)));
  }
  letters_present_ |= bit(word.letter);
  letters_[static_cast<std::size_t>(word.letter - 'A')] = word.value;
  if (in(word.letter, kWithoutEffect)) {
    accepted_[accepted_count_++] = {word.letter, -1};
  }
  return true;
}

bool WordSet::add_axis(const Word& word, const AxisLetters& axes, Problem& problem) {
  const std::uint8_t axis = axes[word.letter];
  if (axis == AxisLetters::kNone) {
    return problem.set(ErrorCode::kNoSuchAxis,
                       fmt::format("'{}': the machine has no axis {}", quote(word.text), word.letter));
  }
  if (has_axis(axis)) {
    return twice(word, problem);
  }
  axes_present_ |= 1U << axis;
  axes_[axis] = word.value;
  return true;
}

}  // namespace trammel::gcode
