#include "steps_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/curve_options.hpp"
#include "common/errors.hpp"
#include "common/outputs.hpp"
#include "trammel/interpolation/any_interpolator.hpp"

namespace trammel::app {
namespace {

namespace interpolation = interpolation;
using interpolation::AnyInterpolator;
using interpolation::Position;
using interpolation::Step;

struct StepsOptions {
  std::string method;
  CurveChoice curve;
  VelocityChoice velocity;
  std::optional<std::string> csv;
  std::optional<std::string> json;
};

std::string axis_of(const Step& step) {
  std::string result;
  if (step.direction[0] != 0) result += 'x';
  if (step.direction[1] != 0) result += 'y';
  return result;
}

std::string direction_of(const Step& step) {
  std::string result;
  for (unsigned a = 0; a < 2; ++a) {
    if (step.direction[a] != 0) result += step.direction[a] < 0 ? '-' : '+';
  }
  return result;
}

// One step, with the position and deviation before it.
struct Row {
  std::uint64_t index;
  Step step;
  Position from;
  std::optional<interpolation::Deviation> f;
  std::uint64_t time;

  std::string deviation(const char* none) const { return f ? fmt::format("{}", *f) : none; }
};

template <class Sink>
std::uint64_t walk(AnyInterpolator& interpolator, Sink&& sink) {
  std::uint64_t count = 0;
  for (; !interpolator.done(); ++count) {
    const Position from = interpolator.position();
    const auto f = interpolator.deviation();
    const Step step = interpolator.next();
    sink(Row{count, step, from, f, interpolator.time()});
  }
  return count;
}

template <class... Arguments>
void print(Output& out, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), format, std::forward<Arguments>(arguments)...);
  out.write({text.data(), text.size()});
}

void write_csv(Output& out, AnyInterpolator interpolator) {
  print(out, "index,axis,direction,x,y,f\n");
  walk(interpolator, [&](const Row& row) {
    print(out, "{},{},{},{},{},{}\n", row.index, axis_of(row.step), direction_of(row.step), row.from[0], row.from[1],
          row.deviation(""));
  });
}

// Writes the steps as they are made, so the length of the walk does not matter.
void write_json(Output& out, const interpolation::MethodInfo& method, AnyInterpolator interpolator) {
  const Position start = interpolator.position();
  print(out, "{{\n\"method\": \"{}\",\n\"time_unit\": \"{}\",\n", method.name, method.time_unit);
  print(out, "\"start\": [{}, {}],\n\"path\": [", start[0], start[1]);
  const std::uint64_t count = walk(interpolator, [&](const Row& row) {
    print(out, "{}{{\"index\": {}, \"axis\": \"{}\", \"direction\": \"{}\", \"x\": {}, \"y\": {}, \"f\": {}, ",
          row.index == 0 ? "\n" : ",\n", row.index, axis_of(row.step), direction_of(row.step), row.from[0], row.from[1],
          row.deviation("null"));
    print(out, "\"time\": {}}}", row.time);
  });
  const Position end = interpolator.position();
  print(out, "],\n\"end\": [{}, {}],\n\"steps\": {},\n\"total_time\": {}\n}}\n", end[0], end[1], count,
        interpolator.total_time());
}

void print_steps(const StepsOptions& options) {
  const auto method = interpolation::method_named(options.method);
  if (!method) throw UsageError(fmt::format("no method \"{}\": trammel methods lists them", options.method));
  Outputs outputs;
  Output* const csv = outputs.add("--csv", options.json ? options.csv : options.csv.value_or("-"));
  Output* const json = outputs.add("--json", options.json);
  outputs.check();
  const interpolation::Curve curve = options.curve.curve();
  const AnyInterpolator interpolator = [&] {
    try {
      return interpolation::make_interpolator(*method, curve, options.velocity.options(curve));
    } catch (const std::invalid_argument& error) {
      throw UsageError(error.what());
    }
  }();
  outputs.open();
  if (csv != nullptr) write_csv(*csv, interpolator);
  if (json != nullptr) write_json(*json, interpolation::info(*method), interpolator);
  outputs.commit();
}

}  // namespace

void add_steps_command(CLI::App& app) {
  auto options = std::make_shared<StepsOptions>();
  CLI::App* command = app.add_subcommand("steps", "print the steps of one interpolation method on one curve");
  command->add_option("--method", options->method, "interpolation method; trammel methods lists them")
      ->required()
      ->type_name("NAME");
  options->curve.add_to(*command);
  options->velocity.add_to(*command);
  command
      ->add_option(
          "--csv", options->csv,
          "write index,axis,direction,x,y,f of each step to a CSV file ('-': standard output, which is the default)")
      ->type_name("FILE");
  command
      ->add_option("--json", options->json,
                   "write the same and the times of the steps to a JSON file ('-': standard output)")
      ->type_name("FILE");
  command->callback([options] { print_steps(*options); });
}

}  // namespace trammel::app
