// Lines, and the error number with which Grbl 1.1h answers them; 0 for ok.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <sstream>
#include <string>

#include "router.hpp"
#include "trammel/grbl/input_buffer.hpp"
#include "trammel/grbl/interpreter.hpp"

namespace trammel::grbl {

// `lines`: separated by '|'. All lines but the last must be accepted; they set the state in which the last one comes.
struct Answer {
  const char* lines;
  int error;
};

inline int answer_of(Interpreter& interpreter, const std::string& line) {
  const std::string text = cleaned(line);
  Block block;
  if (text.empty()) return 0;
  const bool jog = text.rfind("$J=", 0) == 0;
  return static_cast<int>(jog ? interpreter.read_jog(text.substr(3), block) : interpreter.read(text, block));
}

inline void expect_answers(std::initializer_list<Answer> answers) {
  const machine::Machine machine = router();
  for (const auto& [lines, error] : answers) {
    SCOPED_TRACE(lines);
    Interpreter interpreter(machine, router_card());
    std::istringstream parts(lines);
    std::string line;
    std::getline(parts, line, '|');
    for (std::string next; std::getline(parts, next, '|'); line = next) {
      EXPECT_EQ(answer_of(interpreter, line), 0) << line;
    }
    EXPECT_EQ(answer_of(interpreter, line), error);
  }
}

}  // namespace trammel::grbl
