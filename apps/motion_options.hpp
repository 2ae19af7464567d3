// Options of `trammel run` that an operator has at the machine: overrides, holds, where to begin, what to leave out;
// and what the machine's inputs do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "trammel/run/run_settings.hpp"

namespace trammel::app {

// What the operator, or the machine, does at a time of the card's.
struct OperatorEvent {
  enum class Kind { kOverride, kHold, kResume, kInput };
  Kind kind = Kind::kOverride;
  double seconds = 0;  // of card time, asked for
  double percent = 0;  // kOverride
  unsigned input = 0;  // kInput
  bool level = false;
};

// How the operator and the bus treat the run.
struct Operation {
  double percent = 100;               // override from the start on
  double rapid_percent = 100;         // of rapids
  std::vector<OperatorEvent> events;  // in order of time
  double bytes_per_second = 0;        // of the bus, infinite without a limit
};

struct MotionChoice {
  std::string percent = "100";
  std::vector<std::string> override_at;  // SECONDS:PERCENT
  std::vector<std::string> hold_at;      // SECONDS:DURATION
  std::vector<std::string> input_at;     // SECONDS:INPUT:LEVEL
  std::string rapid_percent = "100";
  double feed_scale = 1;
  std::optional<double> bytes_per_second;
  std::size_t first_line = 1;
  std::string arcs = "generator";
  std::optional<std::string> profile;
  std::vector<std::string> accept;  // M words
  bool single_block = false;
  bool run_deleted = false;

  void add_to(CLI::App& command);
  // Throw UsageError for what is malformed or out of range. `most_percent`: the largest override that the machine's
  // limits leave room for.
  Operation operation(double most_percent) const;
  run::RunSettings settings() const;
};

}  // namespace trammel::app
