#include "command.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace trammel::test {

Command::Command() {
  std::string pattern = (std::filesystem::temp_directory_path() / "trammel-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary directory");
  directory_ = pattern;
}

Command::~Command() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

namespace {

std::string binary() {
  const char* other = std::getenv("TRAMMEL_BINARY");
  return other != nullptr ? other : TRAMMEL_COMMAND;
}

// The user's own machine file must not change the results, and nothing may remain in the user's folders.
std::string environment(const Command& command) {
  return "export XDG_CONFIG_HOME='" + command.path("configuration") + "' XDG_STATE_HOME='" + command.path("state") +
         "'\n";
}

}  // namespace

Outcome Command::run(const std::string& arguments) const { return run_in(".", "", arguments); }

Outcome Command::run_in(const std::string& folder, const std::string& before, const std::string& arguments) const {
  // Process substitution needs bash. Redirections in the arguments come last and override the earlier ones.
  const std::string script = environment(*this) + "cd '" + folder + "' && " + before + " '" + binary() +
                             "' </dev/null >'" + path("stdout") + "' 2>'" + path("stderr") + "' " + arguments + "\n";
  const std::string file = path("script");
  std::ofstream(file) << script;
  const int status = std::system(("bash '" + file + "'").c_str());
  Outcome outcome;
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  outcome.out = contents(path("stdout"));
  outcome.err = contents(path("stderr"));
  return outcome;
}

PseudoTerminal::PseudoTerminal() : keys_(::posix_openpt(O_RDWR | O_NOCTTY)) {
  if (keys_ < 0 || ::grantpt(keys_) != 0 || ::unlockpt(keys_) != 0) throw std::runtime_error("no pseudo-terminal");
  name_ = ::ptsname(keys_);
  ::fcntl(keys_, F_SETFL, O_NONBLOCK);
}

PseudoTerminal::~PseudoTerminal() { ::close(keys_); }

void PseudoTerminal::type(const std::string& keys) const {
  EXPECT_EQ(::write(keys_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
}

const std::string& PseudoTerminal::shown() {
  std::array<char, 4096> bytes{};
  for (ssize_t count = 0; (count = ::read(keys_, bytes.data(), bytes.size())) > 0;) {
    shown_.append(bytes.data(), static_cast<std::size_t>(count));
  }
  return shown_;
}

Running::Running(const std::string& line) : process_(::fork()) {
  if (process_ != 0) return;
  ::execl("/bin/bash", "bash", "-c", line.c_str(), nullptr);
  ::_exit(127);
}

Running::Running(const Command& command, const std::string& arguments, const std::string& err, const std::string& out)
    : Running(environment(command) + "exec '" + binary() + "' " + arguments + " >'" +
              (out.empty() ? "/dev/null" : command.path(out)) + "' 2>'" + command.path(err) + "' </dev/null") {}

Running::Running(const Command& command, const std::string& arguments, const std::string& err,
                 const PseudoTerminal& terminal)
    : Running(environment(command) + "exec '" + binary() + "' " + arguments + " >'" + terminal.name() + "' 2>'" +
              command.path(err) + "' <'" + terminal.name() + "'") {}

Running::~Running() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Running::signal(int number) const { ::kill(process_, number); }

std::optional<int> Running::wait() {
  int status = 0;
  const bool ended = eventually([&] { return ::waitpid(process_, &status, WNOHANG) == process_; });
  if (!ended) return std::nullopt;
  process_ = -1;
  return status;
}

bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

std::vector<std::string> Command::names() const {
  std::vector<std::string> result;
  for (const auto& entry : std::filesystem::directory_iterator(directory_)) {
    const std::string name = entry.path().filename().string();
    if (name != "stdout" && name != "stderr" && name != "script" && name != "state") result.push_back(name);
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::string Command::path(const std::string& name) const { return (directory_ / name).string(); }

std::string Command::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name)) << text;
  return path(name);
}

std::string contents(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

nlohmann::json read_json(const std::string& file) { return nlohmann::json::parse(contents(file), nullptr, false); }

std::vector<Step> read_steps(const std::string& file) {
  std::ifstream in(file);
  std::string header;
  std::getline(in, header);
  EXPECT_EQ(header, "cycle,axis,direction");
  std::vector<Step> steps;
  Step step;
  char comma = 0;
  char second = 0;
  while (in >> step.cycle >> comma >> step.axis >> second >> step.direction) {
    const bool sound = comma == ',' && second == ',' && step.axis < 8 && std::abs(step.direction) == 1;
    const bool in_order = steps.empty() || steps.back().cycle <= step.cycle;
    if (!sound || !in_order) {
      ADD_FAILURE() << file << ": row " << steps.size() + 2 << " is malformed or out of order";
      return steps;
    }
    steps.push_back(step);
  }
  EXPECT_TRUE(in.eof()) << file << ": row " << steps.size() + 2 << " is malformed";
  return steps;
}

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace trammel::test
