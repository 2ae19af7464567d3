// A table of a world file, read key by key; keys that were never read are refused. Internal to the library.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <toml.hpp>
#include <vector>

namespace trammel::world {

// Throws WorldError: "file:line: what", on one line, truncated if it is long.
[[noreturn]] void refuse_at(const std::string& file, std::size_t line, const std::string& what);

struct Bounds {
  double least;
  double most;
  const char* unit;  // "" if the number has no unit
};

class Table {
 public:
  // `path`: path of the table, "axis.x"; empty for the file itself.
  Table(const std::string& file, const std::string& path, const toml::value& value);

  const toml::value* find(const char* key);
  double number(const char* key, const Bounds& bounds, double fallback);
  bool has(const char* key) const { return value_.as_table().count(key) != 0; }
  std::uint64_t whole(const char* key, std::uint64_t most, std::uint64_t fallback);
  bool flag(const char* key, bool fallback);
  // The index of the value in `words`.
  std::size_t word(const char* key, const std::vector<std::string>& words, std::size_t fallback);
  // The inner tables of a table, in the file's order.
  std::vector<Table> tables(const char* key);
  [[noreturn]] void refuse(const std::string& what) const;                   // at the table's line
  [[noreturn]] void refuse(const char* key, const std::string& what) const;  // at the key's line
  void refuse_other_keys() const;

  const std::string& name() const { return name_; }  // last part of its path: "x" of "axis.x"
  const std::string& file() const { return file_; }
  std::size_t line() const { return value_.location().line(); }

 private:
  std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  std::string file_;
  std::string path_;
  std::string name_;
  toml::value value_;
  std::set<std::string> known_;
};

}  // namespace trammel::world
