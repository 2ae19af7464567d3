#include "compare_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace trammel::app {
namespace {

namespace interpolation = interpolation;
namespace measure = measure;
using interpolation::Method;
using nlohmann::ordered_json;

constexpr std::array<char, measure::kTraceAxes> kAxisNames = {'x', 'y', 'z', 'a'};
// One column per octave of the sweep.
constexpr std::size_t kColumnStride = measure::kSpeedsAnOctave;

std::string_view name_of(Method method) { return interpolation::info(method).name; }

// A text table: the first column is left-aligned, the others right-aligned, each as wide as its widest cell.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text() const {
    std::vector<std::size_t> widths(rows_.front().size(), 0);
    for (const auto& row : rows_) {
      for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string result;
    for (const auto& row : rows_) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        result += i == 0 ? fmt::format("  {:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
      }
      result += '\n';
    }
    return result;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

std::string decimals(double value) { return fmt::format("{:.3f}", value); }
std::string percent(double value) { return fmt::format("{:.1f}", 100 * value); }

// Names the methods that left the curve: their distance is larger than rounding and a step explain.
std::string left_curves(const Comparison& comparison) {
  constexpr double kStep = 1.5;
  std::string text;
  for (const measure::MethodMeasures& method : comparison.methods) {
    const double largest = method.distances.perpendicular.largest;
    if (largest <= kStep) continue;
    const bool spiral = !comparison.is_line && (method.method == Method::kDda || method.method == Method::kDdaHalf);
    text += fmt::format("{} leaves its curve: {:.3f} pulses off{}\n", name_of(method.method), largest,
                        spiral ? "; digital integration of a circle spirals outward along its tangents" : "");
  }
  return text;
}

std::string distances_table(const Comparison& comparison) {
  std::vector<std::string> head = {"method", "steps",      "time", "host operations", "register writes", "largest",
                                   "mean",   "horizontal", "mean"};
  for (std::size_t a = 0; a < comparison.axes; ++a) head.push_back(fmt::format("on {}", kAxisNames[a]));
  Table table(head);
  for (const measure::MethodMeasures& method : comparison.methods) {
    const measure::Distances& d = method.distances;
    std::vector<std::string> row = {
        std::string(name_of(method.method)),
        fmt::format("{}", method.steps),
        fmt::format("{} {}s", method.total_time, interpolation::info(method.method).time_unit),
        fmt::format("{}", method.cost.operations),
        fmt::format("{}", method.cost.register_writes),
        decimals(d.perpendicular.largest),
        decimals(d.perpendicular.mean),
        d.horizontal ? decimals(d.horizontal->largest) : "-",
        d.horizontal ? decimals(d.horizontal->mean) : "-"};
    for (std::size_t a = 0; a < comparison.axes; ++a) row.push_back(decimals(d.axis[a].largest));
    table.add(row);
  }
  return "\nCost, and distance from the curve in pulses\n"
         "  steps, time      times with a step; the curve's length in the method's own time unit\n"
         "  host operations  how often the host computes (once where the card runs the method); register writes: words "
         "sent\n"
         "  largest, mean    perpendicular distance after each step\n"
         "  horizontal, mean along x to the point of the line at the same y, largest and mean (lines alone)\n"
         "  on x, on y ...   largest distance on one axis from the point that runs along the curve at constant "
         "speed\n" +
         table.text() + left_curves(comparison);
}

std::string evenness_table(const Comparison& comparison) {
  std::vector<std::string> head = {"method"};
  for (std::size_t a = 0; a < comparison.axes; ++a) {
    for (const char* what : {"largest", "rms", "line", "at"}) head.push_back(fmt::format("{} {}", kAxisNames[a], what));
  }
  head.insert(head.end(), {"ripple rms", "largest"});
  Table table(head);
  for (const measure::MethodMeasures& method : comparison.methods) {
    std::vector<std::string> row = {std::string(name_of(method.method))};
    for (std::size_t a = 0; a < comparison.axes; ++a) {
      const measure::Evenness& evenness = method.evenness[a];
      const measure::SpectrumLine line = measure::highest_line(method.spectrum[a]);
      const bool none = evenness.intervals == 0;
      row.push_back(none ? "-" : percent(evenness.largest));
      row.push_back(none ? "-" : percent(evenness.rms));
      row.push_back(method.spectrum[a].empty() ? "-" : percent(line.amplitude));
      // An amplitude at the level of rounding has no frequency.
      row.push_back(line.amplitude < 1e-9 ? "-" : decimals(line.frequency));
    }
    row.push_back(percent(method.ripple.rms));
    row.push_back(percent(method.ripple.largest));
    table.add(row);
  }
  return "\nEvenness\n"
         "  x largest, x rms  deviation of the axis's step intervals in % of the even one\n"
         "  x line, x at      highest line of their spectrum in %, and its frequency in cycles per pulse\n"
         "  ripple rms, largest  speed along the path, deviation in % of the mean speed\n" +
         table.text();
}

std::string lost_text(const Comparison& comparison, std::size_t method) {
  std::string text;
  for (const measure::SpeedRange& range : measure::lost_at(comparison.speeds, comparison.sweeps[method])) {
    if (!text.empty()) text += ", ";
    text += fmt::format("{:.0f}", range.first);
    if (range.last > range.first) text += fmt::format(" .. {:.0f}", range.last);
  }
  return text.empty() ? "-" : text;
}

template <class Cell>
std::string motor_table(const Comparison& comparison, const std::string& title, Cell cell) {
  std::vector<std::string> head = {"method"};
  for (std::size_t i = 0; i < comparison.speeds.size(); i += kColumnStride) {
    head.push_back(fmt::format("{:.0f}/s", comparison.speeds[i]));
  }
  head.push_back("lost at");
  Table table(head);
  for (std::size_t m = 0; m < comparison.methods.size(); ++m) {
    std::vector<std::string> row = {std::string(name_of(comparison.methods[m].method))};
    for (std::size_t i = 0; i < comparison.speeds.size(); i += kColumnStride) {
      const measure::Vibration& vibration = comparison.sweeps[m][i];
      row.push_back(vibration.lost_steps ? "lost" : cell(vibration));
    }
    row.push_back(lost_text(comparison, m));
    table.add(row);
  }
  return title + table.text();
}

std::string drive_name(const Comparison& comparison) {
  return comparison.motor.drive == measure::Drive::kFullStep ? "full" : "half";
}

ordered_json json_of(const measure::Spread& spread) { return {{"largest", spread.largest}, {"mean", spread.mean}}; }

ordered_json json_of(const measure::MethodMeasures& method, std::size_t axes) {
  ordered_json json;
  json["name"] = name_of(method.method);
  json["steps"] = method.steps;
  json["pulses"] = method.pulses;
  json["total_time"] = method.total_time;
  json["time_unit"] = interpolation::info(method.method).time_unit;
  json["host_operations"] = method.cost.operations;
  json["register_writes"] = method.cost.register_writes;
  json["distance"]["perpendicular"] = json_of(method.distances.perpendicular);
  json["distance"]["horizontal"] = nullptr;
  if (method.distances.horizontal) json["distance"]["horizontal"] = json_of(*method.distances.horizontal);
  json["distance"]["axis"] = ordered_json::array();
  json["intervals"] = ordered_json::array();
  for (std::size_t a = 0; a < axes; ++a) {
    json["distance"]["axis"].push_back(json_of(method.distances.axis[a]));
    const measure::SpectrumLine highest = measure::highest_line(method.spectrum[a]);
    ordered_json amplitudes = ordered_json::array();
    for (const measure::SpectrumLine& line : method.spectrum[a]) amplitudes.push_back(line.amplitude);
    json["intervals"].push_back({{"count", method.evenness[a].intervals},
                                 {"largest", method.evenness[a].largest},
                                 {"rms", method.evenness[a].rms},
                                 {"highest_line", {{"frequency", highest.frequency}, {"amplitude", highest.amplitude}}},
                                 {"lowest_frequency", method.spectrum[a].empty() ? 0 : method.spectrum[a][0].frequency},
                                 {"amplitudes", amplitudes}});
  }
  json["speed_ripple"] = {{"rms", method.ripple.rms}, {"largest", method.ripple.largest}};
  return json;
}

ordered_json json_of(const measure::Vibration& vibration, double speed, std::size_t axes) {
  ordered_json json = {{"speed", speed},
                       {"rms_ripple", vibration.rms_ripple},
                       {"largest_lag", vibration.largest_lag},
                       {"lost_steps", vibration.lost_steps},
                       {"axis", ordered_json::array()}};
  for (std::size_t a = 0; a < axes; ++a) {
    json["axis"].push_back(
        {{"rms_ripple", vibration.axis[a].rms_ripple}, {"largest_lag", vibration.axis[a].largest_lag}});
  }
  return json;
}

}  // namespace

