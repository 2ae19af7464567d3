#include "progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "standard_streams.hpp"
#include "terminal.hpp"

namespace trammel::app {
std::string duration_text(double seconds) {
  if (seconds < 99.5) return fmt::format("{:.0f} s", std::max(1.0, std::ceil(seconds)));
  if (seconds < 99.5 * 60) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.0f} h", seconds / 3600);
}

ProgressBar::ProgressBar(bool always) : bar_(has_escapes(STDERR_FILENO)), lines_(always && !bar_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) to_standard_error("\r\033[K");
}

void ProgressBar::show(double done, const std::string& note) {
  const Clock::time_point now = Clock::now();
  if (!(bar_ || lines_) || now - last_ < (bar_ ? std::chrono::milliseconds(100) : std::chrono::seconds(10))) return;
  last_ = now;
  done = std::clamp(done, 0.0, 1.0);
  const double elapsed = std::chrono::duration<double>(now - begun_).count();
  // The first second does not predict the rest.
  const std::string left =
      elapsed > 1 && done > 0 ? fmt::format(", {} left", duration_text(elapsed * (1 - done) / done)) : std::string();
  if (lines_) {
    to_standard_error(fmt::format("{:3.0f} %  {}{}\n", 100 * done, note, left));
    return;
  }
  drawn_ = true;
  constexpr std::size_t kWidth = 20;  // keeps the line within 80 columns
  const auto full = static_cast<std::size_t>(done * kWidth);
  to_standard_error(fmt::format("\r\033[K[{}{}] {:3.0f} %  {}{}", std::string(full, '#'),
                                std::string(kWidth - full, '.'), 100 * done, note, left));
}

}  // namespace trammel::app
