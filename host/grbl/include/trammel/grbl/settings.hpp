// Grbl's settings $0 to $132, on top of a machine file: the file gives the defaults, and a sender's changes modify the
// machine (docs/user/grbl.md lists them). Changes are kept in a file, with startup lines and offsets. Not thread-safe.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trammel/grbl/numbers.hpp"
#include "trammel/machine/machine.hpp"

namespace trammel::grbl {

class Settings {
 public:
  // `file`: keeps the changes; empty: they are not kept. A missing file counts as empty. Throws std::runtime_error for
  // a file that cannot be read or contains lines that are not settings.
  Settings(const machine::Machine& machine, std::string file);

  // The machine with the present settings.
  const machine::Machine& machine() const { return machine_; }
  double value(int number) const;
  bool flag(int number) const { return value(number) != 0; }
  // Lines of $$, "$0=10".
  std::vector<std::string> lines() const;
  // Returns kInvalidStatement for a number that Grbl lacks, and Grbl's error for a value that it refuses.
  Status set(int number, double value);
  // Whether a change of this setting may change machine().
  static bool changes_machine(int number);

  const std::string& startup(std::size_t n) const { return startup_.at(n); }
  void set_startup(std::size_t n, const std::string& line);
  const std::map<int, double>& parameters() const { return parameters_; }
  void set_parameters(const std::map<int, double>& parameters);
  // The text of $I.
  const std::string& build_text() const { return build_text_; }
  void set_build_text(const std::string& text);

  // The reason why the last change will be lost at the end of the process: the file could not be written. Empty: the
  // change is kept.
  std::string take_trouble() { return std::exchange(trouble_, {}); }

  // $RST=$: restores the machine file's values.
  void restore();

  static constexpr std::size_t kStartupLines = 2;

 private:
  void read();
  bool read_line(const std::string& line);
  void write();
  void apply();
  std::string text_of(int number) const;

  machine::Machine base_;
  machine::Machine machine_;
  std::string file_;
  std::map<int, double> defaults_;
  std::map<int, double> changed_;
  std::map<int, double> parameters_;
  std::array<std::string, kStartupLines> startup_;
  std::string build_text_;
  std::string trouble_;
};

}  // namespace trammel::grbl