std::string table_of(const Comparison& comparison) {
  std::string text = fmt::format("{}: {:.3f} pulses long", comparison.title, comparison.length);
  if (comparison.is_line) {
    const double clocks = static_cast<double>(comparison.options.clock_hz) *
                          static_cast<double>(comparison.options.velocity_divisor) /
                          static_cast<double>(comparison.options.velocity);
    text += fmt::format("; one-shot methods and dividers: {:.0f} clocks at {} Hz", clocks, comparison.options.clock_hz);
  }
  text += '\n';
  for (const Refusal& refusal : comparison.refused) {
    text += fmt::format("{}: left out: {}\n", name_of(refusal.method), refusal.reason);
  }
  text += distances_table(comparison);
  text += evenness_table(comparison);
  text += motor_table(comparison,
                      fmt::format("\nSimulated motors, {} steps{}: rms speed ripple in % of the speed, by pulses/s "
                                  "along the path; lost at: speeds "
                                  "of\nthe sweep at which steps were lost\n",
                                  drive_name(comparison), comparison.motor.ramp_time == 0 ? ", without ramps" : ""),
                      [](const measure::Vibration& vibration) { return percent(vibration.rms_ripple); });
  text += motor_table(comparison, "\nThe same: largest lag of a rotor behind its field, in full steps\n",
                      [](const measure::Vibration& vibration) { return fmt::format("{:.2f}", vibration.largest_lag); });
  return text;
}

