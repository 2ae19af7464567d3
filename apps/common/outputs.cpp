#include "outputs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "errors.hpp"
#include "standard_streams.hpp"

namespace trammel::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBuffer = 1U << 18U;  // a step list has up to about 10^8 rows

// Whether the path is an open descriptor and not a name in a folder.
bool is_descriptor(const fs::path& file) {
  return file.native().rfind("/proc/", 0) == 0 || file.native().rfind("/dev/fd/", 0) == 0;
}

// The target of a name after all links; it need not exist.
fs::path follow_links(fs::path file) {
  std::error_code error;
  constexpr int kMaxLinks = 40;  // limit of the kernel
  for (int i = 0; fs::is_symlink(file, error); ++i) {
    if (i == kMaxLinks) throw UsageError(fmt::format("{}: too many symbolic links", file.string()));
    if (is_descriptor(file)) break;
    file = file.parent_path() / fs::read_symlink(file, error);
    if (error) break;
  }
  return file;
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

// Empty for devices that accept any number of writers, such as the null device; that is all except terminals.
std::string identity_of(const struct stat& status, bool is_terminal) {
  if (S_ISCHR(status.st_mode) && !is_terminal) return {};
  return fmt::format("{}:{}", status.st_dev, status.st_ino);
}

std::string identity_of_descriptor(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 ? identity_of(status, ::isatty(descriptor) != 0) : std::string();
}

// Identity of an existing file; empty if there is none.
std::string identity_of_file(const fs::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {};
  if (!S_ISCHR(status.st_mode)) return identity_of(status, false);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const std::string result = identity_of(status, ::isatty(descriptor) != 0);
  if (descriptor >= 0) ::close(descriptor);
  return result;
}

// Two names of a file that does not exist yet have the same folder and the same last component.
std::string identity_of_new_file(const fs::path& file) {
  return fmt::format("{}/{}", identity_of_file(folder_of(file)), file.filename().string());
}

}  // namespace

// Inspects the destination; creates and opens nothing.
Output::Output(std::string option, std::string name, bool by_name)
    : option_(std::move(option)), name_(std::move(name)), by_name_(by_name) {
  if (name_.empty()) throw UsageError(fmt::format("{}: the name of the file is empty", option_));
  const auto refuse = [&](const std::string& why) { throw UsageError(fmt::format("{}: {}", name_, why)); };
  struct stat status {};
  if (name_ != "-") target_ = follow_links(name_);
  const bool exists = name_ != "-" && ::stat(target_.c_str(), &status) == 0;
  if (!exists && name_ != "-" && errno != ENOENT) refuse(fmt::format("cannot be written: {}", strerror(errno)));
  identity_ = name_ == "-" ? identity_of_descriptor(STDOUT_FILENO)
                           : (exists ? identity_of_file(target_) : identity_of_new_file(target_));
  // Also /dev/stdout and similar names; otherwise a file to which standard output is redirected would get two contents.
  const bool is_standard_output =
      name_ == "-" || (exists && !identity_.empty() && identity_ == identity_of_descriptor(STDOUT_FILENO));
  if (is_standard_output) {
    kind_ = Kind::kStandardOutput;
    return;
  }
  const bool is_standard_error = exists && !identity_.empty() && identity_ == identity_of_descriptor(STDERR_FILENO);
  const bool as_it_comes = exists && (!S_ISREG(status.st_mode) || is_standard_error || is_descriptor(target_));
  kind_ = as_it_comes ? Kind::kOther : Kind::kRegular;
  if (exists && S_ISDIR(status.st_mode)) refuse("cannot be written: it is a directory");
  if (exists && ::access(target_.c_str(), W_OK) != 0) refuse(fmt::format("cannot be written: {}", strerror(errno)));
  if (kind_ == Kind::kOther) return;
  if (target_.filename().empty()) refuse("cannot be written: it has no file name");
  const fs::path folder = folder_of(target_);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(fmt::format("cannot be written: {}: {}", folder.string(), strerror(errno)));
  }
}

Output::~Output() {
  if (stream_ != nullptr && stream_ != stdout) std::fclose(stream_);
}

void Output::fail() const {
  throw std::runtime_error(fmt::format("{}: could not be written to its end: {}",
                                       kind_ == Kind::kStandardOutput ? "standard output" : name_, strerror(errno)));
}

void Output::open() {
  try {
    if (kind_ == Kind::kRegular)
      staged_ = std::make_unique<TemporaryFile>(folder_of(target_));
    else if (by_name_)
      staged_ = std::make_unique<TemporaryFile>(fs::temp_directory_path());
  } catch (const std::runtime_error& error) {
    throw UsageError(fmt::format("{}: {}", name_, error.what()));
  }
  if (kind_ == Kind::kStandardOutput) {
    stream_ = stdout;
    return;
  }
  const int descriptor = kind_ == Kind::kRegular ? ::fcntl(staged_->descriptor(), F_DUPFD_CLOEXEC, 0)
                                                 : ::open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor >= 0) stream_ = ::fdopen(descriptor, "w");
  if (stream_ == nullptr) throw UsageError(fmt::format("{}: cannot be written: {}", name_, strerror(errno)));
  std::setvbuf(stream_, nullptr, _IOFBF, kBuffer);
}

