// Shows progress on stderr: a bar on a terminal; elsewhere nothing, or plain lines at intervals if requested. Not
// thread-safe.
#pragma once

#include <chrono>
#include <string>

namespace trammel::app {

class ProgressBar {
 public:
  // `always`: print lines if stderr is not a terminal.
  explicit ProgressBar(bool always);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `done`: 0 to 1; `note` is printed after it. A bar is redrawn at most ten times per second; a line is written at
  // most every ten seconds.
  void show(double done, const std::string& note);

 private:
  using Clock = std::chrono::steady_clock;
  bool bar_;
  bool lines_;
  bool drawn_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point last_{};
};

// A rounded duration: "12 s", "4 min", "3 h".
std::string duration_text(double seconds);

}  // namespace trammel::app
