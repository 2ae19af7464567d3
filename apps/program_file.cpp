#include "program_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "errors.hpp"
#include "standard_streams.hpp"
#include "temporary_files.hpp"

namespace trammel::app {

ProgramFile::ProgramFile(const std::string& file, bool once)
    : name_(file == "-" ? "standard input" : file),
      descriptor_(file == "-" ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                              : ::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    throw UsageError(fmt::format("{}: cannot read the program: {}", name_, strerror(errno)));
  }
  if (file == "-" && standard_input_is_closed()) {
    throw UsageError("standard input: is closed: no program can be read from it");
  }
  if (S_ISDIR(status.st_mode)) throw UsageError(fmt::format("{}: is a directory, not a program", name_));
  // Standard input may have been read in part by who gave it.
  if (!once && (!S_ISREG(status.st_mode) || ::lseek(descriptor_, 0, SEEK_CUR) != 0)) copy_to_temporary();
}

ProgramFile::~ProgramFile() { ::close(descriptor_); }

void ProgramFile::copy_to_temporary() {
  const auto fail = [&](const char* what) {
    throw std::runtime_error(fmt::format("{}: {}: {}", name_, what, strerror(errno)));
  };
  const TemporaryFile copy(std::filesystem::temp_directory_path());
  std::array<char, 65536> buffer{};
  ssize_t count = 0;
  while ((count = ::read(descriptor_, buffer.data(), buffer.size())) > 0) {
    for (ssize_t done = 0; done < count;) {
      const ssize_t written = ::write(copy.descriptor(), buffer.data() + done, static_cast<std::size_t>(count - done));
      if (written < 0) fail("cannot be copied to a temporary file");
      done += written;
    }
  }
  if (count < 0) throw UsageError(fmt::format("{}: cannot read the program: {}", name_, strerror(errno)));
  // The name goes with `copy`; the open file stays.
  const int descriptor = ::fcntl(copy.descriptor(), F_DUPFD_CLOEXEC, 0);
  if (descriptor < 0) fail("cannot be kept");
  ::close(descriptor_);
  descriptor_ = descriptor;
}

gcode::FileLines ProgramFile::lines() const {
  ::lseek(descriptor_, 0, SEEK_SET);
  return {descriptor_, name_};
}

}  // namespace trammel::app
