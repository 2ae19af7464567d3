#include "key_terminal.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>

namespace trammel::app {

KeyTerminal::KeyTerminal() {
  termios keys{};
  if (::tcgetattr(STDIN_FILENO, &before_) != 0) throw std::system_error(errno, std::generic_category(), "terminal");
  keys = before_;
  keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  keys.c_cc[VMIN] = 0;
  keys.c_cc[VTIME] = 0;
  if (::tcsetattr(STDIN_FILENO, TCSAFLUSH, &keys) != 0) {
    throw std::system_error(errno, std::generic_category(), "terminal");
  }
}

KeyTerminal::~KeyTerminal() { ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_); }

std::optional<std::string> KeyTerminal::read(std::chrono::milliseconds longest) const {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  // A signal ends the wait, so that the caller can handle it.
  if (::poll(&input, 1, static_cast<int>(longest.count())) <= 0) return std::string();
  std::array<char, 256> bytes{};
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count < 0 && errno == EINTR) return std::string();
  if (count <= 0) return std::nullopt;
  return std::string(bytes.data(), static_cast<std::size_t>(count));
}

}  // namespace trammel::app
