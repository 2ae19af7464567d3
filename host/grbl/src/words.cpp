#include "words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace trammel::grbl {
namespace {

constexpr int kLargestLineNumber = 10'000'000;  // Grbl's
constexpr std::string_view kPlainLetters = "FIJKLNPRST";
constexpr std::string_view kNotNegative = "FNPTS";

enum Group : unsigned {
  kNonModalGroup = 1,
  kMotionGroup,
  kPlane,
  kDistance,
  kArcDistance,
  kFeedMode,
  kUnits,
  kCutter,
  kToolLengthGroup,
  kSystem,
  kControl,
  kProgram,
  kSpindle,
  kCoolant,
  kMist,
  kOverride
};

bool join(Words& words, Group group) {
  const unsigned bit = 1U << group;
  const bool first = (words.groups & bit) == 0;
  words.groups |= bit;
  return first;
}

// Grbl's read_float(): sign, digits, one point; no exponent.
bool read_number(std::string_view line, std::size_t& at, std::string& text) {
  const std::size_t begin = at;
  if (at < line.size() && (line[at] == '-' || line[at] == '+')) ++at;
  std::size_t digits = 0;
  bool point = false;
  for (; at < line.size(); ++at) {
    if (line[at] == '.' && !point) {
      point = true;
    } else if (line[at] >= '0' && line[at] <= '9') {
      ++digits;
    } else {
      break;
    }
  }
  text = line.substr(begin, at - begin);
  return digits != 0;
}

Status take_command(Words& words, Words::Command command) {
  if (words.command != Words::Command::kNone) return Status::kAxisCommandConflict;
  words.command = command;
  return Status::kOk;
}

struct Code {
  Group group;
  bool known;
  bool reader;  // the project's reader gets it
};

// Codes that are no motion and no offsets' commands.
Code plain_code(int tenths) {
  switch (tenths) {
    case 170:
    case 180:
    case 190:
      return {kPlane, true, true};
    case 900:
    case 910:
      return {kDistance, true, true};
    case 911:
      return {kArcDistance, true, false};
    case 930:
    case 940:
      return {kFeedMode, true, true};
    case 200:
    case 210:
      return {kUnits, true, true};
    case 400:
      return {kCutter, true, false};
    case 540:
    case 550:
    case 560:
    case 570:
    case 580:
    case 590:
      return {kSystem, true, true};
    case 610:
      return {kControl, true, false};
    default:
      return {kControl, false, false};
  }
}

Status read_g(int tenths, const std::string& text, Words& words) {
  Status status = Status::kOk;
  Group group = kNonModalGroup;
  bool reader = true;
  switch (tenths) {
    case 100:
    case 280:
    case 300:
    case 920:
      status = take_command(words, Words::Command::kNonModal);
      words.non_modal = tenths;
      break;
    case 40:
    case 530:
    case 281:
    case 301:
    case 921:
      words.non_modal = tenths;
      break;
    case 0:
    case 10:
    case 20:
    case 30:
    case 382:
    case 383:
    case 384:
    case 385:
      status = take_command(words, Words::Command::kMotion);
      group = kMotionGroup;
      words.motion = tenths;
      reader = tenths < 100;  // a probe's word is the block's
      break;
    case 800:
      group = kMotionGroup;
      words.motion = tenths;
      break;
    case 431:
    case 490:
      status = take_command(words, Words::Command::kToolLength);
      group = kToolLengthGroup;
      words.tool_length = tenths == 431;
      break;
    default: {
      const Code code = plain_code(tenths);
      if (!code.known)
        return tenths % 10 != 0 && plain_code(tenths / 10 * 10).known ? Status::kNotInteger : Status::kUnsupported;
      group = code.group;
      reader = code.reader;
    }
  }
  if (status != Status::kOk) return status;
  words.system = words.system || group == kSystem;
  words.plane = words.plane || group == kPlane;
  words.feed_mode = words.feed_mode || group == kFeedMode;
  if (!join(words, group)) return Status::kModalGroup;
  words.g_codes.push_back(tenths);
  if (reader) words.codes.push_back("G" + text);
  return Status::kOk;
}

// M7 and M8 may stand together, as in LinuxCNC; in Grbl they may not.
Status read_m(int number, Words& words) {
  Group group = kProgram;
  bool reader = true;
  switch (number) {
    case 0:
    case 1:
    case 2:
    case 30:
      words.program = number == 1 ? -1 : number;
      reader = number >= 2;
      break;
    case 3:
    case 4:
    case 5:
      group = kSpindle;
      break;
    case 7:
      group = kMist;
      break;
    case 8:
    case 9:
      group = kCoolant;
      break;
    case 56:
      group = kOverride;
      reader = false;
      break;
    default:
      return Status::kUnsupported;
  }
  words.outputs = words.outputs || group == kSpindle || group == kMist || group == kCoolant;
  if (!join(words, group)) return Status::kModalGroup;
  if (number == 9 && (words.groups >> kMist & 1U) != 0) return Status::kModalGroup;
  words.m_codes.push_back(number);
  if (reader) words.codes.push_back(fmt::format("M{}", number));
  return Status::kOk;
}

Status read_value(char letter, const std::string& text, std::string_view axes, Words& words) {
  const bool axis = axes.find(letter) != std::string_view::npos;
  if (!axis && kPlainLetters.find(letter) == std::string_view::npos) return Status::kUnsupported;
  if (words.has(letter)) return Status::kRepeatedWord;
  const double value = std::strtod(text.c_str(), nullptr);
  if (value < 0 && kNotNegative.find(letter) != std::string_view::npos) return Status::kNegativeValue;
  if (letter == 'N' && value > kLargestLineNumber) return Status::kLineNumber;
  if (axis) words.axes += letter;
  words.values[letter] = text;
  return Status::kOk;
}

}  // namespace

