// Arbitrary bytes as programs. The reader must not crash or hang. It reports an error in one line. Its result does not
// depend on the chunks in which the program arrives. It never drops words that could be a motion.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/gcode/reader.hpp"
#include "trammel/machine/one_line.hpp"

namespace {

using trammel::gcode::Error;
using trammel::gcode::Motion;
using trammel::gcode::MotionKind;

void require(bool holds, const char* what) {
  if (!holds) {
    std::fprintf(stderr, "ERROR: %s\n", what);
    std::abort();
  }
}

trammel::machine::Machine make_machine() {
  trammel::machine::Machine machine;
  machine.clock_hz = 1'000'000;
  for (const char letter : {'X', 'Y', 'Z', 'A', 'E'}) {
    trammel::machine::MachineAxis axis;
    axis.letter = letter;
    axis.home = letter == 'Z' ? 30 : 0;
    axis.offsets[1] = 10;
    machine.axes.push_back(axis);
  }
  machine.tools.push_back({1, {0, 0, 12.5}});
  machine.probe.input = 0;
  return machine;
}

struct Reading {
  std::vector<Motion> motions;
  std::optional<Error> error;
};

Reading read(std::string_view program, std::size_t chunk) {
  static const trammel::machine::Machine machine = make_machine();
  trammel::gcode::TextLines lines(program, "p", chunk);
  trammel::gcode::Reader reader(lines, machine);
  Reading reading;
  Motion motion;
  while (reader.next(motion)) {
    reading.motions.push_back(motion);
    if (reader.awaits_probe()) reader.assume_probed();
  }
  require(!reader.next(motion), "a motion behind the last one");
  reading.error = reader.error();
  return reading;
}

bool same(const Motion& a, const Motion& b) {
  return a.kind == b.kind && a.line == b.line && a.target == b.target && a.feed == b.feed && a.seconds == b.seconds &&
         a.clockwise == b.clockwise && a.full_circle == b.full_circle && a.axis_x == b.axis_x && a.axis_y == b.axis_y &&
         a.centre_x == b.centre_x && a.centre_y == b.centre_y;
}

void check_same(const Reading& a, const Reading& b) {
  require(a.motions.size() == b.motions.size(), "chunks change the number of motions");
  for (std::size_t i = 0; i < a.motions.size(); ++i) {
    require(same(a.motions[i], b.motions[i]), "chunks change a motion");
  }
  require(a.error.has_value() == b.error.has_value(), "chunks change whether there is an error");
  require(!a.error || (a.error->code == b.error->code && describe(*a.error) == describe(*b.error)),
          "chunks change the error");
}

void check_motions(const Reading& reading) {
  std::size_t line = 0;
  for (const Motion& motion : reading.motions) {
    require(motion.line >= line, "motions out of order");
    line = motion.line;
    for (const double target : motion.target) {
      require(std::isfinite(target), "a target that is no number");
    }
    require(std::isfinite(motion.centre_x) && std::isfinite(motion.centre_y), "a centre that is no number");
    require(motion.feed >= 0 && motion.seconds >= 0, "a negative feed or time");
    const bool fed =
        motion.kind == MotionKind::kLine || motion.kind == MotionKind::kArc || motion.kind == MotionKind::kProbe;
    require(!fed || (motion.feed > 0) != (motion.seconds > 0), "a motion with feed needs a feed or a time");
    require((motion.kind == MotionKind::kEnd) == (&motion == &reading.motions.back() && !reading.error),
            "the end is not at the end");
  }
  require(reading.error || !reading.motions.empty(), "a program without an end");
}

void check_error(const Error& error) {
  const std::string text = describe(error);
  require(text.size() < 300, "a message of more than a line");
  for (const char c : text) {
    require(static_cast<unsigned char>(c) >= ' ' && c != '\x7f', "a message with control characters");
  }
  require(trammel::machine::one_line(text, text.size() + 3) == text, "a message that is no UTF-8");
}

std::vector<std::string> split(std::string_view program) {
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (program[i] == '\n' || program[i] == '\r') {
      i += program.substr(i, 2) == "\r\n" ? 1 : 0;
      lines.emplace_back();
    } else {
      lines.back() += program[i];
    }
  }
  return lines;
}

// A line without comments and blanks, by a second implementation of the rules. Empty for a deleted line ('/').
std::string bare(const std::string& line) {
  std::string text;
  bool comment = false;
  for (const char c : line) {
    if (c == ';' && !comment) {
      break;
    }
    comment = comment ? c != ')' : c == '(';
    if (!comment && c != ')' && c != ' ' && c != '\t') {
      text += c;
    }
  }
  return !text.empty() && text.front() == '/' ? std::string{} : text;
}

// True for a line that the reader leaves out as a whole.
bool is_left_out(std::string text) {
  static const std::set<std::string> kWords = {"M73",  "M104", "M105", "M106", "M107", "M109", "M110", "M115", "M117",
                                               "M140", "M190", "M201", "M202", "M203", "M204", "M205", "G29",  "M17",
                                               "M18",  "M84",  "M220", "M221", "M400", "M862", "M900"};
  const auto drop = [&](const char* characters) {
    text.erase(0, std::min(text.find_first_not_of(characters), text.size()));
  };
  for (char& c : text) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  drop(" \t");
  if (!text.empty() && text.front() == 'N') {
    text.front() = ' ';
    drop(" \t");
    drop("0123456789.");
    drop(" \t");
  }
  if (text.empty()) return false;
  std::string word(1, text.front());
  text.front() = ' ';
  drop(" \t");
  text.resize(std::min(text.find_first_not_of("0123456789."), text.size()));
  drop("0");
  word += text.substr(0, text.find('.'));
  return kWords.count(word) != 0;
}

// Checks an accepted program for words that a reader might drop or split without a message.
void check_nothing_dropped(std::string_view program, std::size_t end_line) {
  bool in_program = false;
  bool closed = false;
  std::size_t number = 0;
  for (const std::string& line : split(program)) {
    const std::string written = ++number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0 ? line.substr(3) : line;
    const std::string text = bare(written);
    if (number > end_line && !closed) {
      return;  // the reader stops at M2 or M30
    }
    if (text.empty()) {
      continue;
    }
    const bool mark = text == "%";
    require(mark || is_left_out(written) || text.find('<') != std::string::npos || text.find('%') == std::string::npos,
            "words beside a '%' are dropped");
    require(!closed || mark, "words behind the last '%' are dropped");
    closed = closed || (mark && in_program);
    in_program = true;
    // Operators such as EQ and names in expressions contain letters that are no words.
    if (text.find_first_of("[<") != std::string::npos || is_left_out(written)) continue;
    for (std::size_t i = 1; i < text.size(); ++i) {
      // With blanks before it, 'e' is an axis word. Therefore the line is searched as it is written.
      const bool digit = line.find(std::string(1, text[i - 1]) + "e") != std::string::npos && text[i - 1] >= '0' &&
                         text[i - 1] <= '9' && text[i] == 'e';
      require(!digit || line.find('(') != std::string::npos || line.find(';') != std::string::npos,
              "an exponent is read as an axis word");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view program(reinterpret_cast<const char*>(data), size);
  const Reading whole = read(program, 65536);
  check_motions(whole);
  if (whole.error) {
    check_error(*whole.error);
  } else {
    check_nothing_dropped(program, whole.motions.back().line);
  }
  check_same(whole, read(program, 1 + size % 7));
  return 0;
}
