// A run's result for people and for programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "program_run.hpp"

namespace trammel::app {

// A line a cause for which feeds are not reached.
std::vector<std::string> feed_warnings(const run::Plan& plan);

// Some lines of text, units in every one.
std::string summary(const RunResult& result);

nlohmann::ordered_json json_of(const RunResult& result);

}  // namespace trammel::app
