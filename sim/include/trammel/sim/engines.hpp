// Either engine: the Verilated card in lockstep with the golden model, or the model alone. Thread-safety: as of
// Engine; only the calling thread sees steps and exceptions, also where the RTL has a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "trammel/sim/engine.hpp"

namespace trammel::sim {

enum class EngineKind { kRtl, kModel };

struct TraceFile {
  std::string path;        // FST, two time steps a clock
  std::uint64_t from = 0;  // the window, clocks since reset: from <= clock < to
  std::uint64_t to = UINT64_MAX;
};

struct SimulationOptions : EngineOptions {
  EngineKind kind = EngineKind::kRtl;
  std::optional<TraceFile> trace;  // kRtl with 4 or 8 axes only
  std::uint64_t seed = 1;          // named in the report of a mismatch
  bool rtl_thread = false;         // kRtl: the Verilated card in a thread of its own; not with a trace
};

// Throws std::invalid_argument for options out of range. A mismatch throws lockstep::Mismatch out of the call during
// which it was found: an access, a wait, lockstep_cycles() or comparisons(), at most some thousand clocks late. With a
// trace it is found at once. One that is found only when the engine is destroyed ends the process with its report: who
// wants to catch it asks for lockstep_cycles() first.
std::unique_ptr<Engine> make_engine(const SimulationOptions& options);

}  // namespace trammel::sim
