#include "table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "trammel/world/world_file.hpp"

namespace trammel::world {

void refuse_at(const std::string& file, std::size_t line, const std::string& what) {
  constexpr std::size_t kLongest = 500;
  std::string text = fmt::format("{}:{}: {}", file, line, what);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  throw WorldError(text);
}

Table::Table(const std::string& file, const std::string& path, const toml::value& value)
    : file_(file), path_(path), name_(path.substr(path.rfind('.') + 1)), value_(value) {
  if (!value.is_table()) refuse_at(file, value.location().line(), path + " must be a table");
}

const toml::value* Table::find(const char* key) {
  known_.insert(key);
  const auto found = value_.as_table().find(key);
  return found == value_.as_table().end() ? nullptr : &found->second;
}

double Table::number(const char* key, const Bounds& bounds, double fallback) {
  const toml::value* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_integer() && !value->is_floating()) refuse(key, "must be a number");
  const double result = value->is_integer() ? static_cast<double>(value->as_integer()) : value->as_floating();
  if (!(result >= bounds.least) || result > bounds.most) {
    refuse(key, fmt::format("must be from {:g} to {:g}{}{}, not {:g}", bounds.least, bounds.most,
                            *bounds.unit == '\0' ? "" : " ", bounds.unit, result));
  }
  return result;
}

std::uint64_t Table::whole(const char* key, std::uint64_t most, std::uint64_t fallback) {
  const toml::value* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_integer() || value->as_integer() < 0 || static_cast<std::uint64_t>(value->as_integer()) > most) {
    refuse(key, fmt::format("must be a whole number, 0 to {}", most));
  }
  return static_cast<std::uint64_t>(value->as_integer());
}

bool Table::flag(const char* key, bool fallback) {
  const toml::value* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_boolean()) refuse(key, "must be true or false");
  return value->as_boolean();
}

std::size_t Table::word(const char* key, const std::vector<std::string>& words, std::size_t fallback) {
  const toml::value* value = find(key);
  if (value == nullptr) return fallback;
  const auto found = value->is_string() ? std::find(words.begin(), words.end(), value->as_string().str) : words.end();
  if (found == words.end()) refuse(key, fmt::format("must be \"{}\"", fmt::join(words, "\" or \"")));
  return static_cast<std::size_t>(found - words.begin());
}

std::vector<Table> Table::tables(const char* key) {
  std::vector<Table> result;
  const toml::value* value = find(key);
  if (value == nullptr) return result;
  const Table outer(file_, full(key), *value);
  for (const auto& [name, inner] : value->as_table()) result.emplace_back(file_, outer.full(name), inner);
  // Sorts by line, because toml11's table does not keep the file's order.
  std::sort(result.begin(), result.end(), [](const Table& a, const Table& b) { return a.line() < b.line(); });
  return result;
}

void Table::refuse(const std::string& what) const { refuse_at(file_, line(), path_ + " " + what); }

void Table::refuse(const char* key, const std::string& what) const {
  refuse_at(file_, value_.as_table().at(key).location().line(), full(key) + " " + what);
}

void Table::refuse_other_keys() const {
  for (const auto& [key, value] : value_.as_table()) {
    if (known_.count(key) != 0) continue;
    refuse_at(file_, value.location().line(),
              fmt::format("unknown entry {}; known here: {}", full(key), fmt::join(known_, ", ")));
  }
}

}  // namespace trammel::world
