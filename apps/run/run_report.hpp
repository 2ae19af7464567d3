// The result of a run, for people and for programs.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "trammel/run/planned_profile.hpp"
#include "trammel/simulation/simulated_run.hpp"

namespace trammel::app {

// A line per cause of feeds that are not reached, and one if dwell times may be meant in milliseconds.
std::vector<std::string> plan_warnings(const run::Plan& plan);

// Some lines of text, units in every one.
std::string run_summary(const simulation::RunResult& result, const run::PlannedProfile& profile);

// "1 command", "2 commands".
std::string counted(std::uint64_t count, std::string_view noun);

// The probes in the first pass: empty, or one line.
std::string probes_planned(const run::Plan& plan);
// Words of the program without effect, by reason, one line each.
std::string accepted_words(const std::map<std::string, std::size_t>& words);
// The effect of G64 P; empty if no corner uses it.
std::string blends_text(const run::Blends& blends);
// The results of probes.
std::string probes_text(const std::string& axes, const std::vector<run::ProbeMade>& probes);
nlohmann::ordered_json probes_json(const std::string& axes, const std::vector<run::ProbeMade>& probes);
nlohmann::ordered_json blends_json(const run::Blends& blends);
nlohmann::ordered_json motion_json(const run::PlannedMotion& motion);
nlohmann::ordered_json feeds_json(const std::vector<run::FeedNotReached>& feeds);

// `world`: the simulated machine behind the pins; null without one.
std::string json_text(const simulation::RunResult& result, const run::PlannedProfile& profile,
                      const nlohmann::ordered_json& world);
// The same, plus the additional data of a run's page, in one line; `surroundings`: members to add.
std::string report_json(const simulation::RunResult& result, const run::PlannedProfile& profile,
                        const nlohmann::ordered_json& surroundings);

}  // namespace trammel::app
