// Grbl's settings $0 to $132 over a machine file: the file gives the defaults, what a sender writes changes the machine
// (docs/user/grbl.md lists which). Kept in a file with startup lines and offsets. Not thread-safe.
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
  // `file`: where what was changed is kept; empty: nowhere. A file that is missing is an empty one. Throws
  // std::runtime_error for one that cannot be read or has lines that are no settings.
  Settings(const machine::Machine& machine, std::string file);

  // The machine with the settings in force.
  const machine::Machine& machine() const { return machine_; }
  double value(int number) const;
  bool flag(int number) const { return value(number) != 0; }
  // Lines of $$, "$0=10".
  std::vector<std::string> lines() const;
  // kInvalidStatement for a number that Grbl lacks, else Grbl's reason for a value that it refuses.
  Status set(int number, double value);
  // Whether a change of it may change machine().
  static bool changes_machine(int number);

  const std::string& startup(std::size_t n) const { return startup_.at(n); }
  void set_startup(std::size_t n, const std::string& line);
  const std::map<int, double>& parameters() const { return parameters_; }
  void set_parameters(const std::map<int, double>& parameters);
  // $I's text.
  const std::string& build_text() const { return build_text_; }
  void set_build_text(const std::string& text);

  // Why what was changed last holds until the end alone: the file could not be written. Empty: it is kept.
  std::string take_trouble() { return std::exchange(trouble_, {}); }

  // $RST=$: the machine file's again.
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
