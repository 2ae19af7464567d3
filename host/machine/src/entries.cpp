#include "entries.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "text.hpp"

namespace trammel::machine {

void refuse_key(const Source& source, const toml::value& value, const std::string& table, const std::string& key,
                const std::vector<std::string>& names) {
  const std::string close = nearest(key, names);
  const std::string path = one_line(table + key, kLongestQuote);
  refuse(fmt::format("{}unknown entry {}{}", source.at(value), path,
                     close.empty() ? fmt::format("; known are {}", fmt::join(names, ", "))
                                   : fmt::format("; did you mean {}?", close)));
}

std::string word(const Source& source, const std::string& path, const toml::value& value,
                 const std::vector<std::string>& words) {
  if (!value.is_string() || std::find(words.begin(), words.end(), value.as_string().str) == words.end()) {
    refuse(fmt::format("{}{} must be \"{}\"", source.at(value), path, fmt::join(words, "\" or \"")));
  }
  return value.as_string().str;
}

bool true_or_false(const Source& source, const std::string& path, const toml::value& value) {
  if (!value.is_boolean()) refuse(source.at(value) + path + " must be true or false");
  return value.as_boolean();
}

}  // namespace trammel::machine
