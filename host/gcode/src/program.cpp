#include "trammel/gcode/program.hpp"

#include <fmt/format.h>

namespace trammel::gcode {
namespace {

Program gather(LineSource& lines, const machine::Machine& machine, const Coordinates& start) {
  Reader reader(lines, machine, start);
  Program program;
  program.file = lines.name();
  program.start = start;
  for (Motion motion; reader.next(motion);) {
    program.motions.push_back(motion);
  }
  if (reader.error()) {
    throw ProgramError(*reader.error());
  }
  program.accepted = reader.accepted();
  return program;
}

}  // namespace

ProgramError::ProgramError(const std::string& file, std::size_t line, const std::string& message)
    : std::runtime_error(fmt::format("{}:{}: {}", file, line, message)), file_(file), line_(line), message_(message) {}

Program read_program(std::string_view text, const std::string& file, const machine::Machine& machine,
                     const Coordinates& start) {
  TextLines lines(text, file);
  return gather(lines, machine, start);
}

Program read_program_file(const std::string& path, const machine::Machine& machine, const Coordinates& start) {
  FileLines lines(path);
  return gather(lines, machine, start);
}

}  // namespace trammel::gcode
