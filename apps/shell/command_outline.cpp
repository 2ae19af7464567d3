#include "command_outline.hpp"

#include <CLI/CLI.hpp>

namespace trammel::app {
namespace {

// The option reader includes an option's choices in its type name: TEXT:{rtl,model}.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

OptionOutline outline_of(const CLI::Option& option) {
  OptionOutline outline;
  outline.positional = option.get_positional();
  if (outline.positional) {
    outline.names.push_back(option.get_name(true));
  } else {
    for (const std::string& name : option.get_snames()) outline.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) outline.names.push_back("--" + name);
  }
  outline.takes_value = option.get_type_size_max() > 0;
  outline.repeatable = outline.takes_value && option.get_expected_max() > 1;
  const std::string type = option.get_type_name();
  outline.choices = choices_in(type);
  outline.value = type.substr(0, type.find(':'));
  outline.default_value = option.get_default_str();
  outline.about = option.get_description();
  return outline;
}

}  // namespace

std::vector<CommandOutline> outline_of(const CLI::App& app) {
  std::vector<CommandOutline> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    CommandOutline outline{command->get_name(), command->get_description(), {}};
    for (const CLI::Option* option : command->get_options()) outline.options.push_back(outline_of(*option));
    commands.push_back(std::move(outline));
  }
  return commands;
}

}  // namespace trammel::app
