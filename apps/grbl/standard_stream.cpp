#include "standard_stream.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "trammel/driver/errors.hpp"

namespace trammel::app {
namespace {

class StandardStream final : public transport::ByteStream {
 public:
  void write(const std::uint8_t* bytes, std::size_t count) override {
    while (count != 0) {
      const ssize_t taken = ::write(STDOUT_FILENO, bytes, count);
      if (taken < 0 && errno == EINTR) continue;
      if (taken <= 0) throw driver::LinkError("standard output takes no more");
      bytes += taken;
      count -= static_cast<std::size_t>(taken);
    }
  }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(longest).count();
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(wait, 1000))) <= 0) return 0;
    const ssize_t count = ::read(STDIN_FILENO, bytes, room);
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return 0;
    if (count <= 0) throw driver::LinkError("standard input has ended");
    return static_cast<std::size_t>(count);
  }
  std::string peer() const override { return "standard input"; }
};

}  // namespace

std::unique_ptr<transport::ByteStream> standard_stream() { return std::make_unique<StandardStream>(); }

}  // namespace trammel::app
