#include "word_set.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "left_out.hpp"
#include "other_words.hpp"

namespace trammel::gcode {
namespace {

struct Code {
  char letter;
  int tenths;
  Group group;
  // false: accepted, and listed in the summary unless the word switches an output of the machine (M3 to M9). M62 to M65
  // are refused if they switch none.
  bool effect;
};

constexpr std::array<Code, 80> kCodes = {{
    {'G', 0, Group::kMotion, true},        {'G', 10, Group::kMotion, true},       {'G', 20, Group::kMotion, true},
    {'G', 30, Group::kMotion, true},       {'G', 40, Group::kNonModal, true},     {'G', 50, Group::kMotion, true},
    {'G', 51, Group::kMotion, true},       {'G', 80, Group::kDiameter, true},     {'G', 100, Group::kNonModal, true},
    {'G', 150, Group::kPolar, true},       {'G', 170, Group::kPlane, true},       {'G', 180, Group::kPlane, true},
    {'G', 190, Group::kPlane, true},       {'G', 200, Group::kUnits, true},       {'G', 210, Group::kUnits, true},
    {'G', 280, Group::kNonModal, true},    {'G', 281, Group::kNonModal, true},    {'G', 300, Group::kNonModal, true},
    {'G', 301, Group::kNonModal, true},    {'G', 310, Group::kMotion, true},      {'G', 382, Group::kMotion, true},
    {'G', 383, Group::kMotion, true},      {'G', 384, Group::kMotion, true},      {'G', 385, Group::kMotion, true},
    {'G', 400, Group::kCutter, true},      {'G', 430, Group::kToolLength, true},  {'G', 431, Group::kToolLength, true},
    {'G', 490, Group::kToolLength, true},  {'G', 520, Group::kNonModal, true},    {'G', 530, Group::kNonModal, true},
    {'G', 540, Group::kCoordinates, true}, {'G', 550, Group::kCoordinates, true}, {'G', 560, Group::kCoordinates, true},
    {'G', 570, Group::kCoordinates, true}, {'G', 580, Group::kCoordinates, true}, {'G', 590, Group::kCoordinates, true},
    {'G', 591, Group::kCoordinates, true}, {'G', 592, Group::kCoordinates, true}, {'G', 593, Group::kCoordinates, true},
    {'G', 610, Group::kPathControl, true}, {'G', 611, Group::kPathControl, true}, {'G', 640, Group::kPathControl, true},
    {'G', 690, Group::kRotation, true},    {'G', 730, Group::kMotion, true},      {'G', 800, Group::kMotion, true},
    {'G', 810, Group::kMotion, true},      {'G', 820, Group::kMotion, true},      {'G', 830, Group::kMotion, true},
    {'G', 850, Group::kMotion, true},      {'G', 890, Group::kMotion, true},      {'G', 900, Group::kDistance, true},
    {'G', 901, Group::kArcDistance, true}, {'G', 910, Group::kDistance, true},    {'G', 911, Group::kArcDistance, true},
    {'G', 920, Group::kNonModal, true},    {'G', 921, Group::kNonModal, true},    {'G', 922, Group::kNonModal, true},
    {'G', 923, Group::kNonModal, true},    {'G', 930, Group::kFeedMode, true},    {'G', 940, Group::kFeedMode, true},
    {'G', 970, Group::kSpindleMode, true}, {'G', 980, Group::kRetract, true},     {'G', 990, Group::kRetract, true},
    {'M', 0, Group::kStopping, false},     {'M', 10, Group::kStopping, false},    {'M', 20, Group::kStopping, true},
    {'M', 300, Group::kStopping, true},    {'M', 30, Group::kSpindle, false},     {'M', 40, Group::kSpindle, false},
    {'M', 50, Group::kSpindle, false},     {'M', 60, Group::kToolChange, false},  {'M', 70, Group::kCoolant, false},
    {'M', 80, Group::kCoolant, false},     {'M', 90, Group::kCoolant, false},     {'M', 620, Group::kNumbered, false},
    {'M', 630, Group::kNumbered, false},   {'M', 640, Group::kNumbered, false},   {'M', 650, Group::kNumbered, false},
    {'M', 820, Group::kExtruder, true},    {'M', 830, Group::kExtruder, true},
}};

// Index into kCodes of every G and M word, by its tenths.
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

const Code* find_code(char letter, int tenths) {
  static constexpr CodePlaces kG = places_of('G');
  static constexpr CodePlaces kM = places_of('M');
  if (tenths < 0 || tenths >= static_cast<int>(kG.size())) {
    return nullptr;
  }
  const std::uint8_t place = (letter == 'G' ? kG : kM)[static_cast<std::size_t>(tenths)];
  return place != kNoCode ? &kCodes[place] : nullptr;
}

// A set of letters, one bit per letter.
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
constexpr std::uint32_t kOthers = bits("FHIJKLNPQRST");
constexpr std::uint32_t kSignless = bits("FHLNST");
constexpr std::uint32_t kWhole = bits("HLNT");
constexpr std::uint32_t kToolNumbers = bits("HT");
constexpr std::uint32_t kNow = bits("HLNT");  // values that must not depend on a probe
constexpr std::uint32_t kWithoutEffect = bits("ST");

// Numbers of words are at most 1e12.
bool is_whole(double value) { return value == std::trunc(value); }

bool twice(const Word& word, Problem& problem) {
  return problem.set(ErrorCode::kLetterTwice, fmt::format("'{}': {} stands twice", quote(word.text), word.letter));
}

bool no_such_axis(char letter, std::string_view text, Problem& problem) {
  return problem.set(ErrorCode::kNoSuchAxis,
                     fmt::format("'{}': the machine has no axis {}; [axis.{}] of its file would describe it",
                                 quote(text), letter, static_cast<char>(letter - 'A' + 'a')));
}

bool depends_on_probe(const Word& word, Problem& problem) {
  return problem.set(ErrorCode::kDependsOnProbe, fmt::format("'{}' cannot depend on a probe", quote(word.text)));
}

constexpr std::string_view kObeyed = "the reader obeys it";
constexpr std::string_view kNoSuchWord = "no such word here: write what it stands for";

}  // namespace

AxisLetters::AxisLetters(const machine::Machine& machine) {
  axes_.fill(kNone);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    axes_[static_cast<std::size_t>(machine.axes[axis].letter - 'A')] = static_cast<std::uint8_t>(axis);
  }
}

