// `trammel run --check`: reads, plans and times a program; nothing runs.
#pragma once

#include <string>

#include "trammel/machine/machine.hpp"
#include "trammel/run/end_position.hpp"
#include "trammel/run/planned_profile.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::app {

struct CheckResult {
  run::Plan plan;
  run::PlannedProfile profile;
  run::EndPosition end;
  std::uint32_t clock_hz = 0;
};

// Throws run::ProgramError.
CheckResult check_program(const run::ProgramLines& lines, const machine::Machine& machine,
                          const planner::CardLimits& card, const run::RunSettings& settings);

// Some lines of text, units in every one.
std::string summary(const CheckResult& result);
// The results that are also in a run's JSON, with the same names.
std::string json_text(const CheckResult& result);

}  // namespace trammel::app
