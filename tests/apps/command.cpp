#include "command.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

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

Outcome Command::run(const std::string& arguments) const {
  const char* other = std::getenv("TRAMMEL_BINARY");
  const std::string binary = other != nullptr ? other : TRAMMEL_COMMAND;
  const std::string line =
      "'" + binary + "' " + arguments + " >'" + path("stdout") + "' 2>'" + path("stderr") + "' </dev/null";
  const int status = std::system(line.c_str());
  Outcome outcome;
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  outcome.out = contents(path("stdout"));
  outcome.err = contents(path("stderr"));
  return outcome;
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
