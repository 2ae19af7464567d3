// The program that `trammel run` reads twice. Standard input, a pipe or a device can be read only once: it is copied to
// a temporary file first, which has no name and so cannot be left behind. Not thread-safe.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/temporary_files.hpp"
#include "trammel/gcode/line_source.hpp"

namespace trammel::app {

class ProgramFile {
 public:
  // "-" is standard input. `copy_limit`: bytes of the copy at most; without it the program is read once and not copied.
  // Throws UsageError when it cannot be read or is longer than the limit, std::runtime_error when it cannot be copied.
  ProgramFile(const std::string& file, std::optional<std::uint64_t> copy_limit);
  ~ProgramFile();
  ProgramFile(const ProgramFile&) = delete;
  ProgramFile& operator=(const ProgramFile&) = delete;

  // For messages.
  const std::string& name() const { return name_; }
  // Its lines from the first one on; not two at a time. The file must outlive them.
  gcode::FileLines lines() const;

 private:
  void copy_to_temporary(std::uint64_t limit);

  std::string name_;
  int descriptor_ = -1;
  std::optional<NamelessFile> copy_;  // read in place of descriptor_
};

}  // namespace trammel::app
