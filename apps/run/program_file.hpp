// The program file, which `trammel run` reads twice. Standard input, a pipe or a device can be read only once, so it is
// first copied to a temporary file, which has no name and therefore cannot be left behind. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/temporary_files.hpp"
#include "trammel/gcode/line_source.hpp"

namespace trammel::app {

class ProgramFile {
 public:
  // "-" is standard input. `copy_limit`: largest size of the copy, bytes; none: the program is read once and not
  // copied. Throws UsageError if the program cannot be read or is longer than the limit, and std::runtime_error if it
  // cannot be copied.
  ProgramFile(const std::string& file, std::optional<std::uint64_t> copy_limit);
  ~ProgramFile();
  ProgramFile(const ProgramFile&) = delete;
  ProgramFile& operator=(const ProgramFile&) = delete;

  // The file's name, for messages.
  const std::string& name() const { return name_; }
  // The program's lines from the first one on; only one reader at a time. The file must outlive it.
  gcode::FileLines lines() const;

 private:
  void copy_to_temporary(std::uint64_t limit);

  std::string name_;
  int descriptor_ = -1;
  std::optional<NamelessFile> copy_;  // read in place of descriptor_
};

}  // namespace trammel::app
