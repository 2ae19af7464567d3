#include "trammel/grbl/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "words.hpp"

namespace trammel::grbl {
namespace {

constexpr int kProbe = 38;
constexpr int kNoMotion = 800;
constexpr int kLastSystem = 6;
constexpr int kLargestLineNumber = 10'000'000;
constexpr unsigned kJogGroups = 1U << kDistance | 1U << kUnits | 1U << kNonModalGroup;

bool is_arc(int motion) { return motion == 20 || motion == 30; }
bool is_probe(int motion) { return motion / 10 == kProbe; }

// axes_of_plane(): the first and the second axis of a plane. offset_of(): the letter of an axis's offset to the centre.
std::array<char, 2> axes_of_plane(int plane) {
  if (plane == 17) return {'X', 'Y'};
  return plane == 18 ? std::array<char, 2>{'Z', 'X'} : std::array<char, 2>{'Y', 'Z'};
}
char offset_of(char axis) { return static_cast<char>('I' + (axis - 'X')); }

// The command that uses the axis words. Without such a word they belong to the current motion mode.
Words::Command command_of(const Words& words) {
  const bool implicit = words.command == Words::Command::kNone && !words.axes.empty();
  return implicit ? Words::Command::kMotion : words.command;
}

Status check_feed_mode(const Words& words, const Modal& after) {
  const bool needs_feed = after.motion != 0 && after.motion != kNoMotion;
  const bool missing = after.inverse_time && needs_feed && !words.has('F');
  return missing && command_of(words) == Words::Command::kMotion ? Status::kNoFeed : Status::kOk;
}

Status check_offset_data(const Words& words) {
  if (words.axes.empty()) return Status::kNoAxisWords;
  if (!words.has('P') && !words.has('L')) return Status::kMissingWord;  // if one of the two is missing, it counts as 0
  if (words.has('P') && words.value('P') >= kLastSystem + 1) return Status::kCoordinateSystem;
  const int kind = words.has('L') ? static_cast<int>(words.value('L')) : 0;
  if (kind != 2 && kind != 20) return Status::kUnsupported;
  return kind == 2 && words.has('R') ? Status::kUnsupported : Status::kOk;
}

Status check_non_modal(const Words& words, const Modal& after) {
  if (words.tool_length && words.axes != "Z") return Status::kToolLengthAxis;
  if (words.non_modal == 100) return check_offset_data(words);
  if (words.non_modal == 920 && words.axes.empty()) return Status::kNoAxisWords;
  if (words.non_modal == 530 && after.motion != 0 && after.motion != 10) return Status::kMachineCoordinates;
  return Status::kOk;
}

Status check_arc(const Words& words, const Modal& after) {
  if (words.axes.empty()) return Status::kNoAxisWords;
  const auto [first, second] = axes_of_plane(after.plane);
  if (words.axes.find(first) == std::string::npos && words.axes.find(second) == std::string::npos) {
    return Status::kNoAxisWordsInPlane;
  }
  if (words.has('R') && words.value('R') == 0) return Status::kArcRadius;
  const bool centre = words.has(offset_of(first)) || words.has(offset_of(second));
  return words.has('R') || centre ? Status::kOk : Status::kNoOffsetsInPlane;
}

Status check_motion(const Words& words, const Modal& after) {
  if (after.motion == kNoMotion) return words.axes.empty() ? Status::kOk : Status::kAxisWordsUnused;
  if (command_of(words) != Words::Command::kMotion || after.motion == 0) return Status::kOk;
  if (after.feed == 0) return Status::kNoFeed;
  if (is_arc(after.motion)) return check_arc(words, after);
  return is_probe(after.motion) && words.axes.empty() ? Status::kNoAxisWords : Status::kOk;
}

// `always`: letters that every line may contain.
Status check_unused(const Words& words, const Modal& after, std::string always) {
  if (words.non_modal == 40) always += "P";
  if (words.non_modal == 100) always += "PL";
  if (command_of(words) == Words::Command::kMotion && is_arc(after.motion)) always += words.has('R') ? "R" : "IJK";
  const std::string letters = words.letters();
  return letters.find_first_not_of(always) == std::string::npos ? Status::kOk : Status::kUnusedWords;
}

// In Grbl's order, because Grbl reports the first of several errors.
Status check(const Words& words, const Modal& after, const std::string& always) {
  if (words.has('N') && words.value('N') >= kLargestLineNumber + 1) return Status::kLineNumber;
  if (const Status status = check_feed_mode(words, after); status != Status::kOk) return status;
  if (words.non_modal == 40 && !words.has('P')) return Status::kMissingWord;
  if (const Status status = check_non_modal(words, after); status != Status::kOk) return status;
  if (const Status status = check_motion(words, after); status != Status::kOk) return status;
  return check_unused(words, after, always);
}

// The values for the reader, without those that Grbl ignores and the reader would refuse.
std::string values_of(const Words& words, const Modal& after) {
  std::string values;
  const auto [first, second] = axes_of_plane(after.plane);
  const bool cancels_length = words.command == Words::Command::kToolLength && !words.tool_length;
  for (const auto& [letter, number] : words.values) {
    const bool whole = words.non_modal == 100 && (letter == 'P' || letter == 'L');
    const bool centre = letter >= 'I' && letter <= 'K';
    if (letter == 'N' || letter == 'T') continue;
    if (centre && letter != offset_of(first) && letter != offset_of(second)) continue;
    if (cancels_length && words.axes.find(letter) != std::string::npos) continue;
    values += whole ? fmt::format("{}{} ", letter, static_cast<int>(words.value(letter)))
                    : fmt::format("{}{} ", letter, number);
  }
  return words.non_modal == 100 && !words.has('P') ? values + "P0 " : values;
}

// Writes the words for the reader: with an explicit motion, and without words that the reader does not need.
std::string text_of(const Words& words, const Block& block) {
  const Modal& after = block.after;
  const bool axes_move = command_of(words) == Words::Command::kMotion && !words.axes.empty();
  // The reader accepts G53 only with absolute coordinates.
  const bool relative_g53 = words.non_modal == 530 && axes_move && !after.absolute;
  // The reader accepts one coolant word per line.
  const auto says = [&](const char* code) {
    return std::find(words.codes.begin(), words.codes.end(), code) != words.codes.end();
  };
  const bool mist_and_flood = says("M7") && says("M8");
  std::string codes;
  for (const std::string& code : words.codes) {
    const bool without_use =
        (relative_g53 && code == "G91") || (code == "G53" && !axes_move) || (mist_and_flood && code == "M7");
    if (!without_use) codes += code + " ";
  }
  if (axes_move && words.motion < 0 && !block.probe) codes += g_word(after.motion) + " ";
  if (block.probe) codes += block.probe_away ? "G38.5 " : "G38.3 ";
  std::string text = codes + values_of(words, after);
  if (text.empty()) return text;
  if (mist_and_flood) text = "M7\n" + text;
  return relative_g53 ? "G90 " + text + "\nG91\n" : text + "\n";
}

void describe(const Words& words, Block& block) {
  const Modal& after = block.after;
  const bool axes_move = command_of(words) == Words::Command::kMotion && !words.axes.empty();
  block.line_number = words.has('N') ? static_cast<int>(words.value('N')) : 0;
  block.dwell = words.non_modal == 40;
  block.moves = axes_move || block.dwell || words.non_modal == 280 || words.non_modal == 300;
  block.probe = axes_move && is_probe(after.motion);
  block.probe_away = after.motion >= 384;
  block.probe_must_trip = after.motion % 2 == 0;
  block.outputs = words.outputs || (words.has('S') && after.spindle != 5);
  block.pause = words.program == 0;
  block.end = words.program == 2 || words.program == 30;
  block.offsets = words.system || words.non_modal == 100 || words.non_modal == 920 || words.non_modal == 921 ||
                  words.command == Words::Command::kToolLength || block.end;
}

// Sets the state to which Grbl's M2 and M30 return.
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
  apply_words(words, block.after);
  if (const Status status = check(words, block.after, "FNST"); status != Status::kOk) return status;
  describe(words, block);
  block.text = text_of(words, block);
  if (block.end) end_program(block.after);
  return Status::kOk;
}

Status parse_jog(std::string_view line, const Modal& before, std::string_view axes, Block& block) {
  Words words;
  if (const Status status = read_words(line, axes, words); status != Status::kOk) return status;
  Modal modal = before;
  modal.motion = 10;
  modal.inverse_time = false;
  modal.feed = 0;
  apply_words(words, modal);
  if (!words.has('F')) return Status::kNoFeed;
  if (const Status status = check(words, modal, "FN"); status != Status::kOk) return status;
  if ((words.groups & ~kJogGroups) != 0 || (words.non_modal >= 0 && words.non_modal != 530)) {
    return Status::kInvalidJog;
  }
  if (words.axes.empty()) return Status::kNoAxisWords;
  block = {};
  block.after = before;
  block.moves = true;
  const bool machine = words.non_modal == 530;
  std::string text = fmt::format("G94 {} {} {}G1", modal.absolute || machine ? "G90" : "G91",
                                 modal.inches ? "G20" : "G21", machine ? "G53 " : "");
  for (const auto& [letter, number] : words.values) {
    if (letter == 'F' || words.axes.find(letter) != std::string::npos) text += fmt::format(" {}{}", letter, number);
  }
  block.text = text + "\n";
  return Status::kOk;
}

}  // namespace trammel::grbl