std::string json_text(const Comparison& comparison) {
  ordered_json json;
  json["curve"] = comparison.title;
  json["length"] = comparison.length;
  json["clock_hz"] = comparison.options.clock_hz;
  json["velocity"] =
      static_cast<double>(comparison.options.velocity) / static_cast<double>(comparison.options.velocity_divisor);
  json["drive"] = drive_name(comparison);
  json["motor_ramp_seconds"] = comparison.motor.ramp_time;
  json["methods"] = ordered_json::array();
  for (std::size_t m = 0; m < comparison.methods.size(); ++m) {
    ordered_json method = json_of(comparison.methods[m], comparison.axes);
    method["motor"] = ordered_json::array();
    for (std::size_t i = 0; i < comparison.speeds.size(); ++i) {
      method["motor"].push_back(json_of(comparison.sweeps[m][i], comparison.speeds[i], comparison.axes));
    }
    method["lost_at"] = ordered_json::array();
    for (const measure::SpeedRange& range : measure::lost_at(comparison.speeds, comparison.sweeps[m])) {
      method["lost_at"].push_back({range.first, range.last});
    }
    json["methods"].push_back(method);
  }
  json["refused"] = ordered_json::array();
  for (const Refusal& refusal : comparison.refused) {
    json["refused"].push_back({{"name", name_of(refusal.method)}, {"reason", refusal.reason}});
  }
  return json.dump(2) + "\n";
}

std::string table_of(const measure::RandomLines& lines, const std::vector<measure::RandomMeasures>& measures) {
  Table table({"method", "steps", "host operations", "largest", "mean", "on axis", "interval largest", "mean largest",
               "mean rms", "ripple largest", "mean rms", "worst line to"});
  for (const measure::RandomMeasures& method : measures) {
    table.add({std::string(name_of(method.method)), fmt::format("{:.1f}", method.mean_steps),
               fmt::format("{:.1f}", method.mean_operations), decimals(method.largest_perpendicular),
               decimals(method.mean_perpendicular), decimals(method.largest_axis),
               percent(method.largest_interval_deviation), percent(method.mean_interval_deviation),
               percent(method.mean_rms_interval), percent(method.largest_ripple), percent(method.mean_rms_ripple),
               fmt::format("{},{}", method.worst_line.end[0], method.worst_line.end[1])});
  }
  return fmt::format(
             "{} random lines from (0,0), up to {} pulses per axis, seed {}; {} Hz, {} lines/s\n"
             "mean steps and host operations per line; distance in pulses: perpendicular (largest, mean), on one axis "
             "from the point\nat constant speed; interval deviation and speed ripple in %\n",
             lines.count, lines.largest, lines.seed, lines.options.clock_hz, lines.options.velocity) +
         table.text();
}

std::string json_text(const measure::RandomLines& lines, const std::vector<measure::RandomMeasures>& measures) {
  ordered_json json = {{"lines", lines.count},
                       {"seed", lines.seed},
                       {"largest", lines.largest},
                       {"clock_hz", lines.options.clock_hz},
                       {"velocity", lines.options.velocity},
                       {"methods", ordered_json::array()}};
  for (const measure::RandomMeasures& method : measures) {
    json["methods"].push_back(
        {{"name", name_of(method.method)},
         {"mean_steps", method.mean_steps},
         {"mean_host_operations", method.mean_operations},
         {"wrong_ends", method.wrong_ends},
         {"distance",
          {{"perpendicular", {{"largest", method.largest_perpendicular}, {"mean", method.mean_perpendicular}}},
           {"worst_line", {method.worst_line.end[0], method.worst_line.end[1]}},
           {"horizontal", {{"largest", method.largest_horizontal}}},
           {"axis", {{"largest", method.largest_axis}}}}},
         {"intervals",
          {{"largest", method.largest_interval_deviation},
           {"mean_largest", method.mean_interval_deviation},
           {"mean_rms", method.mean_rms_interval}}},
         {"speed_ripple", {{"largest", method.largest_ripple}, {"mean_rms", method.mean_rms_ripple}}}});
  }
  return json.dump(2) + "\n";
}

}  // namespace trammel::app
