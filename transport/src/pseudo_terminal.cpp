#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/inotify.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "trammel/driver/errors.hpp"
#include "trammel/transport/byte_stream.hpp"
#include "wait_for_file.hpp"

namespace trammel::transport {
namespace {

// The server side of a terminal.
class Master {
 public:
  Master() : file_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)) {
    char name[128];
    if (file_ < 0 || ::grantpt(file_) != 0 || ::unlockpt(file_) != 0 || ::ptsname_r(file_, name, sizeof(name)) != 0) {
      fail();
    }
    name_ = name;
    // Sets raw mode before any client does. The client end is closed again, because an open one would count as a
    // client.
    const int client = ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios settings{};
    const bool raw = client >= 0 && ::tcgetattr(client, &settings) == 0 &&
                     (::cfmakeraw(&settings), ::tcsetattr(client, TCSANOW, &settings) == 0);
    if (client >= 0) ::close(client);
    if (!raw) fail();
    watch_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    if (watch_ < 0 || ::inotify_add_watch(watch_, name, IN_OPEN | IN_CLOSE) < 0) fail();
  }
  ~Master() {
    if (watch_ >= 0) ::close(watch_);
    if (file_ >= 0) ::close(file_);
  }
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  int file() const { return file_; }
  const std::string& name() const { return name_; }
  // Starts the count of opens and closes of the terminal for a new client.
  void begin_client() {
    clients_ = 0;
    all_have_closed();
    clients_ = std::max(clients_, 1);
  }
  // Whether, since the last call, the terminal was closed by all clients at some time. A hang-up would not show this if
  // the next client opened the terminal before the server polled it; the order of opens and closes does. inotify may
  // merge several opens or closes in a row into one event.
  bool all_have_closed() {
    alignas(inotify_event) char events[4096];
    bool closed = false;
    for (ssize_t count = 0; (count = ::read(watch_, events, sizeof(events))) > 0;) {
      for (ssize_t at = 0; at < count;) {
        const auto* event = reinterpret_cast<const inotify_event*>(events + at);
        clients_ += (event->mask & IN_OPEN) != 0 ? 1 : (event->mask & IN_CLOSE) != 0 ? -1 : 0;
        closed = closed || clients_ <= 0 || (event->mask & IN_Q_OVERFLOW) != 0;
        clients_ = std::max(clients_, 0);
        at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      }
    }
    return closed;
  }
  // Whether a client has the other end open, or has left bytes.
  bool has_client() const {
    pollfd entry{file_, POLLIN, 0};
    return ::poll(&entry, 1, 0) == 0 || (entry.revents & POLLHUP) == 0 || (entry.revents & POLLIN) != 0;
  }

 private:
  [[noreturn]] static void fail() {
    throw driver::LinkError(fmt::format("no pseudo-terminal: {}", std::strerror(errno)));
  }

  int file_;
  int watch_ = -1;   // inotify: opens and closes of the terminal
  int clients_ = 0;  // clients that have the terminal open
  std::string name_;
};

class TerminalStream final : public ByteStream {
 public:
  explicit TerminalStream(std::shared_ptr<Master> master) : master_(std::move(master)) { master_->begin_client(); }

  void write(const std::uint8_t* bytes, std::size_t count) override {
    while (count != 0) {
      const bool takes = wait_for_file(master_->file(), POLLOUT, std::chrono::seconds(1));
      const ssize_t written = takes ? ::write(master_->file(), bytes, count) : 0;
      if (!takes || (written < 0 && errno != EAGAIN && errno != EINTR)) {
        throw driver::LinkError(fmt::format("{}: the other end takes no more bytes", peer()));
      }
      if (written < 0) continue;
      bytes += written;
      count -= static_cast<std::size_t>(written);
    }
  }
  std::size_t read(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    if (!wait_for_file(master_->file(), POLLIN, longest)) return 0;
    const ssize_t count = ::read(master_->file(), bytes, room);
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    throw driver::LinkError(fmt::format("{}: the other end has closed", peer()));
  }
  std::string peer() const override { return master_->name(); }
  bool changed_hands() override { return master_->all_have_closed(); }

 private:
  std::shared_ptr<Master> master_;
};

class Terminal final : public Listener {
 public:
  std::unique_ptr<ByteStream> accept() override {
    // One client at a time: the previous stream no longer exists once the server has closed it.
    if (master_.use_count() != 1 || !master_->has_client()) return nullptr;
    return std::make_unique<TerminalStream>(master_);
  }
  bool ends_streams() const override { return false; }
  std::string url() const override { return "serial:" + master_->name(); }

 private:
  std::shared_ptr<Master> master_ = std::make_shared<Master>();
};

}  // namespace

std::unique_ptr<Listener> open_pseudo_terminal() { return std::make_unique<Terminal>(); }

}  // namespace trammel::transport
