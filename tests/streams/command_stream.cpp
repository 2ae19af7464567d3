// Usage: command_stream [--libm] [--list] [--one] [--keep] PROGRAM...
// Reads, plans and encodes each program (a file, or generated:<lines>) for two machines: the default machine, and a
// machine with unequal scales, for which arcs are sent as chords. Prints one line for each: machine, program, commands,
// words, and a hash of all words. The comparison is bit-exact, without a tolerance.
// --libm: adds results of the C library's sin, cos, atan2 and exp to the hash. A comparison of two hosts must then find
// a difference if their C libraries differ.
// --list: prints the words. --one: the default machine only. --keep: keeps one byte of every command in memory, as a
// leak for the memory test.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "generated_lines.hpp"
#include "trammel/driver/command_sink.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"

namespace {

using namespace trammel;

// FNV-1a over the bytes of a value, lowest byte first.
class Hash {
 public:
  void add(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) state_ = (state_ ^ (value >> (8 * i) & 0xFF)) * 0x100000001B3;
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xCBF29CE484222325;
};

struct Options {
  bool libm = false;
  bool list = false;  // print the words, one line per command, to find the first difference between two hosts
  bool one = false;   // the default machine only
  bool keep = false;  // keep one byte of every command in memory
};

// Counts the commands and hashes their words.
class Stream final : public driver::CommandSink {
 public:
  Stream(bool list, bool keep) : list_(list), keep_(keep) {}

  void put(const driver::Command& command) override {
    std::array<std::uint32_t, driver::kMaxCommandWords> encoded;
    const std::size_t count = driver::encode(command, static_cast<std::uint8_t>(commands), encoded.data());
    ++commands;
    words += count;
    for (std::size_t i = 0; i < count; ++i) {
      hash.add(encoded[i], 4);
      if (list_) std::printf("%08lx ", static_cast<unsigned long>(encoded[i]));
    }
    if (list_) std::puts("");
    if (keep_) kept_.push_back(static_cast<char>(words));
  }

  std::uint64_t commands = 0;
  std::uint64_t words = 0;
  Hash hash;

 private:
  bool list_;
  bool keep_;
  std::string kept_;
};

std::unique_ptr<gcode::LineSource> open(const std::string& program) {
  constexpr std::string_view kGenerated = "generated:";
  if (program.compare(0, kGenerated.size(), kGenerated) == 0) {
    return std::make_unique<streams::GeneratedLines>(std::stoull(program.substr(kGenerated.size())));
  }
  return std::make_unique<gcode::FileLines>(program);
}

// Returns the error of a refused program.
std::optional<gcode::Error> run(const std::string& program, const machine::Machine& machine, Stream& stream) {
  const std::unique_ptr<gcode::LineSource> lines = open(program);
  planner::CardLimits card;
  card.clock_hz = machine.clock_hz;
  card.axes = static_cast<unsigned>(machine.axes.size());
  gcode::Reader reader(*lines, machine);
  planner::BlockBuilder blocks(reader, machine, card);
  planner::Planner planner(blocks, machine, card);
  for (planner::PlannedBlock planned; planner.next(stream, planned);) continue;
  return blocks.error();
}

void add_libm(Hash& hash) {
  for (int i = 1; i < 20'000; ++i) {
    const double x = i / 977.0;
    for (const double result : {std::sin(x), std::cos(x), std::atan2(x, 1.37), std::exp(x)}) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &result, sizeof bits);
      hash.add(bits, 8);
    }
  }
}

// Returns false if the program is refused. Prints the refusal too, because it must be the same on every host.
bool print(const char* machine_name, const machine::Machine& machine, const std::string& program,
           const Options& options) {
  Stream stream(options.list, options.keep);
  const std::optional<gcode::Error> error = run(program, machine, stream);
  if (options.libm) add_libm(stream.hash);
  std::printf("%s %s: %llu commands, %llu words, %016llx", machine_name, program.substr(program.rfind('/') + 1).c_str(),
              static_cast<unsigned long long>(stream.commands), static_cast<unsigned long long>(stream.words),
              static_cast<unsigned long long>(stream.hash.value()));
  if (error)
    std::printf(", refused at line %llu: %s", static_cast<unsigned long long>(error->line), error->message.c_str());
  std::puts("");
  return !error;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  bool all = true;
  machine::Machine unequal = machine::default_machine();
  machine::apply_override(unequal, "axis.x.steps_per_mm=100");
  machine::apply_override(unequal, "axis.y.steps_per_mm=133.7");
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--libm") {
      options.libm = true;
    } else if (argument == "--list") {
      options.list = true;
    } else if (argument == "--one") {
      options.one = true;
    } else if (argument == "--keep") {
      options.keep = true;
    } else {
      all &= print("default", machine::default_machine(), argument, options);
      if (!options.one) all &= print("unequal", unequal, argument, options);
    }
  }
  return all ? 0 : 1;
}
