#include "trammel/gcode/reader.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string>

#include "interpreter.hpp"
#include "words.hpp"

namespace trammel::gcode {
namespace {

// Lines of a text, without their ends.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
      rest_.remove_prefix(kByteOrderMark.size());
    }
  }

  bool next(std::string_view& line) {
    if (rest_.empty()) {
      return false;
    }
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }

  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

std::string_view without_spaces_around(std::string_view line) {
  constexpr std::string_view kSpaces = " \t\r";
  const std::size_t first = line.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) {
    return {};
  }
  return line.substr(first, line.find_last_not_of(kSpaces) - first + 1);
}

}  // namespace

ProgramError::ProgramError(const std::string& file, std::size_t line, const std::string& message)
    : std::runtime_error(fmt::format("{}:{}: {}", file, line, message)), file_(file), line_(line), message_(message) {}

Program read_program(std::string_view text, const std::string& file, const machine::Machine& machine,
                     const Coordinates& start) {
  Program program;
  program.file = file;
  program.start = start;
  Interpreter interpreter(machine, program);
  Lines lines(text);
  std::vector<Word> words;
  std::string_view line;
  bool seen_block = false;
  bool ended = false;
  try {
    while (!ended && lines.next(line)) {
      const std::string_view content = without_spaces_around(line);
      if (content.empty() || content.front() == '/') {
        continue;
      }
      if (content.front() == '%') {
        // The first one opens the tape, the next one ends it.
        ended = seen_block;
        seen_block = true;
        continue;
      }
      split_words(content, words);
      seen_block = seen_block || !words.empty();
      ended = !interpreter.execute(make_block(words, machine), lines.number());
    }
  } catch (const WordError& error) {
    throw ProgramError(file, lines.number(), error.message);
  }
  if (program.motions.empty() || program.motions.back().kind != MotionKind::kEnd) {
    interpreter.end(lines.number());
  }
  return program;
}

Program read_program_file(const std::string& path, const machine::Machine& machine, const Coordinates& start) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream || stream.bad()) {
    throw ProgramError(path, 0, "cannot read the program");
  }
  return read_program(text, path, machine, start);
}

}  // namespace trammel::gcode
