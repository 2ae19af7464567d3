// Creates either engine: the Verilated card in lockstep with the golden model, or the model alone. Thread-safety as of
// Engine. Only the calling thread sees steps and exceptions, also if the RTL runs in a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "trammel/sim/engine.hpp"

namespace trammel::sim {

enum class EngineKind { kRtl, kModel };

struct TraceFile {
  std::string path;        // FST, two time steps per clock
  std::uint64_t from = 0;  // window of clocks since reset: from <= clock < to
  std::uint64_t to = UINT64_MAX;
};

struct SimulationOptions : EngineOptions {
  EngineKind kind = EngineKind::kRtl;
  std::optional<TraceFile> trace;  // kRtl with 4 or 8 axes only
  std::uint64_t seed = 1;          // seed; the report of a mismatch names it
  bool rtl_thread = false;         // kRtl: the Verilated card runs in a thread of its own; not with a trace
};

// Throws std::invalid_argument for options out of range.
//
// A mismatch throws lockstep::Mismatch out of the call that detects it: an access, a wait, lockstep_cycles() or
// comparisons(), up to some thousand clocks late; with a trace, immediately. A mismatch that is detected only when the
// engine is destroyed ends the process with its report. To catch it, call lockstep_cycles() first.
std::unique_ptr<Engine> make_engine(const SimulationOptions& options);

}  // namespace trammel::sim
