#include "program_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "common/errors.hpp"
#include "common/standard_streams.hpp"
#include "trammel/machine/one_line.hpp"

namespace trammel::app {

namespace {

// Length of the unfinished line at the end of a chunk; `before`: bytes of that line before the chunk.
std::size_t unfinished_line(std::size_t before, std::string_view chunk) {
  const std::size_t end = chunk.find_last_of("\r\n");
  return end == std::string_view::npos ? before + chunk.size() : chunk.size() - 1 - end;
}

// Returns whether all of it was written; otherwise errno gives the reason.
bool write_whole(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

ProgramFile::ProgramFile(const std::string& file, std::optional<std::uint64_t> copy_limit)
    : name_(file == "-" ? "standard input" : machine::one_line(file, machine::kLongestName)),
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
  // The parent may have read a part of standard input.
  const bool starts_over = S_ISREG(status.st_mode) && ::lseek(descriptor_, 0, SEEK_CUR) == 0;
  if (copy_limit && !starts_over) copy_to_temporary(*copy_limit);
}

ProgramFile::~ProgramFile() { ::close(descriptor_); }

void ProgramFile::copy_to_temporary(std::uint64_t limit) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  copy_.emplace(folder);
  std::array<char, 65536> buffer{};
  std::uint64_t copied = 0;
  std::size_t line = 0;
  ssize_t count = 0;
  // The reader refuses a longer line, so the rest of the program is not needed.
  while (line <= gcode::kLongestLine && (count = ::read(descriptor_, buffer.data(), buffer.size())) > 0) {
    const std::string_view chunk(buffer.data(), static_cast<std::size_t>(count));
    copied += chunk.size();
    if (copied > limit) {
      throw UsageError(
          fmt::format("{}: the program is longer than {} MiB and does not come from a regular file. Raise "
                      "--pipe-limit, or give --stream to read it while it runs",
                      name_, limit >> 20U));
    }
    if (!write_whole(copy_->descriptor(), chunk)) {
      throw std::runtime_error(fmt::format("{}: cannot be copied to {} (set TMPDIR to use another folder): {}", name_,
                                           folder.string(), strerror(errno)));
    }
    line = unfinished_line(line, chunk);
  }
  if (count < 0) throw UsageError(fmt::format("{}: cannot read the program: {}", name_, strerror(errno)));
}

gcode::FileLines ProgramFile::lines() const {
  const int descriptor = copy_ ? copy_->descriptor() : descriptor_;
  ::lseek(descriptor, 0, SEEK_SET);
  return {descriptor, name_};
}

}  // namespace trammel::app
