#include "command_names.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "common/errors.hpp"

namespace trammel::app {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  // distance[i][j]: distance between the first i letters of a and the first j of b.
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

constexpr std::size_t kQuoted = 40;  // longest part of a word that a message repeats, characters

// ": did you mean X?", or empty if no name is similar.
std::string hint_at_nearest(const std::vector<std::string>& names, const std::string& word) {
  std::string nearest;
  std::size_t least = 3;  // a larger distance is not a misspelling
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(name, word);
    if (distance >= least || distance >= name.size()) continue;
    least = distance;
    nearest = name;
  }
  return nearest.empty() ? std::string() : fmt::format(": did you mean {}?", nearest);
}

void check_name(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands({})) {
    if (subcommand->get_name() == name) return;
    names.push_back(subcommand->get_name());
  }
  throw UsageError(fmt::format("there is no command \"{}\"{} (trammel --help lists them)", name.substr(0, kQuoted),
                               hint_at_nearest(names, name)));
}

}  // namespace

std::vector<std::string> subcommand_words(const CLI::App& app, std::vector<std::string> words) {
  if (words.empty() || words.front().empty() || words.front().front() == '-') return words;
  if (words.front() == "help") {
    if (words.size() > 2) throw UsageError("help: takes one command");
    words.erase(words.begin());
    if (!words.empty() && words.front() == "help") words.clear();
    words.push_back("--help");
    if (words.size() == 1) return words;
  }
  check_name(app, words.front());
  return words;
}

std::optional<std::string> unknown_option_text(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (chosen.empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const CLI::Option* option : chosen.front()->get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const std::string& whole : words) {
    const std::string word = whole.substr(0, whole.find('='));
    if (word.rfind("--", 0) != 0 || std::find(names.begin(), names.end(), word) != names.end()) continue;
    return fmt::format("trammel {} has no option {}{}", chosen.front()->get_name(), word.substr(0, kQuoted),
                       hint_at_nearest(names, word));
  }
  return std::nullopt;
}

}  // namespace trammel::app