bool WordSet::read(std::string_view line, const AxisLetters& axes, Parameters& parameters, Problem& problem) {
  words_ = 0;
  codes_present_ = 0;
  letters_present_ = 0;
  axes_present_ = 0;
  bare_letters_ = 0;
  bare_axes_ = 0;
  later_letters_ = 0;
  later_axes_ = 0;
  accepted_count_ = 0;
  WordScanner scanner(line, parameters);
  for (Word word; scanner.next(word, problem); ++words_) {
    if (!add(word, axes, problem)) {
      return false;
    }
  }
  if (scanner.failed() || (bare_letters_ != 0 && !check_bare(axes, problem))) {
    return false;
  }
  if (parameters.any_assigned()) {
    parameters.take_effect();
  }
  return true;
}

bool WordSet::add(const Word& word, const AxisLetters& axes, Problem& problem) {
  if (word.bare) {
    first_bare_ = bare_letters_ == 0 ? word.letter : first_bare_;
    bare_letters_ |= bit(word.letter);
    return true;
  }
  if (in(word.letter, kAxes)) {
    return add_axis(word, axes, problem);
  }
  if (in(word.letter, kCodeLetters)) {
    return add_code(word, problem);
  }
  if (in(word.letter, kOthers)) {
    return add_letter(word, problem);
  }
  return unsupported(word, problem);
}

