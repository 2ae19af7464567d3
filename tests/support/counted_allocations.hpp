// Counts every allocation of the process: linking counted_allocations.cpp replaces the global operator new. For tests
// of code that must not allocate. The counter is not atomic, so only one thread may run.
#pragma once

#include <cstddef>

namespace trammel::test {

// Number of allocations since the start of the process.
std::size_t allocations();

}  // namespace trammel::test
