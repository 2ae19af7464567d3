#include "command_names.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "common/errors.hpp"

namespace trammel::app {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  // distance[i][j]: between the first i letters of a and the first j of b.
  std::vector<std::vector<std::size_t>> distance(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& best = distance[i][j] = std::max(i, j);
      if (i == 0 || j == 0) continue;
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      best = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1, distance[i - 1][j - 1] + change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) best = std::min(best, distance[i - 2][j - 2] + 1);
    }
  }
  return distance[a.size()][b.size()];
}

namespace {

void check_name(const CLI::App& app, const std::string& name) {
  std::string nearest;
  std::size_t least = 3;  // further away nothing is meant
  for (const CLI::App* subcommand : app.get_subcommands({})) {
    if (subcommand->get_name() == name) return;
    const std::size_t distance = edit_distance(subcommand->get_name(), name);
    if (distance >= least || distance >= subcommand->get_name().size()) continue;
    least = distance;
    nearest = subcommand->get_name();
  }
  const std::string hint = nearest.empty() ? std::string() : fmt::format(": did you mean {}?", nearest);
  throw UsageError(fmt::format("there is no command \"{}\"{} (trammel --help lists them)", name.substr(0, 40), hint));
}

}  // namespace

std::vector<std::string> subcommand_words(const CLI::App& app, std::vector<std::string> words) {
  if (words.empty() || words.front().empty() || words.front().front() == '-') return words;
  if (words.front() == "help") {
    if (words.size() > 2) throw UsageError("help: takes one command");
    words.erase(words.begin());
    words.push_back("--help");
    if (words.size() == 1) return words;
  }
  check_name(app, words.front());
  return words;
}

}  // namespace trammel::app
