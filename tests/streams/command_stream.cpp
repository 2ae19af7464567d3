// Usage: command_stream [--libm] [--one] [--keep] PROGRAM...
// Reads, plans and encodes each program (a file, or generated:<lines>) for two machines: the default one, and one of
// unequal scales, where arcs go out as chords. Prints a line for each: machine, program, commands, words, and a hash of
// all words. Nothing but bits is compared, so nothing is rounded. --libm adds results of the C library's sin, cos,
// atan2 and exp to the hash: what a comparison of two hosts must find different where their C libraries differ. --one:
// the default machine alone. --keep: a byte of every command stays in memory, for the judge of memory.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "generated_lines.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/gcode/program.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/planner/planner.hpp"

namespace {

using namespace trammel;

// FNV-1a over bytes, lowest first.
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
  bool one = false;   // the default machine alone
  bool keep = false;  // a byte of every command stays in memory
};

struct Stream {
  explicit Stream(const Options& options) : keep_(options.keep) {}

  std::uint64_t commands = 0;
  std::uint64_t words = 0;
  Hash hash;

  void put(const driver::Command& command) {
    encoded_.clear();
    driver::encode(command, static_cast<std::uint8_t>(commands), encoded_);
    ++commands;
    words += encoded_.size();
    for (const std::uint32_t word : encoded_) hash.add(word, 4);
    if (keep_) kept_.push_back(static_cast<char>(words));
  }

 private:
  bool keep_;
  std::string kept_;
  std::vector<std::uint32_t> encoded_;
};

std::unique_ptr<gcode::LineSource> open(const std::string& program) {
  constexpr std::string_view kGenerated = "generated:";
  if (program.compare(0, kGenerated.size(), kGenerated) == 0) {
    return std::make_unique<streams::GeneratedLines>(std::stoull(program.substr(kGenerated.size())));
  }
  return std::make_unique<gcode::FileLines>(program);
}

Stream stream_of(const std::string& name, const machine::Machine& machine, const Options& options) {
  const std::unique_ptr<gcode::LineSource> lines = open(name);
  gcode::Reader reader(*lines, machine);
  gcode::Program program;
  for (gcode::Motion motion; reader.next(motion);) program.motions.push_back(motion);
  if (reader.error()) throw gcode::ProgramError(*reader.error());
  Stream stream(options);
  planner::Planner planner(program, machine, machine.clock_hz);
  for (planner::PlannedSegment segment; planner.next(segment);) {
    for (const driver::Command& command : segment.commands) stream.put(command);
  }
  return stream;
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

// False where the program is refused, which is printed too: it must be refused alike everywhere.
bool print(const char* machine_name, const machine::Machine& machine, const std::string& program,
           const Options& options) {
  const std::string name = program.substr(program.rfind('/') + 1);
  try {
    Stream stream = stream_of(program, machine, options);
    if (options.libm) add_libm(stream.hash);
    std::printf("%s %s: %llu commands, %llu words, %016llx\n", machine_name, name.c_str(),
                static_cast<unsigned long long>(stream.commands), static_cast<unsigned long long>(stream.words),
                static_cast<unsigned long long>(stream.hash.value()));
    return true;
  } catch (const std::exception& error) {
    std::printf("%s %s: refused: %s\n", machine_name, name.c_str(), error.what());
    return false;
  }
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
