// Continues from the present state in a child process (RTL, model and host); the state of this process does not
// change. So each window of clocks needs the way to it only once.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

namespace trammel::test {

// Returns the text that `work` returns; its exceptions are thrown as std::runtime_error. The child has none of its
// parent's threads.
template <class Work>
std::string in_child(const Work& work) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe to a child process");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    std::string text;
    try {
      text = '+' + work();
    } catch (const std::exception& error) {
      text = std::string("-") + error.what();
    }
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t some = write(ends[1], text.data() + sent, text.size() - sent);
      if (some <= 0) _exit(2);
      sent += static_cast<std::size_t>(some);
    }
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  std::array<char, 4096> some{};
  for (ssize_t got = 0; (got = read(ends[0], some.data(), some.size())) > 0;)
    text.append(some.data(), static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0 || text.empty()) throw std::runtime_error("a child process died");
  if (text[0] == '-') throw std::runtime_error(text.substr(1));
  return text.substr(1);
}

}  // namespace trammel::test
