// systemc_run: runs a program of G-code on the virtual prototype, and compares the machine's position with the
// commanded one.
#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "platform.hpp"
#include "trammel/chart/chart.hpp"
#include "trammel/run/runner.hpp"

namespace trammel::platform {
namespace {

using namespace std::chrono_literals;

constexpr char kLetters[] = "XYZE";
constexpr double kRest = 0.5;  // maximum pulses between commanded and actual position at the end

constexpr const char* kUsage =
    "usage: systemc_run FILE [--port loose|axi|wishbone|wishbone_classic|spi|uart] [--clock HZ] [--svg OUT.svg]\n"
    "       [--vcd OUT]\n"
    "Runs FILE on the SystemC platform. Exit status 1 when the machine is not where it was sent, or a rule of the port "
    "was\n"
    "broken; 2 for bad input.\n";

struct Options {
  std::string file;
  Port port = Port::kLoose;
  std::string svg;
  PlatformOptions platform;
};

// A clock frequency in Hz, from 100 kHz to 4 GHz.
std::optional<std::uint32_t> clock_of(const std::string& text) {
  double hz = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, hz);
  if (error != std::errc() || stop != end || !(hz >= 1e5 && hz <= 4e9)) return std::nullopt;
  return static_cast<std::uint32_t>(hz);
}

Options options_of(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.substr(0, 2) != "--") {
      if (!options.file.empty()) throw std::invalid_argument(word + ": only one program can be run");
      options.file = word;
      continue;
    }
    if (++i == argc) throw std::invalid_argument(word + " needs a value");
    const std::string value = argv[i];
    if (word == "--port" && port_of(value)) {
      options.port = *port_of(value);
    } else if (word == "--clock" && clock_of(value)) {
      options.platform.clock_hz = *clock_of(value);
    } else if (word == "--svg") {
      options.svg = value;
    } else if (word == "--vcd") {
      options.platform.vcd = value;
    } else {
      throw std::invalid_argument(word + " " + value + ": no such option or value");
    }
  }
  if (options.file.empty()) throw std::invalid_argument("which program?");
  return options;
}

// Runs the program to its end, and waits until the machine is at rest.
void run(Host& host, const std::string& file, const machine::Machine& machine) {
  driver::Card card = driver::Card::open(host);
  const auto lines = [&file] { return std::make_unique<gcode::FileLines>(file); };
  run::Runner runner(lines, machine, planner::limits_of(card.identification()));
  runner.plan();
  runner.run(card);
  host.sleep(100ms);
}

chart::Panel over_time(const std::string& title, const std::string& label) {
  return {title, {"time, s"}, {label}, {}, false, true};
}

// The path in the plane, each axis over time, and the lag of the machine.
std::string picture(const Motors& motors, const machine::Machine& machine) {
  chart::Panel path{"Path of X and Y", {"x, mm"}, {"y, mm"}, {}, true, true};
  chart::Panel places = over_time("Places", "mm");
  chart::Panel lags = over_time("Commanded less actual place", "micrometres");
  path.series = {{"commanded", chart::colour(0), {}, chart::Mark::kLine, 2.5},
                 {"machine", chart::colour(1), {}, chart::Mark::kLine, 1}};
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double scale = machine.axes[axis].steps_per_mm;
    chart::Series place{std::string(1, kLetters[axis]), chart::colour(axis), {}};
    chart::Series lag = place;
    for (const Motors::Sample& s : motors.samples()) {
      place.points.push_back({s.time, s.position[axis] / scale});
      lag.points.push_back({s.time, (s.commanded[axis] - s.position[axis]) / scale * 1000});
    }
    places.series.push_back(std::move(place));
    lags.series.push_back(std::move(lag));
  }
  const double x = machine.axes[0].steps_per_mm;
  const double y = machine.axes[1].steps_per_mm;
  for (const Motors::Sample& s : motors.samples()) {
    path.series[0].points.push_back({s.commanded[0] / x, s.commanded[1] / y});
    path.series[1].points.push_back({s.position[0] / x, s.position[1] / y});
  }
  return chart::grid_of({path, places, lags}, 1, 720, 360);
}

// Prints the table; returns whether all axes are at their commanded positions.
bool report(const Motors& motors, const machine::Machine& machine) {
  bool arrived = true;
  fmt::print("axis  commanded, mm  machine, mm  largest lag, micrometres\n");
  for (unsigned axis = 0; axis < kAxes; ++axis) {
    const double scale = machine.axes[axis].steps_per_mm;
    const double commanded = static_cast<double>(motors.commanded(axis));
    fmt::print("{:<4}  {:13.4f}  {:11.4f}  {:24.1f}\n", kLetters[axis], commanded / scale,
               motors.position(axis) / scale, motors.largest_lag(axis) / scale * 1000);
    arrived = arrived && std::abs(commanded - motors.position(axis)) < kRest;
  }
  return arrived;
}

void write(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

int run(const Options& options) {
  const machine::Machine machine = machine::default_machine();
  const bool loose = options.port == Port::kLoose;
  Platform platform(options.platform);
  platform.machine(loose).record(10e-3);
  platform.add(options.port, [&](Host& host) { run(host, options.file, machine); });
  const std::clock_t before = std::clock();
  platform.run();
  const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  const bool arrived = report(platform.machine(loose), machine);
  const auto cycles = static_cast<double>(platform.cycles(loose));
  fmt::print("{:.3f} s of the card's time, {:.1f} million cycles, {:.2f} million a second of this computer's\n",
             cycles / options.platform.clock_hz, cycles / 1e6, cycles / 1e6 / seconds);
  for (const std::string& rule : platform.broken()) fmt::print(stderr, "error: {}\n", rule);
  if (!arrived) fmt::print(stderr, "error: the machine is not where it was sent\n");
  if (!options.svg.empty()) write(options.svg, picture(platform.machine(loose), machine));
  return arrived && platform.broken().empty() ? 0 : 1;
}

}  // namespace
}  // namespace trammel::platform

int sc_main(int argc, char** argv) {
  try {
    sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
    return trammel::platform::run(trammel::platform::options_of(argc, argv));
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "error: {}\n{}", error.what(), trammel::platform::kUsage);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
  }
  return 2;
}
