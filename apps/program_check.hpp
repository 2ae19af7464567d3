// `trammel run --check`: reads, plans and times a program; nothing runs.
#pragma once

#include <string>

#include "profile_report.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {

struct CheckResult {
  run::Plan plan;
  ProfileReport profile;
  std::string axes;                          // letters in the card's order
  std::vector<std::int64_t> final_position;  // pulses by axis of the card
  std::vector<double> final_millimetres;
  bool joint_for_each_axis = true;  // no motor moves two axes
  std::uint32_t clock_hz = 0;
};

// Throws run::ProgramError.
CheckResult check_program(const run::ProgramLines& lines, const machine::Machine& machine,
                          const planner::CardLimits& card, const run::RunSettings& settings);

// Some lines of text, units in every one.
std::string summary(const CheckResult& result);
// What it has in common with a run's result, under the same names.
std::string json_text(const CheckResult& result);

}  // namespace trammel::app
