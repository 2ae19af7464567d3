#include "standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace trammel::app {
namespace {

[[noreturn]] void fail_stream(const char* stream) {
  throw std::runtime_error(fmt::format("{}: could not be written to its end: {}", stream, strerror(errno)));
}

}  // namespace

// A descriptor of O_PATH can be neither read nor written, and a directory cannot be reopened for either through
// /proc/self/fd.
void hold_standard_descriptors() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) == -1) (void)::open("/", O_PATH | O_DIRECTORY);
  }
}

bool standard_input_is_closed() { return (::fcntl(STDIN_FILENO, F_GETFL) & O_PATH) != 0; }

void to_standard_output(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail_stream("standard output");
}

void to_standard_error(std::string_view text) noexcept { (void)std::fwrite(text.data(), 1, text.size(), stderr); }

void finish_standard_streams() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail_stream("standard output");
  // Standard error is not buffered.
  if (std::ferror(stderr) != 0) fail_stream("standard error");
}

}  // namespace trammel::app
