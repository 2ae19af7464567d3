// Reads a whole program at once, for tests.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {

struct Reading {
  std::vector<Motion> motions;
  std::map<std::string, std::size_t> accepted;
  std::optional<Error> error;

  // The error: refusal() with its line number, message() without it.
  std::string refusal() const { return error ? describe(*error).substr(error->file.size() + 1) : "accepted"; }
  std::string message() const { return error ? error->message : "accepted"; }
};

inline Reading read_all(LineSource& lines, const machine::Machine& machine = machine::default_machine(),
                        const Coordinates& start = {}, const ReaderOptions& options = {}) {
  Reader reader(lines, machine, start, options);
  Reading reading;
  for (Motion motion; reader.next(motion);) {
    reading.motions.push_back(motion);
  }
  reading.accepted = reader.accepted();
  reading.error = reader.error();
  return reading;
}

inline Reading read_text(const std::string& text, const machine::Machine& machine = machine::default_machine(),
                         const Coordinates& start = {}) {
  TextLines lines(text, "p.ngc");
  return read_all(lines, machine, start);
}

inline std::string refusal(const std::string& text) { return read_text(text).refusal(); }

inline Reading read_file(const std::string& path) {
  FileLines lines(path);
  return read_all(lines);
}

}  // namespace trammel::gcode
