// The program that `trammel run` reads: twice, so what can be read only once (standard input, a pipe) is copied to a
// temporary file first. Not thread-safe.
#pragma once

#include <string>

#include "trammel/gcode/line_source.hpp"

namespace trammel::app {

class ProgramFile {
 public:
  // "-" is standard input. `once`: it will be read once, and is not copied. Throws UsageError when it cannot be read,
  // std::runtime_error when it cannot be copied.
  explicit ProgramFile(const std::string& file, bool once = false);
  ~ProgramFile();
  ProgramFile(const ProgramFile&) = delete;
  ProgramFile& operator=(const ProgramFile&) = delete;

  // For messages.
  const std::string& name() const { return name_; }
  // Its lines from the first one on; not two at a time. The file must outlive them.
  gcode::FileLines lines() const;

 private:
  void copy_to_temporary();

  std::string name_;
  int descriptor_ = -1;
};

}  // namespace trammel::app
