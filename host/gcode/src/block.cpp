#include "block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace trammel::gcode {
namespace {

struct Code {
  char letter;
  int tenths;
  Group group;
  bool effect;  // false: accepted, listed in the summary
};

constexpr std::array<Code, 45> kCodes = {{
    {'G', 0, Group::kMotion, true},        {'G', 10, Group::kMotion, true},
    {'G', 20, Group::kMotion, true},       {'G', 30, Group::kMotion, true},
    {'G', 40, Group::kNonModal, true},     {'G', 170, Group::kPlane, true},
    {'G', 180, Group::kPlane, true},       {'G', 190, Group::kPlane, true},
    {'G', 200, Group::kUnits, true},       {'G', 210, Group::kUnits, true},
    {'G', 280, Group::kNonModal, true},    {'G', 400, Group::kCutter, true},
    {'G', 490, Group::kToolLength, true},  {'G', 530, Group::kNonModal, true},
    {'G', 540, Group::kCoordinates, true}, {'G', 550, Group::kCoordinates, true},
    {'G', 560, Group::kCoordinates, true}, {'G', 570, Group::kCoordinates, true},
    {'G', 580, Group::kCoordinates, true}, {'G', 590, Group::kCoordinates, true},
    {'G', 610, Group::kPathControl, true}, {'G', 640, Group::kPathControl, false},
    {'G', 800, Group::kMotion, true},      {'G', 900, Group::kDistance, true},
    {'G', 901, Group::kArcDistance, true}, {'G', 910, Group::kDistance, true},
    {'G', 911, Group::kArcDistance, true}, {'G', 920, Group::kNonModal, true},
    {'G', 921, Group::kNonModal, true},    {'G', 930, Group::kFeedMode, true},
    {'G', 940, Group::kFeedMode, true},    {'M', 0, Group::kStopping, false},
    {'M', 10, Group::kStopping, false},    {'M', 20, Group::kStopping, true},
    {'M', 300, Group::kStopping, true},    {'M', 30, Group::kSpindle, false},
    {'M', 40, Group::kSpindle, false},     {'M', 50, Group::kSpindle, false},
    {'M', 70, Group::kCoolant, false},     {'M', 80, Group::kCoolant, false},
    {'M', 90, Group::kCoolant, false},     {'M', 180, Group::kMotors, false},
    {'M', 840, Group::kMotors, false},     {'M', 820, Group::kExtruder, true},
    {'M', 830, Group::kExtruder, true},
}};

const Code* find_code(char letter, int tenths) {
  const auto matches = [=](const Code& code) { return code.letter == letter && code.tenths == tenths; };
  const auto at = std::find_if(kCodes.begin(), kCodes.end(), matches);
  return at != kCodes.end() ? &*at : nullptr;
}

void add_code(Block& block, const Word& word) {
  const int tenths = code_of(word);
  const Code* code = find_code(word.letter, tenths);
  if (code == nullptr) {
    throw WordError{fmt::format("unsupported word '{}'", word.text)};
  }
  std::optional<int>& slot = block.codes[static_cast<std::size_t>(code->group)];
  if (slot) {
    throw WordError{fmt::format("'{}' beside another word of its modal group", word.text)};
  }
  slot = tenths;
  if (!code->effect) {
    block.accepted.push_back(fmt::format("{}{}", word.letter, tenths / 10));
  }
}

void add_letter(Block& block, const Word& word) {
  std::optional<double>& slot = block.letters[static_cast<std::size_t>(word.letter - 'A')];
  if (slot) {
    throw WordError{fmt::format("'{}': {} stands twice", word.text, word.letter)};
  }
  const bool signless =
      word.letter == 'F' || word.letter == 'N' || word.letter == 'P' || word.letter == 'S' || word.letter == 'T';
  if (signless && word.value < 0) {
    throw WordError{fmt::format("'{}' must not be negative", word.text)};
  }
  const bool whole = word.letter == 'N' || word.letter == 'T';
  if (whole && word.value != std::floor(word.value)) {
    throw WordError{fmt::format("'{}' must be a whole number", word.text)};
  }
  slot = word.value;
  if (word.letter == 'S' || word.letter == 'T') {
    block.accepted.emplace_back(1, word.letter);
  }
}

void add_axis(Block& block, const Word& word, const machine::Machine& machine) {
  const auto axis = machine.axis(word.letter);
  if (!axis) {
    throw WordError{fmt::format("'{}': the machine has no axis {}", word.text, word.letter)};
  }
  if (block.axes[*axis]) {
    throw WordError{fmt::format("'{}': {} stands twice", word.text, word.letter)};
  }
  block.axes[*axis] = word.value;
}

}  // namespace

bool Block::has_axis_words() const {
  return std::any_of(axes.begin(), axes.end(), [](const auto& word) { return word.has_value(); });
}

Block make_block(const std::vector<Word>& words, const machine::Machine& machine) {
  constexpr std::string_view kOtherLetters = "FIJKNPRST";
  Block block;
  for (const Word& word : words) {
    if (word.letter == 'G' || word.letter == 'M') {
      add_code(block, word);
    } else if (machine::kAxisLetters.find(word.letter) != std::string_view::npos) {
      add_axis(block, word, machine);
    } else if (kOtherLetters.find(word.letter) != std::string_view::npos) {
      if (word.letter == 'N' && &word != &words.front()) {
        throw WordError{fmt::format("'{}' must be the first word", word.text)};
      }
      add_letter(block, word);
    } else {
      throw WordError{fmt::format("unsupported word '{}'", word.text)};
    }
  }
  return block;
}

}  // namespace trammel::gcode