void Output::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) fail();
}

// Copies output that was written by name to its destination.
void Output::copy_staged() {
  const int from = ::open(staged_->path().c_str(), O_RDONLY | O_CLOEXEC);
  std::array<char, 65536> buffer{};
  ssize_t count = -1;
  while (from >= 0 && (count = ::read(from, buffer.data(), buffer.size())) > 0) {
    write({buffer.data(), static_cast<std::size_t>(count)});
  }
  if (from >= 0) ::close(from);
  if (count < 0) fail();
}

// After this only the renaming can fail.
void Output::finish() {
  if (by_name_ && kind_ != Kind::kRegular) copy_staged();
  std::FILE* const stream = std::exchange(stream_, nullptr);
  if (stream == stdout) {
    finish_standard_streams();
  } else if (std::fclose(stream) != 0) {
    fail();
  }
}

void Output::take_name() {
  if (kind_ != Kind::kRegular) return;
  const char* const from = staged_->path().c_str();
  struct stat status {};
  existed_ = ::lstat(target_.c_str(), &status) == 0;
  if (existed_ && S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    fail();
  }
  const mode_t mask = ::umask(0);
  ::umask(mask);
  // Keeps owner and permissions of the replaced file, as far as this user may set them.
  if (existed_ && ::chown(from, status.st_uid, status.st_gid) != 0 && errno != EPERM) fail();
  if (::chmod(from, existed_ ? status.st_mode & 07777U : 0666U & ~mask) != 0) fail();
  // An exchange keeps the old file until all names are taken. Not every file system supports it.
  const bool exchanged = existed_ && ::renameat2(AT_FDCWD, from, AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0;
  if (!exchanged && ::rename(from, target_.c_str()) != 0) fail();
  named_ = exchanged || !existed_;
}

void Output::give_name_back() noexcept {
  if (!named_) return;
  const char* const staged = staged_->path().c_str();
  if (existed_) {
    ::renameat2(AT_FDCWD, staged, AT_FDCWD, target_.c_str(), RENAME_EXCHANGE);
  } else {
    ::unlink(target_.c_str());
  }
}

Output* Outputs::add(const std::string& option, const std::optional<std::string>& file, bool by_name) {
  if (!file) return nullptr;
  outputs_.push_back(std::unique_ptr<Output>(new Output(option, *file, by_name)));
  standard_output_taken_ |= outputs_.back()->kind_ == Output::Kind::kStandardOutput;
  return outputs_.back().get();
}

void Outputs::keep(const std::string& what, const std::string& file) {
  // A terminal may be both read and written.
  struct stat status {};
  const bool there = file == "-" ? ::fstat(STDIN_FILENO, &status) == 0 : ::stat(file.c_str(), &status) == 0;
  if (there) kept_.push_back({what, identity_of(status, false)});
}

void Outputs::check() const {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = *outputs_[i];
    const bool standard = output.kind_ == Output::Kind::kStandardOutput;
    for (const Kept& kept : kept_) {
      if (!kept.identity.empty() && kept.identity == output.identity_) {
        throw UsageError(
            fmt::format("{} {}: this is {}, which must not be overwritten", output.option_, output.name_, kept.what));
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      const bool both_standard = standard && outputs_[j]->kind_ == Output::Kind::kStandardOutput;
      if (both_standard || (!output.identity_.empty() && output.identity_ == outputs_[j]->identity_)) {
        throw UsageError(fmt::format("{} and {}: both would be written to {}", outputs_[j]->option_, output.option_,
                                     standard ? "standard output" : output.name_));
      }
    }
  }
}

void Outputs::open() {
  for (const auto& output : outputs_) output->open();
}

void Outputs::commit(const std::string& summary) {
  for (const auto& output : outputs_) output->finish();
  finish_standard_streams();  // before the summary, so a failed run prints none
  if (standard_output_taken_)
    to_standard_error(summary);
  else
    to_standard_output(summary);
  finish_standard_streams();
  const SignalsWait wait;
  try {
    for (const auto& output : outputs_) output->take_name();
  } catch (...) {
    for (const auto& output : outputs_) output->give_name_back();
    throw;
  }
}

void Outputs::commit_alone(Output& output) {
  output.finish();
  const SignalsWait wait;
  try {
    output.take_name();
  } catch (...) {
    output.give_name_back();
    throw;
  }
}

}  // namespace trammel::app
