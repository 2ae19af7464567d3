// How far the work is, on stderr: a bar on a terminal; elsewhere nothing, or, when asked for, plain lines now and then.
// Not thread-safe.
#pragma once

#include <chrono>
#include <string>

namespace trammel::app {

class ProgressBar {
 public:
  // `always`: lines where stderr is no terminal.
  explicit ProgressBar(bool always);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `done` from 0 to 1; `note` stands after it. A bar is redrawn at most ten times a second, a line written at most
  // every ten seconds.
  void show(double done, const std::string& note);

 private:
  using Clock = std::chrono::steady_clock;
  bool bar_;
  bool lines_;
  bool drawn_ = false;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point last_{};
};

// As a person says it: "12 s", "4 min", "3 h".
std::string duration_text(double seconds);

}  // namespace trammel::app
