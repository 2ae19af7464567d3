// The terminal at standard input, giving each key at once and showing none.
#pragma once

#include <termios.h>

#include <chrono>
#include <optional>
#include <string>

namespace trammel::app {

// As long as one lives; then the terminal is as it was before. Signals of keys (Ctrl-C, Ctrl-Z) stay as they are.
class KeyTerminal {
 public:
  // Throws std::system_error where standard input is no terminal.
  KeyTerminal();
  ~KeyTerminal();
  KeyTerminal(const KeyTerminal&) = delete;
  KeyTerminal& operator=(const KeyTerminal&) = delete;

  // The bytes that have come, waiting for the first at most so long; empty when none has. None: the terminal is gone.
  std::optional<std::string> read(std::chrono::milliseconds longest) const;

 private:
  termios before_{};
};

}  // namespace trammel::app
