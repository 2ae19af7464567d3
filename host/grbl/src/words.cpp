#include "words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

namespace trammel::grbl {
namespace {

constexpr int kLargestCode = 255;
constexpr int kLargestTool = 255;  // limit of Grbl
constexpr std::string_view kPlainLetters = "FIJKLNPRST";
constexpr std::string_view kNotNegative = "FNPTS";

bool join(Words& words, Group group) {
  const unsigned bit = 1U << group;
  const bool first = (words.groups & bit) == 0;
  words.groups |= bit;
  return first;
}

struct GCode {
  int tenths;
  Group group;
  bool to_reader = true;  // passed to the project's reader unchanged
};

constexpr GCode kGCodes[]{{0, kMotionGroup},
                          {10, kMotionGroup},
                          {20, kMotionGroup},
                          {30, kMotionGroup},
                          {382, kMotionGroup, false},
                          {383, kMotionGroup, false},
                          {384, kMotionGroup, false},
                          {385, kMotionGroup, false},
                          {800, kMotionGroup},
                          {40, kNonModalGroup},
                          {100, kNonModalGroup},
                          {280, kNonModalGroup},
                          {281, kNonModalGroup},
                          {300, kNonModalGroup},
                          {301, kNonModalGroup},
                          {530, kNonModalGroup},
                          {920, kNonModalGroup},
                          {921, kNonModalGroup},
                          {170, kPlane},
                          {180, kPlane},
                          {190, kPlane},
                          {900, kDistance},
                          {910, kDistance},
                          {911, kArcDistance, false},
                          {930, kFeedMode},
                          {940, kFeedMode},
                          {200, kUnits},
                          {210, kUnits},
                          {400, kCutter, false},
                          {431, kToolLengthGroup},
                          {490, kToolLengthGroup},
                          {540, kSystemGroup},
                          {550, kSystemGroup},
                          {560, kSystemGroup},
                          {570, kSystemGroup},
                          {580, kSystemGroup},
                          {590, kSystemGroup},
                          {610, kControl, false}};

// The use of the axis words in a line with G`code`; kNone: not determined by this word.
Words::Command command_of(int code, int hundredths) {
  if (code <= 3 || code == 38) return Words::Command::kMotion;
  if (code == 43 || code == 49) return Words::Command::kToolLength;
  const bool non_modal = code == 10 || code == 28 || code == 30 || code == 92;
  return non_modal && hundredths == 0 ? Words::Command::kNonModal : Words::Command::kNone;
}

// Whether Grbl has codes with this number and a decimal. It reports the others as unsupported instead of error 23.
bool has_point(int code) {
  constexpr int kCodes[]{28, 30, 38, 43, 61, 90, 91, 92};
  return std::find(std::begin(kCodes), std::end(kCodes), code) != std::end(kCodes);
}

Status read_g(int code, int hundredths, Words& words) {
  if (code == 49) hundredths = 0;  // as in Grbl, G49.1 is G49
  const auto of_code = [code](const GCode& one) { return one.tenths / 10 == code; };
  if (std::none_of(std::begin(kGCodes), std::end(kGCodes), of_code)) return Status::kUnsupported;
  if (const Words::Command command = command_of(code, hundredths); command != Words::Command::kNone) {
    if (words.command != Words::Command::kNone) return Status::kAxisCommandConflict;
    words.command = command;
  }
  const auto found = std::find_if(std::begin(kGCodes), std::end(kGCodes),
                                  [&](const GCode& one) { return one.tenths * 10 == code * 100 + hundredths; });
  if (found == std::end(kGCodes)) return has_point(code) ? Status::kUnsupported : Status::kNotInteger;
  if (!join(words, found->group)) return Status::kModalGroup;
  const int tenths = found->tenths;
  if (found->group == kMotionGroup) words.motion = tenths;
  if (found->group == kNonModalGroup) words.non_modal = tenths;
  if (found->group == kToolLengthGroup) words.tool_length = tenths == 431;
  words.system = words.system || found->group == kSystemGroup;
  words.g_codes.push_back(tenths);
  if (found->to_reader) words.codes.push_back(g_word(tenths));
  return Status::kOk;
}

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
    case 8:
    case 9:
      group = kCoolant;
      break;
    default:
      return Status::kUnsupported;
  }
  words.outputs = words.outputs || group == kSpindle || group == kCoolant;
  // Mist and flood may be in one line: cncjs' client expects it, although Grbl 1.1h refuses it.
  const auto has = [&](int m) { return std::count(words.m_codes.begin(), words.m_codes.end(), m) != 0; };
  const bool both = (number == 7 && has(8) && !has(7)) || (number == 8 && has(7) && !has(8));
  if (!both && !join(words, group)) return Status::kModalGroup;
  words.m_codes.push_back(number);
  if (reader) words.codes.push_back(fmt::format("M{}", number));
  return Status::kOk;
}

Status read_value(char letter, const std::string& text, std::string_view axes, Words& words) {
  const bool axis = axes.find(letter) != std::string_view::npos;
  if (!axis && kPlainLetters.find(letter) == std::string_view::npos) return Status::kUnsupported;
  const double value = std::strtod(text.c_str(), nullptr);
  if (letter == 'T' && value > kLargestTool) return Status::kValueTooLarge;
  if (words.has(letter)) return Status::kRepeatedWord;
  if (value < 0 && kNotNegative.find(letter) != std::string_view::npos) return Status::kNegativeValue;
  if (axis) words.axes += letter;
  words.values[letter] = text;
  return Status::kOk;
}

}  // namespace

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
      if (value < 0 || value > kLargestCode) return Status::kUnsupported;
      const int code = static_cast<int>(value);
      const int hundredths = static_cast<int>(std::lround((value - code) * 100));
      if (letter == 'M' && hundredths != 0) return Status::kNotInteger;
      status = letter == 'G' ? read_g(code, hundredths, words) : read_m(code, words);
    } else {
      status = read_value(letter, text, axes, words);
    }
    if (status != Status::kOk) return status;
  }
  return Status::kOk;
}

void apply_words(const Words& words, Modal& modal) {
  const bool was_inverse_time = modal.inverse_time;
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
  const bool kept = !was_inverse_time && !modal.inverse_time;  // a feed of G93 does not remain
  const double unit = modal.inverse_time ? 1 : modal.mm_per_unit();
  modal.feed = words.has('F') ? words.value('F') * unit : kept ? modal.feed : 0;
  if (words.has('S')) modal.speed = words.value('S');
  if (words.has('T')) modal.tool = static_cast<int>(words.value('T'));
  if (words.tool_length && words.has('Z')) modal.tool_length = words.value('Z') * modal.mm_per_unit();
}

}  // namespace trammel::grbl
