// Options of `trammel run` that an operator has at the machine: overrides, holds, where to begin, what to leave out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "trammel/run/run_settings.hpp"

namespace trammel::app {

// What the operator does at a time of the card's.
struct OperatorEvent {
  enum class Kind { kOverride, kHold, kResume };
  Kind kind = Kind::kOverride;
  double seconds = 0;  // of card time, asked for
  double percent = 0;  // kOverride
};

// How the operator and the bus treat the run.
struct Operation {
  double percent = 100;               // override from the start on
  std::vector<OperatorEvent> events;  // in order of time
  double bytes_per_second = 0;        // of the bus, infinite without a limit
};

struct MotionChoice {
  std::string percent = "100";
  std::vector<std::string> override_at;  // SECONDS:PERCENT
  std::vector<std::string> hold_at;      // SECONDS:DURATION
  double feed_scale = 1;
  std::optional<double> bytes_per_second;
  std::size_t first_line = 1;
  std::string arcs = "generator";
  std::optional<std::string> profile;
  bool single_block = false;
  bool run_deleted = false;

  void add_to(CLI::App& command);
  // Throw UsageError for what is malformed or out of range. `most_percent`: the largest override that the machine's
  // limits leave room for.
  Operation operation(double most_percent) const;
  run::RunSettings settings() const;
};

}  // namespace trammel::app
