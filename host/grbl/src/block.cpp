#include "trammel/grbl/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "words.hpp"

namespace trammel::grbl {
namespace {

constexpr int kProbe = 38;

bool is_arc(int motion) { return motion == 20 || motion == 30; }
bool is_probe(int motion) { return motion / 10 == kProbe; }

// What Grbl checks of offsets and dwells once all words are known.
Status check_non_modal(const Words& words) {
  const bool axes = !words.axes.empty();
  switch (words.non_modal) {
    case 40:
      return words.has('P') ? Status::kOk : Status::kMissingWord;
    case 100:
      if (!axes) return Status::kNoAxisWords;
      if (!words.has('P') || !words.has('L')) return Status::kMissingWord;
      if (words.value('P') > 6) return Status::kCoordinateSystem;
      if (words.value('L') != 2 && words.value('L') != 20) return Status::kUnsupported;
      return words.has('R') ? Status::kUnsupported : Status::kOk;
    case 920:
      return axes ? Status::kOk : Status::kNoAxisWords;
    default:
      return Status::kOk;
  }
}

Status check_arc(const Words& words, const Modal& after) {
  if (words.axes.empty()) return Status::kNoAxisWords;
  const char first = after.plane == 19 ? 'Y' : after.plane == 18 ? 'Z' : 'X';
  const char second = after.plane == 17 ? 'Y' : after.plane == 18 ? 'X' : 'Z';
  const auto offset = [](char axis) { return static_cast<char>('I' + (axis - 'X')); };
  if (words.axes.find(first) == std::string::npos && words.axes.find(second) == std::string::npos) {
    return Status::kNoAxisWordsInPlane;
  }
  if (!words.has('R') && !words.has(offset(first)) && !words.has(offset(second))) return Status::kNoOffsetsInPlane;
  return Status::kOk;
}

Status check_motion(const Words& words, const Modal& after, bool& used_arc_words) {
  used_arc_words = false;
  const bool axes = !words.axes.empty();
  const int motion = after.motion;
  if (words.non_modal == 530 && motion != 0 && motion != 10) return Status::kMachineCoordinates;
  if (words.command == Words::Command::kNonModal || words.command == Words::Command::kToolLength) return Status::kOk;
  if (motion == 800) return axes ? Status::kAxisWordsUnused : Status::kOk;
  if (words.command != Words::Command::kMotion && !axes) return Status::kOk;
  if (motion == 0) return Status::kOk;
  if (after.inverse_time && axes && !words.has('F')) return Status::kNoFeed;
  if (!after.inverse_time && after.feed == 0) return Status::kNoFeed;
  if (is_probe(motion)) return axes ? Status::kOk : Status::kNoAxisWords;
  if (!is_arc(motion)) return Status::kOk;
  used_arc_words = true;
  return check_arc(words, after);
}

Status check_unused(const Words& words, bool arc) {
  std::string used = "FNST";
  if (arc) used += "IJKR";
  if (words.non_modal == 40) used += "P";
  if (words.non_modal == 100) used += "PL";
  for (const char letter : words.letters()) {
    if (used.find(letter) == std::string::npos) return Status::kUnusedWords;
  }
  return Status::kOk;
}

// The words once more, for the reader: explicit motion, without what it need not see.
std::string text_of(const Words& words, const Block& block) {
  std::string codes;
  // The reader takes one word of coolant in a line.
  const bool both = std::count(words.m_codes.begin(), words.m_codes.end(), 7) != 0 &&
                    std::count(words.m_codes.begin(), words.m_codes.end(), 8) != 0;
  for (const std::string& code : words.codes) codes += both && code == "M7" ? "" : code + " ";
  std::string values;
  for (const auto& [letter, number] : words.values) {
    if (letter != 'N' && letter != 'T') values += fmt::format("{}{} ", letter, number);
  }
  if (block.moves && !block.dwell && words.motion < 0 && words.non_modal != 280 && words.non_modal != 300) {
    codes += fmt::format("G{} ", block.after.motion / 10);
  }
  if (block.probe) codes += block.probe_away ? "G38.5 " : "G38.3 ";
  std::string text = codes + values;
  if (!text.empty()) text += "\n";
  if (both) text = "M7\n" + text;
  return text;
}

void describe(const Words& words, Block& block) {
  const Modal& after = block.after;
  const bool axes = !words.axes.empty();
  const bool motion = words.command == Words::Command::kMotion || words.command == Words::Command::kNone;
  block.line_number = words.has('N') ? static_cast<int>(words.value('N')) : 0;
  block.dwell = words.non_modal == 40;
  const bool home = words.non_modal == 280 || words.non_modal == 300;
  block.moves = (axes && motion && after.motion != 800) || home || block.dwell;
  block.probe = axes && motion && is_probe(after.motion) && !home;
  block.probe_away = after.motion >= 384;
  block.probe_must_trip = after.motion % 2 == 0;
  block.outputs = words.outputs || (words.has('S') && after.spindle != 5);
  block.pause = words.program == 0;
  block.end = words.program == 2 || words.program == 30;
  block.offsets = words.system || words.non_modal == 100 || words.non_modal == 920 || words.non_modal == 921 ||
                  words.command == Words::Command::kToolLength || block.end;
}

// Grbl's M2 and M30 bring these back.
void end_program(Modal& modal) {
  modal.motion = 10;
  modal.system = 54;
  modal.plane = 17;
  modal.absolute = true;
  modal.inverse_time = false;
  modal.spindle = 5;
  modal.mist = modal.flood = false;
}

}  // namespace

Status parse_block(std::string_view line, const Modal& before, std::string_view axes, Block& block) {
  Words words;
  if (const Status status = read_words(line, axes, words); status != Status::kOk) return status;
  block = {};
  block.after = before;
  if (const Status status = apply_words(words, block.after); status != Status::kOk) return status;
  if (const Status status = check_non_modal(words); status != Status::kOk) return status;
  if (words.tool_length && words.axes != "Z") return Status::kToolLengthAxis;
  bool arc = false;
  if (const Status status = check_motion(words, block.after, arc); status != Status::kOk) return status;
  if (const Status status = check_unused(words, arc); status != Status::kOk) return status;
  describe(words, block);
  block.text = text_of(words, block);
  if (block.end) end_program(block.after);
  return Status::kOk;
}

Status parse_jog(std::string_view line, const Modal& before, std::string_view axes, Block& block) {
  Words words;
  if (const Status status = read_words(line, axes, words); status != Status::kOk) return status;
  Modal modal = before;
  modal.inverse_time = false;
  modal.feed = 0;
  if (const Status status = apply_words(words, modal); status != Status::kOk) return status;
  if (words.program >= 0 || words.outputs || words.system || words.motion >= 0 || words.tool_length || words.plane ||
      words.feed_mode || (words.non_modal >= 0 && words.non_modal != 530)) {
    return Status::kInvalidJog;
  }
  if (!words.has('F')) return Status::kNoFeed;
  if (words.axes.empty()) return Status::kNoAxisWords;
  block = {};
  block.after = before;
  block.moves = true;
  std::string text = fmt::format("G94 {} {} {}G1", modal.absolute ? "G90" : "G91", modal.inches ? "G20" : "G21",
                                 words.non_modal == 530 ? "G53 " : "");
  for (const auto& [letter, number] : words.values) {
    if (letter == 'F' || words.axes.find(letter) != std::string::npos) text += fmt::format(" {}{}", letter, number);
  }
  block.text = text + "\n";
  return Status::kOk;
}

}  // namespace trammel::grbl
