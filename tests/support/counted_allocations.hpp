// Counts every allocation of the process: linking counted_allocations.cpp replaces the global operator new. For a test
// of code that must allocate nothing, on one thread.
#pragma once

#include <cstddef>

namespace trammel::test {

// Since the start of the process.
std::size_t allocations();

}  // namespace trammel::test
