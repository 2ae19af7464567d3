// The program that `trammel run` reads: twice, so what can be read only once (standard input, a pipe) is copied to a
// temporary file first. Not thread-safe.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "trammel/gcode/line_source.hpp"

namespace trammel::app {

class ProgramFile {
 public:
  // "-" is standard input. Throws UsageError when it cannot be read, std::runtime_error when it cannot be copied.
  explicit ProgramFile(const std::string& file);
  ~ProgramFile();
  ProgramFile(const ProgramFile&) = delete;
  ProgramFile& operator=(const ProgramFile&) = delete;

  // For messages.
  const std::string& name() const { return name_; }
  // Of a file that can be read from any place (pread), any number of times; closed with the object.
  int descriptor() const { return descriptor_; }

 private:
  void copy_to_temporary();

  std::string name_;
  int descriptor_ = -1;
};

// Its lines, from the first one on. The file must outlive them.
class ProgramLines final : public gcode::ChunkedLines {
 public:
  explicit ProgramLines(const ProgramFile& file) : ChunkedLines(file.name()), descriptor_(file.descriptor()) {}
  std::optional<std::string> failure() const override { return failure_; }

 protected:
  std::size_t read(char* to, std::size_t most) override;

 private:
  int descriptor_;
  off_t at_ = 0;
  std::optional<std::string> failure_;
};

}  // namespace trammel::app
