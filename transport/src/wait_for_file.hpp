#pragma once

#include <chrono>

namespace trammel::transport {

// Waits until poll() reports `events` or an error, for at most `longest`, rounded up to milliseconds; false if neither
// came.
bool wait_for_file(int file, short events, std::chrono::nanoseconds longest);

}  // namespace trammel::transport
