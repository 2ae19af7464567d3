// Runs the trammel command as a process and reads what it writes. Every object has a directory of its own, removed
// with it. TRAMMEL_BINARY in the environment names another binary than the one that was built.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace trammel::test {

struct Outcome {
  int status = -1;  // of exit; -1: killed by a signal
  std::string out;
  std::string err;
};

// One row of --steps. `cycle` counts clocks of the card.
struct Step {
  std::uint64_t cycle = 0;
  unsigned axis = 0;
  int direction = 0;
};

class Command {
 public:
  Command();
  ~Command();
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  // Arguments as in a shell. Standard input is empty and standard output is a file, unless they say otherwise.
  Outcome run(const std::string& arguments) const;
  // In a folder, with what comes before the command in a shell's line.
  Outcome run_in(const std::string& folder, const std::string& before, const std::string& arguments) const;
  // A file's place in the directory.
  std::string path(const std::string& name) const;
  // Names in the directory but for what the commands printed, in order.
  std::vector<std::string> names() const;
  // Writes a file into the directory and gives its place.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path directory_;
};

// A terminal with a test at its keys.
class PseudoTerminal {
 public:
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& name() const { return name_; }
  void type(const std::string& keys) const;
  // All that was written to it so far.
  const std::string& shown();

 private:
  int keys_ = -1;
  std::string name_;
  std::string shown_;
};

// The command while it runs.
class Running {
 public:
  // Arguments as in a shell; standard error goes to the file `err`, standard output to `out` where one is named.
  Running(const Command& command, const std::string& arguments, const std::string& err, const std::string& out = "");
  // At a terminal, which is its standard input and output.
  Running(const Command& command, const std::string& arguments, const std::string& err, const PseudoTerminal& terminal);
  // Ends it, if it still runs.
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  // What waitpid() tells; none when it still runs after 30 s.
  std::optional<int> wait();

 private:
  // A line of the shell.
  explicit Running(const std::string& line);

  int process_ = -1;
};

// Waits until it holds, 30 s at most; whether it does.
bool eventually(const std::function<bool()>& condition);

// The whole file; empty where there is none.
std::string contents(const std::string& file);

// The JSON of a file; a discarded value where it is none.
nlohmann::json read_json(const std::string& file);

// The rows of --steps. Reports a failure for a wrong header, a malformed row, or cycles out of order.
std::vector<Step> read_steps(const std::string& file);

// Lines of text, counted by their ends.
std::size_t count_lines(const std::string& text);

}  // namespace trammel::test
