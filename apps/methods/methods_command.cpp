#include "methods_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "common/standard_streams.hpp"
#include "trammel/interpolation/method.hpp"

namespace trammel::app {
namespace {

std::string abilities(const interpolation::MethodInfo& method) {
  std::string result;
  const auto add = [&](const std::string& what) { result += (result.empty() ? "" : ", ") + what; };
  if (method.line_axes == 2) add("lines (2 axes)");
  if (method.line_axes > 2) add(fmt::format("lines (2 to {} axes)", method.line_axes));
  if (method.circles) add("circles, arcs");
  if (method.ellipses) add("ellipses");
  return result;
}

void list_methods() {
  to_standard_output(fmt::format("{:<16} {:<46} {:<10} {}\n", "method", "can do", "time in", "what it is"));
  for (const auto& method : interpolation::methods()) {
    const std::string unit = std::string(method.time_unit) + "s";
    to_standard_output(fmt::format("{:<16} {:<46} {:<10} {}\n", method.name, abilities(method), unit, method.brief));
  }
}

}  // namespace

void add_methods_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("methods", "list the interpolation methods and what each can do");
  command->callback(list_methods);
}

}  // namespace trammel::app
