// A progress bar on stderr; silent unless stderr is a terminal or `always` is asked for. Not thread-safe.
#pragma once

#include <chrono>
#include <string>

namespace trammel::app {

class ProgressBar {
 public:
  explicit ProgressBar(bool always);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `done` from 0 to 1; `note` stands after the bar. Redraws at most ten times a second.
  void show(double done, const std::string& note);

 private:
  bool on_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace trammel::app
