// Reads programs with probes, for tests. `ends` has the results of the first probes; later probes are assumed.
#pragma once

#include <string>
#include <vector>

#include "reading.hpp"

namespace trammel::gcode {

struct ProbeEnd {
  Coordinates edge;
  Coordinates rest;
  bool tripped = true;
};

struct ProbedReading : Reading {
  std::size_t lines_on_probes = 0;

  // Last motion before the end: the axes whose target depends on a probe, and the target.
  unsigned later() const { return before_end().later; }
  double target(std::size_t axis) const { return before_end().target[axis]; }

 private:
  Motion before_end() const { return motions.size() < 2 ? Motion{} : motions[motions.size() - 2]; }
};

inline machine::Machine machine_with_probe() {
  machine::Machine machine = machine::default_machine();
  machine.probe.input = 0;
  return machine;
}

inline ProbedReading read_probing(const std::string& text, const std::vector<ProbeEnd>& ends = {},
                                  const machine::Machine& machine = machine_with_probe()) {
  TextLines lines(text, "p.ngc");
  Reader reader(lines, machine);
  ProbedReading reading;
  std::size_t probes = 0;
  for (Motion motion; reader.next(motion);) {
    reading.motions.push_back(motion);
    if (!reader.awaits_probe()) continue;
    if (probes < ends.size()) {
      reader.probed(ends[probes].edge, ends[probes].rest, ends[probes].tripped);
    } else {
      reader.assume_probed();
    }
    ++probes;
  }
  reading.error = reader.error();
  reading.lines_on_probes = reader.lines_on_probes();
  return reading;
}

// Read `text` after a probe along Z to -3: read_assumed() before the run, read_met() with the edge at `z`.
constexpr const char* kProbeZ = "G38.2 Z-3 F60\n";
inline ProbedReading read_assumed(const std::string& text, const machine::Machine& machine = machine_with_probe()) {
  return read_probing(kProbeZ + text, {}, machine);
}
inline ProbedReading read_met(const std::string& text, double z,
                              const machine::Machine& machine = machine_with_probe()) {
  return read_probing(kProbeZ + text, {{{0, 0, z}, {0, 0, z}}}, machine);
}

}  // namespace trammel::gcode
