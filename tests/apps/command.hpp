// Runs the trammel command as a process and reads its output. Each object has its own directory, which is removed with
// it. The environment variable TRAMMEL_BINARY names another binary instead of the one that was built.
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
  int status = -1;  // exit status; -1: killed by a signal
  std::string out;
  std::string err;
};

// A row of --steps. `cycle` counts clocks of the card.
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

  // Runs the command with arguments as in a shell. Standard input is empty and standard output is a file, unless the
  // arguments redirect them.
  Outcome run(const std::string& arguments) const;
  // The same in `folder`; `before` is shell text in front of the command.
  Outcome run_in(const std::string& folder, const std::string& before, const std::string& arguments) const;
  // Path of a file in the directory.
  std::string path(const std::string& name) const;
  // Names in the directory in order, without those of the files that captured the command's output.
  std::vector<std::string> names() const;
  // Writes a file into the directory and returns its path.
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path directory_;
};

// A terminal whose keys the test types.
class PseudoTerminal {
 public:
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& name() const { return name_; }
  void type(const std::string& keys) const;
  // All that was written to the terminal so far.
  const std::string& shown();

 private:
  int keys_ = -1;
  std::string name_;
  std::string shown_;
};

// The command as a process that runs in the background.
class Running {
 public:
  // Arguments as in a shell. Standard error goes to the file `err`; standard output goes to `out` unless that is empty.
  Running(const Command& command, const std::string& arguments, const std::string& err, const std::string& out = "");
  // Runs on a terminal, which is its standard input and output.
  Running(const Command& command, const std::string& arguments, const std::string& err, const PseudoTerminal& terminal);
  // Ends the process if it still runs.
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  // Status of waitpid(); nothing if the process still runs after 30 s.
  std::optional<int> wait();

 private:
  // Runs a shell line.
  explicit Running(const std::string& line);

  int process_ = -1;
};

// Waits until `condition` holds, at most 30 s. Returns whether it holds.
bool eventually(const std::function<bool()>& condition);

// Contents of a file; empty if it does not exist.
std::string contents(const std::string& file);

// JSON of a file; a discarded value if it is not valid.
nlohmann::json read_json(const std::string& file);

// The rows of --steps. Reports a failure for a wrong header, a malformed row, or cycles out of order.
std::vector<Step> read_steps(const std::string& file);

// Number of line ends in a text.
std::size_t count_lines(const std::string& text);

}  // namespace trammel::test
