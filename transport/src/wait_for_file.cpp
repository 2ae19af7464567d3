#include "wait_for_file.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>

namespace trammel::transport {

bool wait_for_file(int file, short events, std::chrono::nanoseconds longest) {
  using std::chrono::milliseconds;
  const auto until = std::chrono::steady_clock::now() + longest;
  for (auto left = longest;; left = until - std::chrono::steady_clock::now()) {
    left = std::max(left, std::chrono::nanoseconds(0));
    pollfd entry{file, events, 0};
    const auto whole = std::chrono::ceil<milliseconds>(std::min<std::chrono::nanoseconds>(left, std::chrono::hours(1)));
    const int ready = ::poll(&entry, 1, static_cast<int>(whole.count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return true;  // the following call on the file reports the error
    if (left.count() == 0) return false;
  }
}

}  // namespace trammel::transport
