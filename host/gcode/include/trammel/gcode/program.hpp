// A whole program in memory, for the planner until it pulls from the reader.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {

// what() is "file:line: message".
class ProgramError : public std::runtime_error {
 public:
  ProgramError(const std::string& file, std::size_t line, const std::string& message);
  explicit ProgramError(const Error& error) : ProgramError(error.file, error.line, error.message) {}
  const std::string& file() const { return file_; }
  std::size_t line() const { return line_; }
  const std::string& message() const { return message_; }

 private:
  std::string file_;
  std::size_t line_;
  std::string message_;
};

struct Program {
  std::string file;
  Coordinates start{};
  std::vector<Motion> motions;                  // the last one is kEnd
  std::map<std::string, std::size_t> accepted;  // as Reader::accepted()
};

// All motions of a reader's program. Throw ProgramError.
Program read_program(std::string_view text, const std::string& file, const machine::Machine& machine,
                     const Coordinates& start = {});
Program read_program_file(const std::string& path, const machine::Machine& machine, const Coordinates& start = {});

}  // namespace trammel::gcode