bool WordSet::add_code(const Word& word, Problem& problem) {
  const Code* code = find_code(word.letter, code_of(word.value));
  if (word.later) {
    return depends_on_probe(word, problem);
  }
  if (code == nullptr) {
    return unsupported(word, problem);
  }
  const auto place = static_cast<std::size_t>(code->group);
  constexpr int kCancel = 800;
  if ((codes_present_ >> place & 1U) != 0) {
    if (code->group == Group::kMotion && (code->tenths == kCancel || codes_[place] == kCancel)) {
      codes_[place] = code->tenths == kCancel ? codes_[place] : static_cast<std::int16_t>(code->tenths);
      return true;  // next to G80 the other word counts
    }
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
  if (word.later && in(word.letter, kNow)) {
    return depends_on_probe(word, problem);
  }
  double value = word.value;
  if (in(word.letter, kSignless) && value < 0) {
    if (!word.later) {
      return problem.set(ErrorCode::kNegative, fmt::format("'{}' must not be negative", quote(word.text)));
    }
    value = 0;
  }
  if (in(word.letter, kWhole) && !is_whole(value)) {
    return problem.set(ErrorCode::kNotWhole, fmt::format("'{}' must be a whole number", quote(word.text)));
  }
  if (in(word.letter, kToolNumbers) && value > machine::kLargestTool) {
    return problem.set(ErrorCode::kNoSuchTool, fmt::format("'{}': the number of a tool is at most {}", quote(word.text),
                                                           machine::kLargestTool));
  }
  letters_present_ |= bit(word.letter);
  later_letters_ |= word.later ? bit(word.letter) : 0;
  letters_[static_cast<std::size_t>(word.letter - 'A')] = value;
  if (in(word.letter, kWithoutEffect)) {
    accepted_[accepted_count_++] = {word.letter, -1};
  }
  return true;
}

bool WordSet::add_axis(const Word& word, const AxisLetters& axes, Problem& problem) {
  const std::uint8_t axis = axes[word.letter];
  if (axis == AxisLetters::kNone) {
    return no_such_axis(word.letter, word.text, problem);
  }
  if (has_axis(axis)) {
    return twice(word, problem);
  }
  axes_present_ |= 1U << axis;
  later_axes_ |= word.later ? 1U << axis : 0;
  axes_[axis] = word.value;
  return true;
}

// Letters without a number are allowed only as axes of G28 and G30. W is not an axis of a printer: G28 W means without
// bed levelling.
bool WordSet::check_bare(const AxisLetters& axes, Problem& problem) {
  const std::optional<int> action = code(Group::kNonModal);
  const bool home = action == code::kHome || action == code::kSecondHome;
  if (!home || (bare_letters_ & ~kAxes) != 0) {
    return problem.set(ErrorCode::kMalformedNumber, fmt::format("malformed number in '{}'", first_bare_));
  }
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if (!in(letter, bare_letters_)) continue;
    if (axes[letter] != AxisLetters::kNone) {
      bare_axes_ |= 1U << axes[letter];
    } else if (letter != 'W') {
      return no_such_axis(letter, std::string_view(&letter, 1), problem);
    }
  }
  return true;
}

// If the line could be left out, the reader adds to the message how.
bool WordSet::unsupported(const Word& word, Problem& problem) const {
  const CodeWord code{word.letter, in(word.letter, kCodeLetters) ? code_of(word.value) : -1};
  const OtherWord* const other = find_other_word(code.letter, code.tenths);
  std::string message = fmt::format("unsupported word '{}'", quote(word.text));
  const std::string_view never = code.tenths >= 0 ? why_not_left_out(code) : std::string_view();
  const std::string_view why = other != nullptr ? other->why : never == kObeyed ? kNoSuchWord : never;
  if (!why.empty()) message += fmt::format(": {}", why);
  const bool first = words_ == 0 || (words_ == 1 && letter('N'));
  const bool may_be_left_out = code.tenths >= 0 && never.empty();
  if (may_be_left_out && !first) {
    const bool always = other != nullptr && is_left_out(other->treatment);
    message += fmt::format(
        "; on a line of its own {}",
        always ? "it is left out" : fmt::format("--accept {} leaves it out", name_of(code.letter, code.tenths)));
  }
  problem.set(ErrorCode::kUnsupportedWord, std::move(message));
  if (may_be_left_out && first) problem.unknown = name_of(code.letter, code.tenths);
  return false;
}

std::optional<bool> has_effect(const CodeWord& word) {
  const Code* const code = find_code(word.letter, word.tenths);
  return code != nullptr ? std::optional<bool>(code->effect) : std::nullopt;
}

std::string_view why_not_left_out(const CodeWord& word) {
  if (has_effect(word).value_or(false)) return kObeyed;
  const OtherWord* const other = find_other_word(word.letter, word.tenths);
  if (other != nullptr) return other->treatment == Treatment::kNeverLeftOut ? other->why : std::string_view();
  // An unknown word such as G59.4 may act like G59, so it may be left out only if G59 may.
  const CodeWord whole{word.letter, word.tenths - word.tenths % 10};
  if (word.letter != 'G' || word.tenths == whole.tenths) return {};
  return why_not_left_out(whole);
}

std::vector<std::string> known_words() {
  std::vector<std::string> words;
  for (const Code& code : kCodes) words.push_back(name_of(code.letter, code.tenths));
  for (const char letter : machine::kAxisLetters) words.emplace_back(1, letter);
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if (in(letter, kOthers)) words.emplace_back(1, letter);
  }
  add_left_out(words);
  return words;
}

}  // namespace trammel::gcode
