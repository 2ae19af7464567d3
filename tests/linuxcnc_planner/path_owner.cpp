// A process that owns a simulated card and serves the planner module only, at the pace of the wall clock. It replaces
// `trammel linuxcnc` in the tests with LinuxCNC. LinuxCNC's own loop feeds positions back, from command to feedback.
//
//     path_owner NAME LOG [SURFACE]
//     path_owner --run PROGRAM LOG     runs the program on the same machine as `trammel run` does; only "path" lines
//
// The probe at input 2 touches while Z is at most SURFACE mm. The process ends at SIGTERM and writes to LOG: a line
// "step AXIS DIRECTION CYCLE" for each pulse, "probe X Y Z" for each probe, "end REFUSALS UNDER_RUNS".
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "path_bench.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/linuxcnc/path_server.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::linuxcnc {
namespace {

constexpr std::uint32_t kOwnerClock = kPathClock;
constexpr unsigned kProbeInput = 2;
volatile std::sig_atomic_t asked_to_end = 0;

std::uint64_t wall_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(now.tv_nsec);
}

// Before each access and after each sleep the engine catches up with the wall clock.
class PacedBus final : public driver::Bus {
 public:
  PacedBus(sim::Engine& engine, double surface) : engine_(engine), surface_(surface), begun_(wall_nanoseconds()) {}
  std::size_t transfer(driver::Access* accesses, std::size_t count) override {
    catch_up();
    return engine_.transfer(accesses, count);
  }
  void sleep(std::chrono::nanoseconds time) override {
    timespec pause{0, static_cast<long>(time.count() % 1'000'000'000)};
    nanosleep(&pause, nullptr);
    catch_up();
  }
  bool reports_refusals() const override { return engine_.reports_refusals(); }
  bool touches() const { return touches_; }

 private:
  void catch_up() {
    constexpr std::uint64_t kPart = kOwnerClock / 1000;
    const auto due = static_cast<std::uint64_t>(static_cast<double>(wall_nanoseconds() - begun_) * 1e-9 * kOwnerClock);
    while (engine_.cycles() < due) {
      engine_.wait(std::min(kPart, due - engine_.cycles()));
      touches_ = static_cast<double>(engine_.positions()[2]) <= surface_ * 80;
      engine_.set_input(kProbeInput, touches_);
    }
  }

  sim::Engine& engine_;
  double surface_;
  std::uint64_t begun_;
  bool touches_ = false;
};

trammel_region& map_region(const std::string& name) {
  const std::string path = std::string(TRAMMEL_REGION_FOLDER) + "/" + TRAMMEL_REGION_PREFIX + name;
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file < 0 || ftruncate(file, sizeof(trammel_region)) != 0) throw std::runtime_error("cannot make " + path);
  void* const at = mmap(nullptr, sizeof(trammel_region), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (at == MAP_FAILED) throw std::runtime_error("cannot map " + path);
  return *static_cast<trammel_region*>(at);
}

void write_status(trammel_region& region, const trammel_status& status) {
  __atomic_store_n(&region.status_sequence, region.status_sequence + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  region.status = status;
  __atomic_store_n(&region.status_sequence, region.status_sequence + 1, __ATOMIC_RELEASE);
}

void write_log(const std::string& path, const test::Steps& steps, const std::vector<trammel_status>& probes,
               std::uint64_t refusals, std::uint32_t under_runs) {
  std::ofstream log(path);
  for (const driver::PinStep& step : steps.pins) {
    log << fmt::format("step {} {} {}\n", step.axis, static_cast<int>(step.direction), step.cycle);
  }
  for (const driver::PathStep& step : steps.path) {
    log << fmt::format("path {} {}\n", step.axis, static_cast<int>(step.direction));
  }
  for (const trammel_status& probe : probes) {
    log << fmt::format("probe {} {} {} {}\n", probe.probe_tripped, probe.probe_pose[0], probe.probe_pose[1],
                       probe.probe_pose[2]);
  }
  log << fmt::format("end {} {}\n", refusals, under_runs);
}

int run_program(const std::string& program, const std::string& log) {
  std::ifstream file(program);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::ofstream out(log);
  for (const auto& [axis, direction] : runner_path(text, machine::default_machine())) {
    out << fmt::format("path {} {}\n", axis, direction);
  }
  return 0;
}

int run(const std::string& name, const std::string& log, double surface) {
  trammel_region& region = map_region(name);
  const auto engine = sim::make_model_engine(sim::EngineOptions{4, kOwnerClock, false});
  test::Steps steps;
  engine->set_sink(&steps);
  PacedBus paced(*engine, surface);
  run::AttentiveBus bus(paced, linuxcnc::kServoPeriod);
  driver::Card card = driver::Card::open(bus);
  machine::Machine machine = machine::default_machine();
  machine.probe.input = kProbeInput;
  PathServer server(region, card, bus, machine, PathUnits::kMillimetres);
  region.version_owner = TRAMMEL_REGION_VERSION;
  trammel_status status{};
  status.session = static_cast<std::uint64_t>(getpid());
  std::vector<trammel_status> probes;
  server.serve([&] {
    const std::uint64_t before = status.probes;
    ++status.beat;
    status.flags = TRAMMEL_STATUS_LINK;
    if (paced.touches()) status.flags |= TRAMMEL_STATUS_PROBE;
    server.write_status(status);
    if (status.probes != before) probes.push_back(status);
    write_status(region, status);
    return asked_to_end == 0;
  });
  write_log(log, steps, probes, status.refusals, card.parts().registers.read(card_map::reg::kUnderruns));
  return 0;
}

}  // namespace
}  // namespace trammel::linuxcnc

int main(int count, char** arguments) {
  if (count < 3 || (std::string(arguments[1]) == "--run" && count < 4)) return 2;
  std::signal(SIGTERM, [](int) { trammel::linuxcnc::asked_to_end = 1; });
  try {
    if (std::string(arguments[1]) == "--run") return trammel::linuxcnc::run_program(arguments[2], arguments[3]);
    return trammel::linuxcnc::run(arguments[1], arguments[2], count > 3 ? std::atof(arguments[3]) : -1e9);
  } catch (const std::exception& error) {
    fmt::print(stderr, "path_owner: {}\n", error.what());
    return 1;
  }
}