double Words::value(char letter) const { return std::strtod(values.at(letter).c_str(), nullptr); }

std::string Words::letters() const {
  std::string all;
  for (const auto& [letter, number] : values) {
    if (axes.find(letter) == std::string::npos) all += letter;
  }
  return all;
}

Status read_words(std::string_view line, std::string_view axes, Words& words) {
  for (std::size_t at = 0; at < line.size();) {
    const char letter = line[at++];
    if (letter < 'A' || letter > 'Z') return Status::kExpectedLetter;
    std::string text;
    if (!read_number(line, at, text)) return Status::kBadNumber;
    const double value = std::strtod(text.c_str(), nullptr);
    Status status = Status::kOk;
    if (letter == 'G' || letter == 'M') {
      if (value < 0 || value > 1000) return Status::kUnsupported;
      const long hundredths = std::lround(value * 100);
      if (letter == 'M' ? hundredths % 100 != 0 : hundredths % 10 != 0) return Status::kNotInteger;
      status = letter == 'G' ? read_g(static_cast<int>(hundredths / 10), text, words)
                             : read_m(static_cast<int>(hundredths / 100), words);
    } else {
      status = read_value(letter, text, axes, words);
    }
    if (status != Status::kOk) return status;
  }
  return Status::kOk;
}

Status apply_words(const Words& words, Modal& modal) {
  for (const int g : words.g_codes) {
    if (g == 170 || g == 180 || g == 190) modal.plane = g / 10;
    if (g == 900 || g == 910) modal.absolute = g == 900;
    if (g == 930 || g == 940) modal.inverse_time = g == 930;
    if (g == 200 || g == 210) modal.inches = g == 200;
    if (g >= 540 && g <= 590) modal.system = g / 10;
    if (g == 490) modal.tool_length = 0;
  }
  if (words.motion >= 0) modal.motion = words.motion;
  for (const int m : words.m_codes) {
    if (m >= 3 && m <= 5) modal.spindle = m;
    if (m == 7) modal.mist = true;
    if (m == 8) modal.flood = true;
    if (m == 9) modal.mist = modal.flood = false;
  }
  if (words.has('F') && !modal.inverse_time) modal.feed = words.value('F') * modal.mm_per_unit();
  if (words.has('S')) modal.speed = words.value('S');
  if (words.has('T')) modal.tool = static_cast<int>(words.value('T'));
  if (words.tool_length && words.has('Z')) modal.tool_length = words.value('Z') * modal.mm_per_unit();
  return Status::kOk;
}

}  // namespace trammel::grbl
