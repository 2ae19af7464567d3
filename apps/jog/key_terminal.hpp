// The terminal at standard input, set to return each key at once without echo.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>

namespace trammel::app {

// The setting lasts for the lifetime of the object; then the terminal is as before. Signal keys (Ctrl-C, Ctrl-Z) keep
// their effect.
class KeyTerminal {
 public:
  // Throws std::system_error if standard input is not a terminal.
  KeyTerminal();
  ~KeyTerminal();
  KeyTerminal(const KeyTerminal&) = delete;
  KeyTerminal& operator=(const KeyTerminal&) = delete;

  // The received bytes. Waits for the first one for at most `longest`; empty if there is none. None: the terminal is
  // disconnected.
  std::optional<std::string> read(std::chrono::milliseconds longest) const;

 private:
  termios before_{};
};

}  // namespace trammel::app
