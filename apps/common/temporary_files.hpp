// Files that must not outlive the process: removed with their objects, and where Ctrl-C, a hang-up, a termination or a
// closed pipe ends the process. SIGKILL leaves a file that has a name. Not thread-safe; signals may come at any time.
#pragma once

#include <signal.h>

#include <filesystem>
#include <string>

namespace trammel::app {

// Call once, before the first temporary file. A disk that is full under a mapped file ends the process with a message
// and kExitFailure. Signals that the parent has the process ignore (nohup) stay ignored.
void remove_temporary_files_on_signals();

// While one lives, signals that end the process wait.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_;
};

// An empty file with a name of its own.
class TemporaryFile {
 public:
  // Made in `folder`. Throws std::runtime_error, which says why, when it cannot be.
  explicit TemporaryFile(const std::filesystem::path& folder);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Open for reading and writing; closed with the object.
  int descriptor() const { return descriptor_; }

 private:
  std::filesystem::path path_;
  std::string beside_;  // what the waveform's writer keeps beside its file until it closes it
  int descriptor_ = -1;
};

// An empty file without a name: it goes with the process, however that ends.
class NamelessFile {
 public:
  // On the file system of `folder`. Throws std::runtime_error, which says why, when it cannot be made.
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
