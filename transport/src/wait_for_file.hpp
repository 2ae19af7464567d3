#pragma once

#include <chrono>

namespace trammel::transport {

// Until poll() tells of `events` or of an error, at most `longest`, rounded up to milliseconds; false for neither.
bool wait_for_file(int file, short events, std::chrono::nanoseconds longest);

}  // namespace trammel::transport
