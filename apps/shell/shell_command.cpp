#include "shell_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "command_outline.hpp"
#include "common/standard_streams.hpp"

namespace trammel::app {
namespace {

std::string with(std::string text, char special, const std::string& replacement) {
  for (std::size_t at = 0; (at = text.find(special, at)) != std::string::npos; at += replacement.size()) {
    text.replace(at, 1, replacement);
  }
  return text;
}

// Quotes text with single quotes for all three shells (fish understands \' inside the quotes, the others end the quotes
// for it).
std::string quoted(const std::string& text) { return "'" + with(text, '\'', "'\\''") + "'"; }

std::string names_of(const std::vector<CommandOutline>& commands) {
  std::string names = "help";
  for (const CommandOutline& command : commands) names += " " + command.name;
  return names;
}

std::string bash_completion(const std::vector<CommandOutline>& commands) {
  std::string words;
  std::string values;
  for (const CommandOutline& command : commands) {
    std::string names;
    for (const OptionOutline& option : command.options) {
      if (option.positional) continue;
      names += fmt::format("{}{}", names.empty() ? "" : " ", fmt::join(option.names, " "));
      if (!option.takes_value) continue;
      for (const std::string& name : option.names) {
        // Without choices the shell completes file names.
        values += fmt::format("    {}:{}) COMPREPLY=($(compgen -W '{}' -- \"$current\")); return ;;\n", command.name,
                              name, fmt::join(option.choices, " "));
      }
    }
    words += fmt::format("    {}) words='{}' ;;\n", command.name, names);
  }
  return fmt::format(R"(# Completion of trammel for bash: made by `trammel completion bash`.
_trammel() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ] || {{ [ "$command" = help ] && [ "$COMP_CWORD" -eq 2 ]; }}; then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$current"))
    return
  fi
  case $command:$before in
{}  esac
  case $command in
{}  esac
  case $current in
    -*) COMPREPLY=($(compgen -W "$words" -- "$current")) ;;
  esac
}}
complete -o default -F _trammel trammel
)",
                     names_of(commands), values, words);
}

// The format of an option for _arguments: its names, a text, and the completion of its value.
std::string zsh_argument(const OptionOutline& option) {
  const auto plain = [](std::string text) { return with(with(with(std::move(text), '[', "("), ']', ")"), ':', "\\:"); };
  const std::string value = option.choices.empty() ? "_files" : fmt::format("({})", fmt::join(option.choices, " "));
  if (option.positional) return quoted(fmt::format("*:{}:_files", plain(option.names[0])));
  std::string text;
  for (const std::string& name : option.names) {
    text += text.empty() ? "" : " ";
    text += quoted(fmt::format("{}{}[{}]{}", option.repeatable ? "*" : "", name, plain(option.about),
                               option.takes_value ? fmt::format(":{}:{}", plain(option.value), value) : ""));
  }
  return text;
}

std::string zsh_completion(const std::vector<CommandOutline>& commands) {
  std::string names;
  std::string cases;
  for (const CommandOutline& command : commands) {
    names += "    " + quoted(fmt::format("{}:{}", command.name, with(command.about, ':', "\\:"))) + "\n";
    cases += fmt::format("    {}) _arguments", command.name);
    for (const OptionOutline& option : command.options) cases += fmt::format(" \\\n      {}", zsh_argument(option));
    cases += " ;;\n";
  }
  return fmt::format(R"(#compdef trammel
# Completion of trammel for zsh: made by `trammel completion zsh`.
_trammel() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
if [ "$funcstack[1]" = _trammel ]; then _trammel "$@"; else compdef _trammel trammel; fi
)",
                     names, cases);
}

std::string fish_completion(const std::vector<CommandOutline>& commands) {
  std::string text = "# Completion of trammel for fish: made by `trammel completion fish`.\n";
  for (const CommandOutline& command : commands) {
    text += fmt::format("complete -c trammel -n __fish_use_subcommand -f -a {} -d {}\n", command.name,
                        quoted(command.about));
    for (const OptionOutline& option : command.options) {
      if (option.positional) continue;
      text += fmt::format("complete -c trammel -n '__fish_seen_subcommand_from {}'", command.name);
      for (const std::string& name : option.names) {
        text += name[1] == '-' ? fmt::format(" -l {}", name.substr(2)) : fmt::format(" -s {}", name.substr(1));
      }
      if (!option.choices.empty())
        text += fmt::format(" -x -a {}", quoted(fmt::format("{}", fmt::join(option.choices, " "))));
      if (option.takes_value && option.choices.empty()) text += " -r";
      text += fmt::format(" -d {}\n", quoted(option.about));
    }
  }
  return text;
}

// Escapes a line for roff, so that it contains no escape sequence and does not begin a request with a dot or quote.
std::string roff(const std::string& text) {
  std::string line = with(with(text, '\\', "\\e"), '-', "\\-");
  for (std::size_t at = 0; (at = line.find('\n', at)) != std::string::npos; ++at) line.replace(at, 1, " ");
  return line.empty() || (line[0] != '.' && line[0] != '\'') ? line : "\\&" + line;
}

std::string manual_of(const OptionOutline& option) {
  std::string head;
  for (const std::string& name : option.names)
    head += fmt::format("{}\\fB{}\\fR", head.empty() ? "" : ", ", roff(name));
  if (option.takes_value && !option.positional) {
    head += option.choices.empty() ? fmt::format(" \\fI{}\\fR", roff(option.value))
                                   : fmt::format(" {}", roff(fmt::format("{}", fmt::join(option.choices, " | "))));
  }
  std::string about = option.about;
  if (!option.default_value.empty()) about += fmt::format(" (default: {})", option.default_value);
  if (option.repeatable && option.about.find("repeatable") == std::string::npos) about += " (repeatable)";
  return fmt::format(".TP\n{}\n{}\n", head, roff(about));
}

}  // namespace

std::string completion_of(const CLI::App& app, const std::string& shell) {
  const std::vector<CommandOutline> commands = outline_of(app);
  if (shell == "bash") return bash_completion(commands);
  return shell == "zsh" ? zsh_completion(commands) : fish_completion(commands);
}

std::string manual_of(const CLI::App& app) {
  std::string commands;
  for (const CommandOutline& command : outline_of(app)) {
    commands += fmt::format(".SS trammel {}\n{}\n", roff(command.name), roff(command.about));
    for (const OptionOutline& option : command.options) commands += manual_of(option);
  }
  return fmt::format(R"(.TH TRAMMEL 1 "" "trammel {}" "User Commands"
.SH NAME
trammel \- {}
.SH SYNOPSIS
.B trammel
.I command
[\fIoption\fR ...]
.br
.B trammel help
[\fIcommand\fR]
.SH COMMANDS
{}.SH EXIT STATUS
.TP
.B 0
the command was completed
.TP
.B 1
the command failed after it had begun: a file could not be written, the card stopped, or card and model differ
.TP
.B 2
the command line, the machine file or the program was refused; nothing has moved
)",
                     roff(app.version().substr(app.version().find_last_of(' ') + 1)), roff(app.get_description()),
                     commands);
}

void add_shell_commands(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion =
      app.add_subcommand("completion", "print a script with which a shell completes trammel's commands and options");
  completion->add_option("shell", *shell, "the shell: bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->callback([shell, &app] { to_standard_output(completion_of(app, *shell)); });
  CLI::App* manual = app.add_subcommand("man", "print the manual page: trammel man | man -l -");
  manual->callback([&app] { to_standard_output(manual_of(app)); });
}

}  // namespace trammel::app
