// The cost of a move for the host.
//
// - host operations: the second paper's count (Zeng, Zhang & Huang, section 4.3, Fig. 5): one for each time that the
//   method has to compute during the curve; 1 if it computes once before the curve. A point-by-point method computes
//   once per step (a diagonal step is one); a digital differential analyser once per iteration, whether it overflows
//   or not.
// - register writes: a method that computes step by step writes the step bits of all axes at each time with a step; a
//   method that computes once writes one block of words.
// Pure functions: thread-safe.
#pragma once

#include <cstdint>

#include "trammel/measure/trace.hpp"

namespace trammel::measure {

struct HostCost {
  std::uint64_t operations = 0;
  std::uint64_t register_writes = 0;
};

inline HostCost cost_of_every_step(const Trace& trace) { return {trace.events().size(), trace.events().size()}; }

// One operation per time unit (iteration).
inline HostCost cost_of_every_iteration(const Trace& trace) { return {trace.total_time(), trace.events().size()}; }

// `words`: length of the block, in words of 32 bits.
inline HostCost cost_of_one_shot(std::uint64_t words) { return {1, words}; }

}  // namespace trammel::measure
