#include "temporary_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "errors.hpp"

namespace trammel::app {
namespace {

// Names for the signal handler to remove: it may call unlink(), but may not access a container.
constexpr std::size_t kMaxNames = 256;
std::array<std::atomic<const char*>, kMaxNames> names{};
static_assert(std::atomic<const char*>::is_always_lock_free);

constexpr std::array<int, 5> kEndingSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGPIPE};

void remember(const std::string& name) {
  for (std::atomic<const char*>& entry : names) {
    if (entry == nullptr) {
      entry = name.c_str();
      return;
    }
  }
  throw std::logic_error("more temporary files than there is room for");
}

void remove_and_forget(const std::string& name) {
  if (!name.empty()) ::unlink(name.c_str());
  for (std::atomic<const char*>& entry : names) {
    if (entry == name.c_str()) entry = nullptr;
  }
}

void unlink_all() {
  for (const std::atomic<const char*>& entry : names) {
    const char* const name = entry;
    if (name != nullptr) ::unlink(name);
  }
}

// The signal's default action was restored on entry (SA_RESETHAND), so that the parent sees the signal that ended the
// process.
extern "C" void remove_all(int signal) {
  unlink_all();
  ::raise(signal);
}

// The waveform's writer maps its files into memory. If the disk is full, no call returns an error; the memory access
// fails with this code.
extern "C" void end_without_room(int signal, siginfo_t* info, void* /*context*/) {
  unlink_all();
  if (info->si_code != BUS_ADRERR) {
    ::raise(signal);
    return;
  }
  constexpr std::string_view kMessage = "trammel: error: --trace: no room for the waveform's files (is a disk full?)\n";
  // If this fails, nothing more can be done.
  [[maybe_unused]] const ssize_t count = ::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  ::_exit(kExitFailure);
}

sigset_t ending_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : kEndingSignals) ::sigaddset(&set, signal);
  return set;
}

}  // namespace

void remove_temporary_files_on_signals() {
  struct sigaction action {};
  action.sa_handler = remove_all;
  action.sa_mask = ending_signals();
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : kEndingSignals) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
  action.sa_sigaction = end_without_room;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_SIGINFO;
  ::sigaction(SIGBUS, &action, nullptr);
  // Makes a file that exceeds its size limit a failed write, which is reported.
  ::signal(SIGXFSZ, SIG_IGN);
}

SignalsWait::SignalsWait() {
  const sigset_t set = ending_signals();
  ::pthread_sigmask(SIG_BLOCK, &set, &before_);
}

SignalsWait::~SignalsWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

TemporaryFile::TemporaryFile(const std::filesystem::path& folder) {
  for (unsigned number = 0; descriptor_ < 0; ++number) {
    path_ = folder / fmt::format(".trammel-{}-{}", ::getpid(), number);
    const SignalsWait wait;
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) {
      throw std::runtime_error(fmt::format("{}: no new file can be made there: {}", folder.string(), strerror(errno)));
    }
    if (descriptor_ < 0) continue;
    beside_ = path_.string() + ".hier";
    remember(path_.native());
    remember(beside_);
  }
}

TemporaryFile::~TemporaryFile() {
  ::close(descriptor_);
  const SignalsWait wait;
  remove_and_forget(path_.native());
  remove_and_forget(beside_);
}

NamelessFile::NamelessFile(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)) {
  if (descriptor_ >= 0) return;
  // Not every file system supports this. On the others the file is created with a name, which is removed at once.
  const TemporaryFile named(folder);
  descriptor_ = ::fcntl(named.descriptor(), F_DUPFD_CLOEXEC, 0);
  if (descriptor_ < 0) throw std::runtime_error(fmt::format("no new file can be opened: {}", strerror(errno)));
}

NamelessFile::~NamelessFile() { ::close(descriptor_); }

}  // namespace trammel::app
