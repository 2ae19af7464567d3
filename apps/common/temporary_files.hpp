// Files that must not outlive the process. They are removed with their objects, and when Ctrl-C, a hang-up, a
// termination or a closed pipe ends the process. SIGKILL leaves a file that has a name. Not thread-safe; signals may
// arrive at any time.
#pragma once

#include <signal.h>

#include <filesystem>
#include <string>

namespace trammel::app {

// Call once, before the first temporary file. A full disk under a memory-mapped file ends the process with a message
// and kExitFailure. Signals that the parent has set to ignored (nohup) stay ignored.
void remove_temporary_files_on_signals();

// While an object exists, signals that end the process are deferred.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_;
};

// An empty file with a unique name.
class TemporaryFile {
 public:
  // Creates the file in `folder`. Throws std::runtime_error with the reason if that fails.
  explicit TemporaryFile(const std::filesystem::path& folder);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Open for reading and writing; closed with the object.
  int descriptor() const { return descriptor_; }

 private:
  std::filesystem::path path_;
  std::string beside_;  // the file that the waveform's writer keeps next to its output until it closes that
  int descriptor_ = -1;
};

// An empty file without a name: it disappears with the process, however the process ends.
class NamelessFile {
 public:
  // Creates the file on the file system of `folder`. Throws std::runtime_error with the reason if that fails.
  explicit NamelessFile(const std::filesystem::path& folder);
  ~NamelessFile();
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  // Open for reading and writing; closed with the object.
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace trammel::app
