#include "world_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/standard_streams.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/transport/served_world.hpp"

namespace trammel::app {
namespace {

struct WorldOptions {
  CardChoice card;
  std::vector<std::string> words;
  std::optional<std::string> when;
  double longest = 60;
  bool json = false;
};

transport::CardUrl server_of(const WorldOptions& options) {
  std::optional<transport::CardUrl> url = options.card.url();
  if (!url) throw UsageError("world: needs --card with the URL that `trammel serve --world default` prints");
  const char* const token = std::getenv("TRAMMEL_TOKEN");
  if (url->token.empty() && token != nullptr) url->token = token;
  return *url;
}

// The request in the server's format: "press estop when X > 40".
std::string request_of(const WorldOptions& options) {
  std::string text = options.words.empty() ? "state" : fmt::format("{}", fmt::join(options.words, " "));
  if (!options.when) return text;
  std::string spaced;
  for (const char c : *options.when) spaced += c == '<' || c == '>' ? std::string{' ', c, ' '} : std::string(1, c);
  return text + " when " + spaced;
}

std::string axis_text(const nlohmann::json& axis) {
  return fmt::format("{}  carriage {:10.4f} mm   the card counts {:10.4f} mm   lost {} pulses{}\n",
                     axis["axis"].get<std::string>(), axis["carriage_mm"].get<double>(),
                     axis["commanded_mm"].get<double>(), axis["lost"].get<std::int64_t>(),
                     axis["powered"].get<bool>() ? "" : "   no power");
}

std::string list_text(const nlohmann::json& parts) {
  std::vector<std::string> out;
  for (const auto& part : parts) out.push_back((part.is_string() ? part : part["name"]).get<std::string>());
  return out.empty() ? "nothing" : fmt::format("{}", fmt::join(out, ", "));
}

std::string state_text(const nlohmann::json& state) {
  std::string text;
  for (const auto& axis : state["axes"]) text += axis_text(axis);
  text += fmt::format("pressed   {}\n", list_text(state["pressed"]));
  text += fmt::format("switches  {}\nbuttons   {}\n", list_text(state["switches"]), list_text(state["buttons"]));
  return text + fmt::format("path      {} steps, identity {}\ntime      {:.3f} s of the card\n",
                            state["path"]["steps"].get<std::uint64_t>(), state["path"]["identity"].get<std::string>(),
                            state["time_s"].get<double>());
}

transport::ServedWorld connect(const transport::CardUrl& url) {
  try {
    return transport::ServedWorld(url);
  } catch (const driver::LinkError& error) {
    throw UsageError(fmt::format("--card: {}", error.what()));
  }
}

void ask_world(const WorldOptions& options) {
  const transport::CardUrl url = server_of(options);
  try {
    transport::ServedWorld world = connect(url);
    const auto longest = std::chrono::milliseconds(std::llround(options.longest * 1000));
    const std::string answer = world.request(request_of(options), longest);
    to_standard_output(options.json ? answer + "\n" : state_text(nlohmann::json::parse(answer)));
  } catch (const driver::ArgumentError& error) {
    throw UsageError(fmt::format("world: {}", error.what()));
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(fmt::format("world: the server's answer cannot be read: {}", error.what()));
  }
}

}  // namespace

void add_world_command(CLI::App& app) {
  auto options = std::make_shared<WorldOptions>();
  CLI::App* command = app.add_subcommand(
      "world", "show the simulated machine behind a card of `trammel serve --world`, or press its buttons");
  command
      ->add_option("request", options->words,
                   "state: show the machine (default). press NAME, release NAME: a button. alarm X, clear X: the alarm "
                   "of axis X's drive. count: begin to count the path's steps anew")
      ->type_name("REQUEST");
  command
      ->add_option("--when", options->when,
                   "press or release later: when a carriage has reached a position in mm, such as 'X>40', or the path "
                   "has a number of steps, such as 'steps>2000'")
      ->type_name("CONDITION");
  command
      ->add_option("--longest", options->longest,
                   "longest wait for the answer, seconds of real time. After it the command ends with status 1")
      ->check(positive())
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the state as one line of JSON");
  options->card.add_to(*command);
  command->callback([options] { ask_world(*options); });
}

}  // namespace trammel::app
