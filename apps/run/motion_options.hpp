// Options of `trammel run` that correspond to an operator's actions at the machine: overrides, holds, the starting
// line, blocks to skip; and events at the machine's inputs.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "trammel/run/run_settings.hpp"
#include "trammel/simulation/operation.hpp"

namespace trammel::app {

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
  std::vector<std::string> accept;  // G and M words
  bool single_block = false;
  bool run_deleted = false;

  void add_to(CLI::App& command);
  // Throw UsageError for malformed or out-of-range values. `max_percent`: the largest override that the machine's
  // limits allow.
  simulation::Operation operation(double max_percent) const;
  run::RunSettings settings() const;
  // The options that change a program's plan, with their values.
  std::map<std::string, std::string> of_plan() const;
};

// Notes that name the operator's events before which the run ended: those after the first `made` of `events`.
// `seconds`: the length of the run.
std::vector<std::string> late_event_notes(const std::vector<simulation::OperatorEvent>& events, std::size_t made,
                                          double seconds);

}  // namespace trammel::app
