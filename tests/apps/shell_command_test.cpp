// Shell completion and the manual agree with the command's help.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <set>

#include "command.hpp"

namespace trammel::test {
namespace {

const std::vector<std::string> kCommands = {"run",        "line",    "jog",       "info",    "monitor", "dump",
                                            "selftest",   "serve",   "steps",     "methods", "compare", "reproduce",
                                            "completion", "man",     "position",  "zero",    "recover", "drives",
                                            "home",       "machine", "calibrate", "world",   "panel"};

// The long options in the help of a subcommand, at the start of a line.
std::set<std::string> options_of(const Command& command, const std::string& name) {
  std::set<std::string> options;
  const std::string help = command.run("help " + name).out;
  const std::regex option("\n +(?:-[a-z],)?--([a-z][a-z0-9-]*)");
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at) options.insert((*at)[1]);
  return options;
}

// Sources the bash script and returns its completions for these words; the last word is incomplete.
std::string offered(const Command& command, const std::string& script, const std::string& words) {
  const std::string out = command.path("offered.txt");
  const std::string asks = command.write(
      "ask.bash", "source " + script + "\nCOMP_WORDS=(" + words +
                      ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_trammel\necho \" ${COMPREPLY[*]} \" > " + out + "\n");
  EXPECT_EQ(std::system(("bash --norc " + asks).c_str()), 0) << words;
  return contents(out);
}

TEST(Completion, OffersInBashWhatTheHelpTells) {
  const Command command;
  const std::string script = command.write("trammel.bash", command.run("completion bash").out);
  const std::string commands = offered(command, script, "trammel ''");
  for (const std::string& name : kCommands) {
    EXPECT_NE(commands.find(" " + name + " "), std::string::npos) << name << commands;
    const std::string offers = offered(command, script, "trammel " + name + " --");
    const std::set<std::string> options = options_of(command, name);
    EXPECT_TRUE(name == "methods" || options.size() > 0 || name == "completion" || name == "man");
    for (const std::string& option : options) {
      EXPECT_NE(offers.find(" --" + option + " "), std::string::npos) << name << " --" << option << offers;
    }
  }
  EXPECT_EQ(offered(command, script, "trammel run --engine m"), " model \n");
  EXPECT_EQ(offered(command, script, "trammel run --eng"), " --engine \n");
  EXPECT_EQ(offered(command, script, "trammel run --json x"), "  \n") << "file names are the shell's own";
}

TEST(Completion, NamesEachOptionToZshAndFish) {
  const Command command;
  const std::string zsh = command.run("completion zsh").out;
  const std::string fish = command.run("completion fish").out;
  EXPECT_EQ(zsh.rfind("#compdef trammel\n", 0), 0U);
  for (const std::string& name : kCommands) {
    for (const std::string& option : options_of(command, name)) {
      EXPECT_NE(zsh.find("--" + option + "["), std::string::npos) << option;
      EXPECT_NE(fish.find(" -l " + option + " "), std::string::npos) << option;
    }
  }
  for (const auto& [shell, text] : {std::pair{std::string("zsh"), zsh}, {std::string("fish"), fish}}) {
    if (std::system(("command -v " + shell + " > /dev/null").c_str()) != 0) continue;
    EXPECT_EQ(std::system((shell + " -n " + command.write("script." + shell, text)).c_str()), 0) << shell;
  }
}

TEST(Completion, RefusesAnotherShell) {
  const Command command;
  const Outcome outcome = command.run("completion tcsh");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("bash"), std::string::npos) << outcome.err;
}

TEST(Manual, NamesEachOption) {
  const Command command;
  const std::string page = command.run("man").out;
  EXPECT_EQ(page.rfind(".TH TRAMMEL 1 ", 0), 0U);
  for (const std::string& name : kCommands) {
    EXPECT_NE(page.find(".SS trammel " + name + "\n"), std::string::npos) << name;
    for (const std::string& option : options_of(command, name)) {
      EXPECT_NE(page.find(std::regex_replace("--" + option, std::regex("-"), "\\-")), std::string::npos) << option;
    }
  }
  if (std::system("command -v groff > /dev/null") == 0) {
    const std::string file = command.write("trammel.1", page);
    const std::string out = command.path("warnings.txt");
    EXPECT_EQ(std::system(("groff -man -Tutf8 -ww -z " + file + " 2> " + out).c_str()), 0);
    EXPECT_EQ(contents(out), "");
  }
}

}  // namespace
}  // namespace trammel::test
