// Usage: run_long_program [--plot] [--keep] generated:<lines>
// Runs a program of short moves on the model engine, from reader to steps. The recorder's lists are discarded.
// --plot: the recorder also keeps the thinned path and speed for a plot. --keep: an observer keeps 16 bytes of every
// command, as a leak for the memory test.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <string_view>

#include "trammel/driver/card.hpp"
#include "trammel/gcode/line_source.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/observer.hpp"
#include "trammel/run/runner.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/sim/engine.hpp"

namespace {

using namespace trammel;

// Moves back and forth by one pulse.
class ShortMoves final : public gcode::LineSource {
 public:
  explicit ShortMoves(std::uint64_t count) : left_(count) {}
  bool next(std::string_view& line) override {
    if (left_ == 0) return false;
    --left_;
    line = left_ % 2 == 0 ? "G1 X0 F6000" : "G1 X0.0125 F6000";
    return true;
  }
  const std::string& name() const override { return name_; }

 private:
  std::string name_ = "short moves";
  std::uint64_t left_;
};

class Nowhere final : public run::TextSink {
 public:
  void write(std::string_view text) override { bytes_ += text.size(); }
  std::uint64_t bytes() const { return bytes_; }

 private:
  std::uint64_t bytes_ = 0;
};

class Keeper final : public run::Observer {
 public:
  void command(std::uint64_t number, const driver::Command&) override { kept_.append(16, static_cast<char>(number)); }

 private:
  std::string kept_;
};

void run_lines(std::uint64_t lines, bool plot, bool keep) {
  const machine::Machine machine = machine::default_machine();
  sim::EngineOptions card_options;
  card_options.clock_hz = 1'000'000;
  const std::unique_ptr<sim::Engine> engine = sim::make_model_engine(card_options);
  driver::Card card = driver::Card::open(*engine);
  run::Runner runner([&] { return std::make_unique<ShortMoves>(lines); }, machine,
                     planner::limits_of(card.identification()));
  Nowhere steps;
  Nowhere path_steps;
  run::StepRecorder::Options options;
  options.steps = &steps;
  options.path_steps = &path_steps;
  options.plot = plot;
  options.clock_hz = machine.clock_hz;
  run::StepRecorder recorder(options, kinematics::Kinematics(machine));
  engine->set_sink(&recorder);
  Keeper keeper;
  if (keep) runner.add(keeper);
  runner.plan();
  runner.add(recorder);
  const run::Outcome outcome = runner.run(card);
  recorder.finish();
  recorder.check(outcome.counted);
  std::printf("%llu commands, %llu and %llu bytes of lists, %llu cycles\n",
              static_cast<unsigned long long>(outcome.commands), static_cast<unsigned long long>(steps.bytes()),
              static_cast<unsigned long long>(path_steps.bytes()), static_cast<unsigned long long>(engine->cycles()));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    bool plot = false;
    bool keep = false;
    std::uint64_t lines = 0;
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument == "--plot")
        plot = true;
      else if (argument == "--keep")
        keep = true;
      else
        lines = std::stoull(argument.substr(argument.find(':') + 1));
    }
    run_lines(lines, plot, keep);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
